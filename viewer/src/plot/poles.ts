// The range of an axis beside values without bound, as in the figures of the program: a curve has a pole at an end where its study reports
// a dead point, its value there is not defined, and the values before grow towards it. Numbers of whole runs have one between two runs
// where they change their sign and their reciprocals pass through zero in a straight line; and those are without bound that are beyond all
// sizes in mechanics and beyond all others of their curve. The axis then ends half of the other values' range beyond.

import type { Curve } from './chart';

/** Part of the curve's length within which values count as near a pole, and how much they must grow there. */
const ZONE = 0.1;
const GROWTH = 3;
/** How far reciprocals beside a pole may be off a straight line, as a part of their range over four runs. */
const BENT = 0.05;
/** The size from which on a number of a run may be without bound, and how many times the largest of the others it must be. */
const BOUNDLESS = 1e12;
const BEYOND = 1e9;

/** Which points of a curve are near its poles or without bound. */
function near({ x, y, dead, runs }: Curve): boolean[] {
  const n = x.length;
  const out = new Array<boolean>(n).fill(false);
  if ((!dead && !runs) || n === 0) return out;
  const length = Math.abs(x[n - 1]! - x[0]!);
  // of points that lead away from a pole, of which the first with a value is `first`: how many are near it
  const from = (first: number, at: (k: number) => number, count: number): number => {
    const size = (k: number) => Math.abs(y[at(k)]!);
    let last = first;
    while (last + 1 < count && size(last + 1) < size(last) && Math.abs(x[at(last)]! - x[at(0)]!) <= ZONE * length) last++;
    return size(first) >= GROWTH * size(last) && last > first + 1 ? last : 0;
  };
  if (dead) {
    for (const at of [(k: number) => k, (k: number) => n - 1 - k]) {
      const first = y.findIndex((_, k) => Number.isFinite(y[at(k)]!));
      if (first > 0) for (let k = from(first, at, n); k > 0; k--) out[at(k - 1)] = true;
    }
  }
  if (runs) {
    const most = bound(y);
    // a gap may stand where the pole is
    const kept = y.flatMap((value, k) => (Math.abs(value) < most ? [k] : []));
    const [u, v] = [kept.map((k) => x[k]!), kept.map((k) => y[k]!)];
    kept.forEach((_, k) => {
      if (!isPole(u, v, k)) return;
      for (let i = from(0, (i) => kept[k - i]!, k + 1); i > 0; i--) out[kept[k + 1 - i]!] = true;
      for (let i = from(0, (i) => kept[k + 1 + i]!, kept.length - k - 1); i > 0; i--) out[kept[k + i]!] = true;
    });
    y.forEach((value, k) => (out[k] ||= Math.abs(value) >= most));
  }
  return out;
}

/** The size from which on numbers of whole runs are without bound; infinite if none is. */
export function bound(y: number[]): number {
  const sizes = y.map(Math.abs).filter(Number.isFinite).sort((a, b) => a - b);
  return sizes.find((size, k) => k > 0 && size >= BOUNDLESS && size >= BEYOND * sizes[k - 1]!) ?? Infinity;
}

/** Whether a pole lies between a number of a whole run and the next one. */
export function isPole(x: number[], y: number[], k: number): boolean {
  if (k < 1 || k + 2 >= y.length) return false;
  const [a, b, c, d] = [y[k - 1]!, y[k]!, y[k + 1]!, y[k + 2]!];
  if (!(a * b > 0 && b * c < 0 && c * d > 0 && Math.abs(a) < Math.abs(b) && Math.abs(d) < Math.abs(c))) return false;
  const [first, last] = [1 / a, 1 / d];
  return [k, k + 1].every((i) => Math.abs(1 / y[i]! - first - ((last - first) * (x[i]! - x[k - 1]!)) / (x[k + 2]! - x[k - 1]!)) <= BENT * Math.abs(last - first));
}

/** The range of curves without what is near their poles or without bound, if that would spoil the scale. */
export function bounded(curves: Curve[]): [number, number] | null {
  if (!curves.some(({ dead, runs }) => dead || runs)) return null;
  const [whole, rest]: [[number, number], [number, number]] = [[Infinity, -Infinity], [Infinity, -Infinity]];
  const widen = (range: [number, number], y: number) => ([range[0], range[1]] = [Math.min(range[0], y), Math.max(range[1], y)]);
  for (const curve of curves) {
    const beyond = near(curve);
    curve.y.forEach((y, k) => {
      if (!Number.isFinite(y)) return;
      widen(whole, y);
      if (!beyond[k]) widen(rest, y);
    });
  }
  const span = rest[1] - rest[0];
  const [below, above] = [rest[0] - whole[0] > span, whole[1] - rest[1] > span];
  return span > 0 && (below || above) ? [below ? rest[0] - span / 2 : whole[0], above ? rest[1] + span / 2 : whole[1]] : null;
}
