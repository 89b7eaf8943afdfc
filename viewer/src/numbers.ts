// Numbers and units as a reader wants them.

import { type Child, h } from './dom';
import type { Column, Num, Scalar } from './types';

const RAISED: Record<string, string> = { '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹' };

function raised(text: string): string {
  return [...text].map((c) => RAISED[c] ?? c).join('');
}

/** `kg m^2/s` as `kg m²/s`. */
export function pretty(unit: string): string {
  return unit.replace(/[*·]/g, ' ').replace(/\^(-?\d+)/g, (_, power: string) => raised(power));
}

/** The unit to show a quantity in, and its size in SI: degrees for radians, if the model asks for none. */
export function shownIn({ unit, shown_in }: Pick<Column, 'unit' | 'shown_in'>): { unit: string; size: number } {
  if (shown_in) return shown_in;
  return unit === 'rad' ? { unit: 'deg', size: Math.PI / 180 } : { unit, size: 1 };
}

/** A number with some significant digits, without zeros behind; with a power of ten where the plain form would be long. */
export function digits(x: Num | undefined, count = 7): string {
  if (x === null || x === undefined || !Number.isFinite(x)) return '–';
  if (x === 0) return '0';
  const [mantissa = '', exponent = '0'] = x.toExponential(count - 1).split('e');
  const power = Number(exponent);
  const trimmed = (text: string) => (text.includes('.') ? text.replace(/\.?0+$/, '') : text);
  const text = power >= -4 && power < Math.max(count, 7) ? trimmed(x.toFixed(Math.max(0, count - 1 - power))) : `${trimmed(mantissa)}·10${raised(String(power))}`;
  return text.replace('-', '−');
}

/** Digits of a number that a reader is told, those of a number that is told whole, and all that there are worth knowing. */
const TOLD = 5;
const WHOLE = 7;
const ALL = 12;

/** A number for a reader: five digits, or as it is where it has few. */
export function told(x: Num | undefined): string {
  const short = x !== null && x !== undefined && Math.abs(Number(x.toPrecision(WHOLE)) - x) <= 1e-12 * Math.abs(x);
  return digits(x, short ? WHOLE : TOLD);
}

/** A value in the unit to show it in, with that unit; `full` has all of its digits. */
export function valued(of: Pick<Scalar, 'unit' | 'shown_in'>, value: Num): { text: string; full: string; unit: string } {
  const { unit, size } = shownIn(of);
  const x = value === null ? null : value / size;
  return { text: told(x), full: digits(x, ALL), unit: pretty(unit) };
}

/** A number that has all of its digits in its title. */
export function hinted(x: Num | undefined): Child {
  const [text, full] = [told(x), digits(x, ALL)];
  return text === full ? text : h('span', { title: full }, text);
}

/** Words in backticks as code. */
export function coded(text: string): (HTMLElement | string)[] {
  return text.split(/`([^`]+)`/).map((part, i) => (i % 2 === 1 ? h('code', {}, part) : part));
}

/** A name that may be broken behind underscores and points, and only there. */
export function broken(name: string): Child[] {
  return name.split(/(?<=[_.])(?=.)/).flatMap((part, i) => (i > 0 ? [h('wbr'), part] : [part]));
}

/** `torque [N m]`; of a number the name alone. */
export function heading(name: string, unit: string): string {
  return unit === '' ? name : `${name} [${pretty(unit)}]`;
}

/** Names of files and plots as words. */
export function words(name: string): string {
  return name.replace(/_/g, ' ');
}
