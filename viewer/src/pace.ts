// How fast a motion plays: seconds to its independent variable and back.

import { column } from './curves';
import type { Results } from './types';

/** Seconds that a motion without time takes at speed 1. */
const WHOLE = 4;

export interface Pace {
  /** Whether seconds are those of the motion. */
  real: boolean;
  seconds(at: number): number;
  place(seconds: number): number;
}

/** The pace of a motion that begins at `from` and ends at `to`. */
export function pace(results: Results, from: number, to: number): Pace {
  if (results.independent.unit === 's') return { real: true, seconds: (at) => at, place: (s) => s };
  const time = column(results, 'time');
  if (time?.unit === 's') {
    const known = table(results.independent.values, time.values, to < from ? -1 : 1);
    if (known) return known;
  }
  const rate = (to - from || 1) / WHOLE;
  return { real: false, seconds: (at) => at / rate, place: (s) => s * rate };
}

/** By a table, if time rises and the variable rises, or falls, with it. */
function table(at: (number | null)[], time: (number | null)[], sign: number): Pace | null {
  const [x, t]: [number[], number[]] = [[], []];
  at.forEach((place, i) => {
    const seconds = time[i];
    if (place === null || seconds === null || seconds === undefined) return;
    if (x.length === 0 || (sign * place > x[x.length - 1]! && seconds > t[t.length - 1]!)) {
      x.push(sign * place);
      t.push(seconds);
    }
  });
  if (x.length < 2 || x.length < at.length / 2) return null;
  return { real: true, seconds: (place) => line(x, t, sign * place), place: (seconds) => sign * line(t, x, seconds) };
}

function line(x: number[], y: number[], at: number): number {
  let [low, high] = [0, x.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle]! <= at) low = middle;
    else high = middle;
  }
  return y[low]! + ((y[high]! - y[low]!) * (at - x[low]!)) / (x[high]! - x[low]!);
}
