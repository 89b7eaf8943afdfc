// What the length of arrows means: at the foot of a drawing an arrow of each kind that is shown, and how much that is.

import { type Arrows, COLOR, KINDS, type Kind, ROUND, TURNING, type Turning } from './arrows';
import { digits, pretty } from './numbers';
import { LEVEL, type Pen } from './plane/pen';
import { scaled } from './plot/axis';
import type { Inks } from './theme';

/** Pixels of the longest arrow that tells a scale; of the text behind it, between two kinds, and to the edges of the drawing. */
const SAMPLE = 60;
const BEHIND = 8;
const BETWEEN = 18;
const EDGE = 16;
/** Height of a row, and of its letters. */
const ROW = 18;
const LETTERS = 11;

/** An arrow that tells the scale of a kind, with its length in pixels; of what turns one that tells the largest. */
export interface Told { kind: Kind | Turning; text: string; length: number }

/** The largest of 1, 2 and 5 times a power of ten that is not above a number. */
function below(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  return [5, 2, 1].map((m) => m * power).find((round) => round <= x * (1 + 1e-9)) ?? power;
}

/** How much an arrow of round length is, if so many pixels are one unit. */
function told(kind: Kind, pixels: number, arrows: Arrows): Told {
  const { unit, size } = arrows.unit(kind);
  const value = below(SAMPLE / (pixels * size));
  // forces from 1 kN on have that unit, as in the figures of the program
  const { unit: name, factor } = scaled(unit, unit === 'N' && value >= 1e3 ? Math.max(value, 1e4) : value);
  const without = kind === 'reactions' && arrows.geared() ? ' without ropes and teeth' : '';
  return { kind, text: `${kind}: ${digits(value * factor, 3)} ${pretty(name)}${without}`, length: value * size * pixels };
}

/** The largest torque of a kind, if there is one. */
function turning(arrows: Arrows, of: Kind): Told[] {
  const kind = TURNING[of];
  if (!kind) return [];
  const { unit, size } = arrows.unit(kind);
  const most = arrows.most(kind) / size;
  if (!(most > 0)) return [];
  // as forces
  const kilo = unit === 'N m' && most >= 1e3;
  return [{ kind, text: `${kind}: at most ${digits(most / (kilo ? 1e3 : 1), 3)} ${kilo ? 'k' : ''}${pretty(unit)}`, length: ROUND }];
}

/** Those that are shown, from the right corner at the foot to `left`, each with its left end and foot, in rows one above the other. */
function placed(pen: Pen, arrows: Arrows, shown: Set<Kind>, pixels: (kind: Kind) => number, left: number, [width, height]: [number, number]): (Told & { from: number; foot: number })[] {
  const all = KINDS.filter((kind) => shown.has(kind)).flatMap((kind) => [
    ...(arrows.most(kind) > 0 && pixels(kind) > 0 ? [told(kind, pixels(kind), arrows)] : []),
    ...turning(arrows, kind),
  ]);
  let [right, foot] = [width - EDGE, height - 12];
  return [...all].reverse().map((one) => {
    const room = one.length + BEHIND + pen.width(one.text, LETTERS);
    // above the bar of the scale is room for what is longer than beside it
    if (right - room < left && (right < width - EDGE || foot === height - 12)) [right, foot] = [width - EDGE, foot - ROW];
    const from = right - room;
    right = from - BETWEEN;
    return { ...one, from, foot };
  });
}

/** Height of the foot of a drawing that they take, pixels. */
export function scalesHeight(pen: Pen, arrows: Arrows, shown: Set<Kind>, pixels: (kind: Kind) => number, left: number, size: [number, number]): number {
  return Math.max(0, ...placed(pen, arrows, shown, pixels, left, size).map(({ foot }) => size[1] - foot + ROW));
}

/** Draws them from the right corner at the foot to `left`, in rows one above the other where there is no room. */
export function tellScales(pen: Pen, arrows: Arrows, shown: Set<Kind>, pixels: (kind: Kind) => number, left: number, size: [number, number], inks: Inks): Told[] {
  const all = placed(pen, arrows, shown, pixels, left, size);
  for (const { kind, text, length, from, foot } of all) {
    if (kind === 'torques' || kind === 'moments') pen.turn([from + length / 2, foot - 4], LEVEL, 1, length / 2, inks.curves[COLOR[kind === 'torques' ? 'loads' : 'reactions']]!);
    else pen.arrow([from, foot - 4], [from + length, foot - 4], inks.curves[COLOR[kind]]!, 2.2);
    pen.text(text, [from + length + BEHIND, foot], inks.soft, inks.paper, LETTERS);
  }
  return all.reverse().map(({ kind, text, length }) => ({ kind, text, length }));
}
