// How large a mechanism in the plane is seen, and where, so that its arrows have room as well.

import type { Arrows, Kind } from '../arrows';
import { FIRST } from '../renderer';
import type { Point } from './pen';

/** Bounds, m. */
export interface Bounds { low: Point; high: Point }

/** The tip of an arrow: where it begins, m, and how far it reaches from there, pixels. */
export interface Tip { at: Point; reach: Point }

/** What is seen: pixels to the metre, and where the middle of the bounds is. */
export interface Fitted { scale: number; middle: Point }

/** Sizes of the picture, with what it shows, of which the room is kept. */
const FITS = 8;

/** What is seen in pictures of several sizes. */
export class Fits {
  private readonly known = new Map<string, Fitted>();

  /** That of a size, made once. */
  of(key: string, make: () => Fitted): Fitted {
    const known = this.known.get(key);
    if (known) return known;
    const made = make();
    if (this.known.size > FITS) this.known.clear();
    this.known.set(key, made);
    return made;
  }

  clear(): void {
    this.known.clear();
  }
}

/** Room around a mechanism for its signs, and around the tips of arrows, pixels. */
export const ROOM = 34;
const EDGE = 6;
/** Part of the scale without arrows that these leave at least, and how often the way to it is halved. */
const LEAST = 0.4;
const HALVINGS = 12;

/** The tips of arrows of some kinds at a scale, pixels to the metre; `tips` are those of a kind, which reach so far in its own unit. */
export function tipsOf(arrows: Arrows, kinds: Set<Kind>, short: number, tips: (kind: Kind) => Tip[]): (scale: number) => Tip[] {
  const all = [...kinds].map((kind) => ({ kind, own: tips(kind) }));
  return (scale) => all.flatMap(({ kind, own }) => {
    const pixels = arrows.pixels(kind, FIRST, short, scale);
    return own.map(({ at, reach }): Tip => ({ at, reach: [reach[0] * pixels, reach[1] * pixels] }));
  });
}

/** The largest scale at which bounds and tips are in a picture, these in the middle where the tips let them. */
export function fitted({ low, high }: Bounds, tips: (scale: number) => Tip[], size: Point): Fitted {
  const [w, h] = [high[0] - low[0] || 1, high[1] - low[1] || 1];
  const alone = Math.min((size[0] - 2 * ROOM) / w, (size[1] - 2 * ROOM) / h);
  const middle: Point = [size[0] / 2, size[1] / 2];
  if (!(alone > 0)) return { scale: alone, middle };
  // how far the middle may be moved, to the right and downwards
  const moves = (scale: number): [number, number][] => {
    const all = tips(scale);
    return ([0, 1] as const).map((i) => {
      const ends = all.map(({ at, reach }) => (at[i] - (low[i] + high[i]) / 2) * scale + reach[i]).map((x) => (i === 0 ? x : -x)).filter(Number.isFinite);
      const half = ((i === 0 ? w : h) * scale) / 2 + ROOM - size[i] / 2;
      return [Math.max(half, ...ends.map((x) => EDGE - size[i] / 2 - x)), Math.min(-half, ...ends.map((x) => size[i] / 2 - EDGE - x))];
    });
  };
  const fits = (scale: number) => moves(scale).every(([from, to]) => from <= to + 1e-6);
  let [least, most] = [LEAST * alone, alone];
  if (fits(alone)) least = alone;
  else for (let k = 0; k < HALVINGS; k++) fits((least + most) / 2) ? (least = (least + most) / 2) : (most = (least + most) / 2);
  const move = moves(least).map(([from, to]) => (from > to ? (from + to) / 2 : Math.min(Math.max(0, from), to)));
  return { scale: least, middle: [middle[0] + move[0]!, middle[1] + move[1]!] };
}
