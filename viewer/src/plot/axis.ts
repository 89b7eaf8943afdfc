// Axes: from values to pixels, where ticks stand, and how their numbers are shown: with the prefix, the power of ten and the number that is
// taken off which the figures of the program have (src/output/panel.rs).

import { digits, heading, pretty } from '../numbers';

/** Digits of a value that is read at the cursor. */
const READ = 6;

/** How numbers of an axis are shown: those of the ticks are `(value − offset) factor`, in `unit`, which has a prefix or a power of ten. */
export interface Shown { unit: string; factor: number; offset: number }

export interface Axis {
  low: number;
  high: number;
  log: boolean;
  shown: Shown;
  /** From a value to a part of the axis. */
  part(value: number): number;
  /** Back from a part. */
  value(part: number): number;
  ticks(room: number): { at: number; text: string }[];
}

const PREFIXES: [number, string][] = [[-9, 'n'], [-6, 'µ'], [-3, 'm'], [3, 'k'], [6, 'M'], [9, 'G']];
const RAISED = '⁰¹²³⁴⁵⁶⁷⁸⁹';

/** The unit for numbers up to `largest`, with a prefix or a power of ten, and what values are multiplied by. */
export function scaled(unit: string, largest: number): { unit: string; factor: number } {
  const plain = { unit: pretty(unit), factor: 1 };
  const symbol = /^[\p{L}]*/u.exec(plain.unit)![0];
  const whole = !/^[²³⁻^]/.test(plain.unit.slice(symbol.length));
  // 0.010 m are 10 mm; a power of ten is no gain there
  const least = whole && ['N', 'J', 'W', 'Pa', 'Hz', 'm', 's'].includes(symbol) ? 0.1 : 1e-2;
  if ((unit === 'deg' && largest >= 1e-2) || (largest >= least && largest < 1e4) || largest === 0 || !Number.isFinite(largest)) return plain;
  const power = Math.floor((Math.log10(largest) + 0.3) / 3) * 3;
  const factor = 10 ** -power;
  const fits = ['N', 'J', 'W', 'Pa', 'Hz'].includes(symbol) || (['m', 's'].includes(symbol) && power < 0);
  const prefix = PREFIXES.find(([known]) => known === power);
  if (fits && prefix && whole) return { unit: prefix[1] + plain.unit, factor };
  const raised = [...String(Math.abs(power))].map((c) => RAISED[Number(c)]).join('');
  return { unit: `10${power < 0 ? '⁻' : ''}${raised} ${plain.unit}`.trim(), factor };
}

/** The step of about `count` ticks over a range: 1, 2 or 5 times a power of ten; of degrees parts of a turn. */
function step(range: number, count: number, unit: string): number {
  const least = range / Math.max(count, 1);
  if (unit === 'deg' && least > 2 && least <= 360) return [5, 10, 15, 30, 45, 60, 90, 180, 360].find((s) => s >= least)!;
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((m) => m * power).find((s) => s >= least * (1 - 1e-9))!;
}

/** How numbers from `low` to `high` are shown, as in the figures of the program; `shifts` lets a number be taken off where all have long equal digits. */
function shownFrom(low: number, high: number, unit: string, shifts: boolean): Shown {
  const [span, largest] = [high - low, Math.max(Math.abs(low), Math.abs(high))];
  const round = 10 ** Math.ceil(Math.log10(span));
  const offset = shifts && span > 0 && span < 1e-4 * largest ? Math.round((low + high) / 2 / round) * round : 0;
  return { ...scaled(unit, Math.max(Math.abs(low - offset), Math.abs(high - offset))), offset };
}

function linear(low: number, high: number, shown: Shown, gap: number): Axis {
  const range = high - low || 1;
  const { unit, factor, offset } = shown;
  return {
    low, high, log: false, shown,
    part: (value) => (value - low) / range,
    value: (part) => low + part * range,
    ticks(room) {
      const [from, to] = [(low - offset) * factor, (high - offset) * factor];
      // one mark alone is no scale
      let by = step(to - from || 1, room / gap, unit);
      const inside = () => Math.floor(to / by + 1e-9) - Math.ceil(from / by - 1e-9);
      for (let more = 1.5; inside() < 1 && more < 6; more *= 1.5) by = step(to - from || 1, (more * room) / gap, unit);
      const decimals = Math.max(0, -Math.floor(Math.log10(by) + 1e-9));
      const out = [];
      for (let k = Math.ceil(from / by - 1e-9); k * by <= to + 1e-9 * (to - from); k++) {
        const at = k * by;
        const text = decimals <= 6 && Math.abs(at) < 1e7 ? at.toFixed(decimals).replace(/^-(0(\.0*)?)$/, '$1').replace('-', '−') : digits(at, 4);
        out.push({ at: at / factor + offset, text });
      }
      return out;
    },
  };
}

