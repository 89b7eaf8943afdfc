// How many digits the numbers of a column carry: those of a report are whole multiples of a power of ten, and have at least some digits.

import { digits } from './numbers';
import type { Num } from './types';

/** Part of a column's range that a reader of a table is told. */
const TOLD = 1e-5;
/** Part of the largest number below which a step says that nothing was rounded. */
const WHOLE = 1e-11;
/** Part of the largest number that is told of a column that does not vary, or whose numbers were not rounded. */
const SEVEN = 1e-6;
/** Digits that a number is told with at least. */
const LEAST = 5;
/** Decimals with which a number is still easy to read. */
const MOST = 9;

/** The power of ten of the last digit of a number as it is written. */
function last(x: number): number {
  const [mantissa = '', power = '0'] = x.toExponential().split('e');
  return Number(power) - (mantissa.split('.')[1]?.length ?? 0);
}

/** The step of which the largest numbers are whole multiples, as far as they tell; none of no numbers but zeros. Smaller ones may have more decimals. */
function step(values: readonly Num[], largest: number): number | null {
  let power = Infinity;
  for (const x of values) if (x !== null && Number.isFinite(x) && Math.abs(x) >= 0.1 * largest && x !== 0) power = Math.min(power, last(x));
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

/** Numbers with the same decimals in all rows: as few as tell them, and at most so many; where that leaves one too few digits it has more. */
function fixed(values: readonly Num[], most: number): (x: Num) => string {
  const whole = (count: number) => values.every((x) => missing(x) || Math.abs(Math.round(x * 10 ** count) * 10 ** (most - count) - Math.round(x * 10 ** most)) < 0.5);
  let count = 0;
  while (count < most && !whole(count)) count++;
  const zero = (0).toFixed(count);
  // the decimals that a number needs for its digits; numbers of one size have as many
  const own = (x: number) => LEAST - 1 - Math.floor(Math.log10(Math.abs(x)));
  const more = new Set<number>();
  for (const x of values) if (!missing(x) && x !== 0 && own(x) > count && Math.abs(Number(x.toFixed(count)) - x) > 0.5 * 10 ** -own(x)) more.add(own(x));
  return (x) => {
    if (missing(x)) return '–';
    if (x !== 0 && more.has(own(x))) return own(x) > MOST ? digits(x, LEAST) : x.toFixed(own(x)).replace('-', '−');
    const text = x.toFixed(count);
    return text === `-${zero}` ? zero : text.replace('-', '−');
  };
}

/** How numbers of SI are written that are shown in a unit of some size. */
export function writing(values: readonly Num[], size: number): Writing {
  const by = (x: Num) => (x === null ? null : x / size);
  const shown = values.map(by);
  const { range, largest, least } = extent(shown);
  const own = (step(values, largest * size) ?? 0) / size;
  const rounded = own > WHOLE * largest;
  const carried = Math.max(own, rounded && range > 0 ? TOLD * range : SEVEN * largest);
  // a small number beside large ones has decimals of its own
  const file = (x: number) => decimals(Math.min(own, 10 ** last(x) / size));
  const full = (x: Num) => {
    if (missing(x)) return '';
    const places = rounded ? file(x) : 16;
    return String(places > 15 ? Number((by(x)! + 0).toPrecision(15)) : Number(by(x)!.toFixed(places)) + 0);
  };
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
    return digits(value, Math.min(Math.max(count, LEAST), 15));
  };
  return { text, full };
}
