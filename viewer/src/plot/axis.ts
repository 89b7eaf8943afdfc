// Axes: from values to pixels, and where ticks stand.

import { digits, pretty } from '../numbers';

export interface Axis {
  low: number;
  high: number;
  log: boolean;
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

function linear(low: number, high: number, unit: string, gap: number): Axis {
  const range = high - low || 1;
  return {
    low, high, log: false,
    part: (value) => (value - low) / range,
    value: (part) => low + part * range,
    ticks(room) {
      const by = step(range, room / gap, unit);
      const decimals = Math.max(0, -Math.floor(Math.log10(by) + 1e-9));
      const out = [];
      for (let k = Math.ceil(low / by - 1e-9); k * by <= high + 1e-9 * range; k++) {
        const at = k * by;
        out.push({ at, text: (decimals <= 6 && Math.abs(at) < 1e7 ? at.toFixed(decimals).replace(/^-(0(\.0*)?)$/, '$1').replace('-', '−') : digits(at, 4)) });
      }
      return out;
    },
  };
}

function logarithmic(low: number, high: number): Axis {
  const [a, b] = [Math.log10(low), Math.log10(high)];
  const range = b - a || 1;
  return {
    low, high, log: true,
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

/** An axis over values; `tight` without room at its ends. */
export function axis(values: Iterable<number>, unit: string, log: boolean, tight: boolean, gap: number): Axis {
  let [low, high] = [Infinity, -Infinity];
  for (const x of values) {
    if (!Number.isFinite(x) || (log && x <= 0)) continue;
    if (x < low) low = x;
    if (x > high) high = x;
  }
  if (low > high) [low, high] = log ? [1, 10] : [0, 1];
  if (log) return logarithmic(low === high ? low / 2 : low / (tight ? 1 : 1.2), low === high ? high * 2 : high * (tight ? 1 : 1.2));
  const size = Math.max(Math.abs(low), Math.abs(high));
  // round-off is no curve
  if (high - low <= 1e-12 * size) [low, high] = [low - 0.05 * (size || 1), high + 0.05 * (size || 1)];
  const room = tight ? 0 : 0.06 * (high - low);
  return linear(low - room, high + room, unit, gap);
}

/** An axis over a chosen range. */
export function over(low: number, high: number, unit: string, log: boolean, gap: number): Axis {
  return log ? logarithmic(low, high) : linear(low, high, unit, gap);
}
