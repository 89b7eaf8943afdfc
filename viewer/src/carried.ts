// How many digits the numbers of a column carry: those of a report are whole multiples of a power of ten.

import { digits } from './numbers';
import type { Num } from './types';

/** Part of a column's range that a reader of a table is told. */
const TOLD = 1e-5;
/** Part of the largest number below which a step says that nothing was rounded. */
const WHOLE = 1e-11;
/** Part of the largest number that is told of a column that does not vary, or whose numbers were not rounded. */
const SEVEN = 1e-6;
/** Decimals with which a number is still easy to read. */
const MOST = 9;

/** The power of ten of the last digit of a number as it is written. */
function last(x: number): number {
  const [mantissa = '', power = '0'] = x.toExponential().split('e');
  return Number(power) - (mantissa.split('.')[1]?.length ?? 0);
}

/** The step of which all numbers are whole multiples, as far as they tell; none of no numbers but zeros. */
function step(values: readonly Num[]): number | null {
  let power = Infinity;
  for (const x of values) if (x !== null && x !== 0 && Number.isFinite(x)) power = Math.min(power, last(x));
  return power === Infinity ? null : 10 ** power;
}

/** The range of the numbers, the largest of their magnitudes, and the least one that is not zero. */
function extent(values: readonly Num[]): { range: number; largest: number; least: number } {
  let [low, high, least] = [Infinity, -Infinity, Infinity];
  for (const x of values) {
    if (x === null || !Number.isFinite(x)) continue;
    low = Math.min(low, x);
    high = Math.max(high, x);
    if (x !== 0) least = Math.min(least, Math.abs(x));
  }
  return low > high ? { range: 0, largest: 0, least } : { range: high - low, largest: Math.max(Math.abs(low), Math.abs(high)), least };
}

/** Decimals of a step: no more than it is worth. */
function decimals(step: number): number {
  return Math.max(0, Math.floor(-Math.log10(step) + 1e-9));
}

/** How the numbers of a column are written. */
export interface Writing {
  /** For a reader, who compares them. */
  text(value: Num): string;
  /** With all digits that they carry, for a file. */
  full(value: Num): string;
}

const missing = (x: Num): x is null => x === null || !Number.isFinite(x);

/** Numbers with the same decimals in all rows: as few as tell them, and at most so many. */
function fixed(values: readonly Num[], most: number): (x: Num) => string {
  const whole = (count: number) => values.every((x) => missing(x) || Math.abs(Math.round(x * 10 ** count) * 10 ** (most - count) - Math.round(x * 10 ** most)) < 0.5);
  let count = 0;
  while (count < most && !whole(count)) count++;
  const zero = (0).toFixed(count);
  return (x) => {
    if (missing(x)) return '–';
    const text = x.toFixed(count);
    return text === `-${zero}` ? zero : text.replace('-', '−');
  };
}

/** How numbers of SI are written that are shown in a unit of some size. */
export function writing(values: readonly Num[], size: number): Writing {
  const by = (x: Num) => (x === null ? null : x / size);
  const shown = values.map(by);
  const { range, largest, least } = extent(shown);
  const own = (step(values) ?? 0) / size;
  const rounded = own > WHOLE * largest;
  const carried = Math.max(own, rounded && range > 0 ? TOLD * range : SEVEN * largest);
  const file = rounded ? decimals(own) : null;
  const full = (x: Num) => (missing(x) ? '' : String(file === null || file > 15 ? Number((by(x)! + 0).toPrecision(15)) : Number(by(x)!.toFixed(file)) + 0));
  // numbers of many sizes that were not rounded have their own digits each
  const uneven = !rounded && least < 1e-3 * largest;
  if (largest === 0 || (!uneven && largest < 1e7 && largest >= 1e-3 && decimals(carried) <= MOST)) {
    const write = fixed(shown, largest === 0 ? 0 : decimals(carried));
    return { text: (x) => write(by(x)), full };
  }
  const text = (x: Num) => {
    const value = by(x);
    if (missing(value) || value === 0) return digits(value);
    const count = uneven ? 7 : Math.floor(Math.log10(Math.abs(value)) - Math.log10(carried) + 1e-9) + 1;
    return count < 1 ? '0' : digits(value, Math.min(count, 15));
  };
  return { text, full };
}