function logarithmic(low: number, high: number, unit: string): Axis {
  const [a, b] = [Math.log10(low), Math.log10(high)];
  const range = b - a || 1;
  return {
    low, high, log: true, shown: { unit: pretty(unit), factor: 1, offset: 0 },
    part: (value) => (value > 0 ? (Math.log10(value) - a) / range : NaN),
    value: (part) => 10 ** (a + part * range),
    ticks(room) {
      const decades = Math.max(1, Math.ceil(range / Math.max(room / 50, 1)));
      const parts = range < 2 ? [1, 2, 5] : [1];
      const out = [];
      for (let power = Math.floor(a); power <= b; power++) {
        for (const m of parts) {
          const at = m * 10 ** power;
          if (at >= low * (1 - 1e-9) && at <= high * (1 + 1e-9) && power % decades === 0) out.push({ at, text: digits(at, 3) });
        }
      }
      return out;
    },
  };
}

/** An axis over values; `tight` without room at its ends, `plain` without a number that is taken off. */
export function axis(values: Iterable<number>, unit: string, { log = false, tight = false, plain = false, gap }: { log?: boolean; tight?: boolean; plain?: boolean; gap: number }): Axis {
  let [low, high] = [Infinity, -Infinity];
  for (const x of values) {
    if (!Number.isFinite(x) || (log && x <= 0)) continue;
    if (x < low) low = x;
    if (x > high) high = x;
  }
  if (low > high) [low, high] = log ? [1, 10] : [0, 1];
  if (log) return logarithmic(low === high ? low / 2 : low / (tight ? 1 : 1.2), low === high ? high * 2 : high * (tight ? 1 : 1.2), unit);
  const size = Math.max(Math.abs(low), Math.abs(high));
  // round-off is no curve
  const constant = high - low <= 1e-12 * size;
  if (constant) [low, high] = [low - 0.25 * (size || 4), high + 0.25 * (size || 4)];
  const room = tight ? 0 : 0.06 * (high - low);
  return linear(low - room, high + room, shownFrom(low, high, unit, !plain && !constant), gap);
}

/** An axis over a range that the file gives, or a reader has chosen by looking closely. */
export function over(low: number, high: number, unit: string, log: boolean, gap: number, close = false): Axis {
  return log ? logarithmic(low, high, unit) : linear(low, high, shownFrom(low, high, unit, close), gap);
}

/** An axis with other ends whose numbers are shown as before. */
export function withEnds(low: number, high: number, shown: Shown, gap: number): Axis {
  return linear(low, high, shown, gap);
}

/** Two axes whose zeros are level, where both have one, as in the figures of the program. */
export function level(a: Axis, b: Axis, gap: number): [Axis, Axis] {
  const crosses = ({ low, high, log, shown }: Axis) => !log && shown.offset === 0 && low < 0 && high > 0;
  if (!crosses(a) || !crosses(b)) return [a, b];
  const parts = [a, b].map(({ low, high }) => -low / (high - low));
  const [below, above] = [Math.max(...parts), 1 - Math.min(...parts)];
  const widened = ({ low, high, shown }: Axis) => linear(-below * (high - low), above * (high - low), shown, gap);
  return [widened(a), widened(b)];
}

/** One way to show the numbers of two axes. */
export function shared(unit: string, a: Axis, b: Axis): Shown {
  return shownFrom(-Math.max(...[a.low, a.high, b.low, b.high].map(Math.abs)), 0, unit, false);
}

/** What an axis says: a name, the number that is taken off, and the unit of the rest. */
export function said(name: string, { shown: { unit, offset } }: Axis, plain: string): string {
  const off = offset === 0 ? '' : ` ${offset < 0 ? '+' : '−'} ${digits(Math.abs(offset), 12)} ${pretty(plain)}`.trimEnd();
  return heading(name + off, unit).trim();
}

/** A value on an axis for a reader: in the unit of the axis, but without powers of ten as units and with what is taken off. */
export function read(value: number, { low, high, shown: { unit, factor, offset } }: Axis, plain: string): string {
  const prefixed = offset === 0 && !unit.startsWith('10');
  // where all have long equal digits the others are told, too
  const equal = Math.max(0, Math.floor(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low))));
  return `${digits(prefixed ? value * factor : value, Math.min(READ + equal, 15))} ${prefixed ? unit : pretty(plain)}`.trim();
}
