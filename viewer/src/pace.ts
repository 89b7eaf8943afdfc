// How fast a motion plays: seconds to its independent variable and back.

import { column } from './curves';
import type { Column, Num, Results } from './types';

/** Seconds that a motion without time takes at first. */
export const WHOLE = 4;
/** Pairs of columns of one joint or body: a coordinate, and its rate. */
const RATES: [string, string][] = [['angle', 'omega'], ['angle', 'velocity'], ['position', 'velocity'], ['x', 'vx'], ['y', 'vy'], ['z', 'vz']];
/** The same of an effort and its power, by the unit of what moves. */
const POWERS: Record<string, string> = { rad: 'torque', m: 'force' };
/** Part of the largest speed by which a speed from powers may vary. */
const EVEN = 1e-3;

export interface Pace {
  /** Whether seconds are those of the motion. */
  real: boolean;
  seconds(at: number): number;
  place(seconds: number): number;
}

/** The pace of a motion that begins at `from` and ends at `to`; names of `loads` tell nothing of drivers. */
export function pace(results: Results, from: number, to: number, loads: string[] = []): Pace {
  const { independent } = results;
  if (independent.unit === 's') return { real: true, seconds: (at) => at, place: (s) => s };
  const sign = to < from ? -1 : 1;
  const time = column(results, 'time');
  const known = (time?.unit === 's' && table(independent.values, time.values, sign)) || byRates(results, sign) || bySpeed(speedOf(results, loads), from, to);
  if (known) return known;
  const rate = (to - from || 1) / WHOLE;
  return { real: false, seconds: (at) => at / rate, place: (s) => s * rate };
}

/** By the rate of a coordinate that both are columns. */
function byRates(results: Results, sign: number): Pace | null {
  const all = [...results.table.columns, ...results.curves, results.independent];
  for (const place of all) {
    for (const [own, rate] of RATES) {
      const name = place.name.endsWith(`.${own}`) ? `${place.name.slice(0, -own.length)}${rate}` : '';
      const found = name !== '' && column(results, name);
      const time = found && found.unit === `${place.unit}/s` && passed(place.values, found.values);
      const known = time && table(results.independent.values, time, sign);
      if (known) return known;
    }
  }
  return null;
}

/** Seconds at each row of a coordinate by its rate, by trapezoids; none where it stands or turns back. */
function passed(place: Num[], rate: Num[]): number[] | null {
  const out = [0];
  for (let i = 1; i < place.length; i++) {
    const [a, b, from, to] = [rate[i - 1], rate[i], place[i - 1], place[i]];
    if (typeof a !== 'number' || typeof b !== 'number' || typeof from !== 'number' || typeof to !== 'number' || a * b <= 0 || a / b > 2 || b / a > 2) return null;
    out.push(out[i - 1]! + (2 * (to - from)) / (a + b));
  }
  return out.length > 1 ? out : null;
}

/** The constant speed of the driver along the variable, from its power and its effort; none if nothing tells it, or columns contradict. */
function speedOf(results: Results, loads: string[]): number | null {
  const effort = POWERS[results.independent.unit];
  const all = [...results.table.columns, ...results.curves];
  const speeds = all.flatMap((power) => {
    const [name, kind] = [power.name.slice(0, power.name.lastIndexOf('.')), power.name.slice(power.name.lastIndexOf('.') + 1)];
    const of = effort && kind === 'power' && !loads.includes(name) ? column(results, `${name}.${effort}`) : undefined;
    return of ? [quotient(power, of)] : [];
  });
  return speeds.length === 1 ? speeds[0]! : null;
}

/** What one column is of another where it is the same in all rows. */
function quotient(above: Column, below: Column): number | null {
  const most = Math.max(0, ...below.values.map((x) => Math.abs(x ?? 0)));
  const all = below.values.flatMap((x, i) => (x !== null && Math.abs(x) > 0.05 * most && typeof above.values[i] === 'number' ? [above.values[i]! / x] : []));
  if (all.length < 3) return null;
  const [low, high] = [Math.min(...all), Math.max(...all)];
  return high - low <= EVEN * Math.max(Math.abs(low), Math.abs(high)) && low * high > 0 ? (low + high) / 2 : null;
}

function bySpeed(speed: number | null, from: number, to: number): Pace | null {
  if (speed === null || !((to - from) * speed > 0)) return null;
  return { real: true, seconds: (at) => (at - from) / speed, place: (seconds) => from + speed * seconds };
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
