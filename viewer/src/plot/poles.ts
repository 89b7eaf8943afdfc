// The range of an axis beside dead points, as in the figures of the program: a curve has a pole at an end where its study reports a dead
// point, its value there is not defined, and the values before grow towards it. The axis then ends half of the other values' range beyond.

import type { Curve } from './chart';

/** Part of the curve's length within which values count as near a pole, and how much they must grow there. */
const ZONE = 0.1;
const GROWTH = 3;

/** How many points of a curve are near the poles at its begin and its end. */
function near({ x, y, dead }: Curve): [number, number] {
  const n = x.length;
  if (!dead || n === 0) return [0, 0];
  const length = Math.abs(x[n - 1]! - x[0]!);
  const from = (at: (k: number) => number): number => {
    const first = y.findIndex((_, k) => Number.isFinite(y[at(k)]!));
    if (first < 1) return 0;
    const size = (k: number) => Math.abs(y[at(k)]!);
    let last = first;
    while (last + 1 < n && size(last + 1) < size(last) && Math.abs(x[at(last)]! - x[at(0)]!) <= ZONE * length) last++;
    return size(first) >= GROWTH * size(last) && last > first + 1 ? last : 0;
  };
  return [from((k) => k), from((k) => n - 1 - k)];
}

/** The range of curves without what is near their poles, if that would spoil the scale. */
export function bounded(curves: Curve[]): [number, number] | null {
  if (!curves.some(({ dead }) => dead)) return null;
  const [whole, rest]: [[number, number], [number, number]] = [[Infinity, -Infinity], [Infinity, -Infinity]];
  const widen = (range: [number, number], y: number) => ([range[0], range[1]] = [Math.min(range[0], y), Math.max(range[1], y)]);
  for (const curve of curves) {
    const [begin, end] = near(curve);
    curve.y.forEach((y, k) => {
      if (!Number.isFinite(y)) return;
      widen(whole, y);
      if (k >= begin && k + end < curve.y.length) widen(rest, y);
    });
  }
  const span = rest[1] - rest[0];
  const [below, above] = [rest[0] - whole[0] > span, whole[1] - rest[1] > span];
  return span > 0 && (below || above) ? [below ? rest[0] - span / 2 : whole[0], above ? rest[1] + span / 2 : whole[1]] : null;
}
