// Names beside the joints of a drawing. Each keeps its side over the whole motion, so that nothing jumps while it plays: the side on which
// it meets the fewest other names and joints at some places of the motion. Where names meet all the same, the later one is left out.

import type { Motion, Vector } from './motion';
import { type Pen, type Point, off } from './plane/pen';
import type { Inks } from './theme';
import type { Place } from './types';

/** Left, top, right, bottom. */
export type Box = [number, number, number, number];

/** A name that is drawn: where its joint is, and where its text stands. */
export interface Named { text: string; at: Point; box: Box }

/** Joints that are at one place all the time, by the first of them; how wide their names are, and where these stand. */
interface Group { text: string; joint: Place; width: number; points: Point[]; side: number }

/** Places of the motion that are looked at, and comparisons of a name with a joint, at most. */
const LOOKS = 24;
const MOST = 3e6;
/** Joints that are no farther apart, pixels, have one text, of so many names. */
const ONE = 4;
const TOGETHER = 3;
/** Room around a joint, pixels, which is its sign's. */
const SIGN = 6;
/** Room that a name needs to come back, pixels, so that one that just fits does not come and go. */
const BACK = 5;
/** Where a text begins from its joint: to the right and upwards first, where a name is looked for; then farther away, at the end of a line. */
const near = (w: number): Point[] => [[9, -8], [9, 16], [-9 - w, -8], [-9 - w, 16], [-w / 2, -14], [-w / 2, 22], [13, 4], [-13 - w, 4]];
const far = (w: number): Point[] => [[22, -24], [22, 32], [-22 - w, -24], [-22 - w, 32], [-w / 2, -32], [-w / 2, 42], [36, 4], [-36 - w, 4]];
const SIDES = 16;
const NEAR = 8;
/** How bad it is, at a place of the motion, to meet a name, the edge of the picture or a joint, or to stand nearer to a wrong joint. */
const COST = { name: 10, edge: 12, joint: 9, wrong: 9 };
/** How bad a line is, and by how much the next side is worse than the one before; how much better another side must be than that of before. */
const LINE = 2.5;
const NEXT = 0.1;
const STAY = 0.6;

const overlap = (a: Box, b: Box, room = 0) => a[0] - room < b[2] && b[0] - room < a[2] && a[1] - room < b[3] && b[1] - room < a[3];

/** The box of a text on one of its sides. */
function boxOn(side: number, [x, y]: Point, width: number): Box {
  const [dx, dy] = (side < NEAR ? near(width) : far(width))[side % NEAR]!;
  return [x + dx, y + dy - 10, x + dx + width, y + dy + 2];
}

/** A box moved into the picture. */
function within([left, top, right, bottom]: Box, [width, height]: Point): Box {
  const [dx, dy] = [Math.max(2 - left, 0) || Math.min(width - 2 - right, 0), Math.max(2 - top, 0) || Math.min(height - 2 - bottom, 0)];
  return [left + dx, top + dy, right + dx, bottom + dy];
}

/** From a point to the nearest one of a box, and how far that is. */
function toBox([x, y]: Point, [left, top, right, bottom]: Box): { to: Point; far: number } {
  const to: Point = [Math.min(Math.max(x, left), right), Math.min(Math.max(y, top), bottom)];
  return { to, far: Math.hypot(to[0] - x, to[1] - y) };
}

export class Names {
  /** What was drawn last. */
  drawn: Named[] = [];
  private groups: Group[] = [];
  private readonly joints: { name: string; joint: Place; places: Vector[] }[];
  /** The names that were left out last. */
  private hidden = new Set<string>();
  private view = '';

  constructor(private readonly motion: Motion) {
    const joints = motion.scene.joints.filter(({ kind }) => kind !== 'distance');
    const looks = Math.max(1, Math.min(LOOKS, Math.floor(MOST / (SIDES * Math.max(joints.length, 1) ** 2))));
    const at = motion.sampled(looks);
    this.joints = joints.map(({ name, b }) => ({ name, joint: b, places: at.map((place) => motion.world(b, place)) }));
  }

  /** Finds the sides anew with the next drawing, whatever they were. */
  forget(): void {
    [this.groups, this.view] = [[], ''];
    this.hidden.clear();
  }

  /** Draws the names at a place of the motion, where `pixel` sees points; `view` is another one when it sees them elsewhere. */
  draw(pen: Pen, place: number, pixel: (at: Vector) => Point, view: number[], size: Point, inks: Inks): void {
    const seen = [...view, ...size].join();
    if (seen !== this.view) this.arrange(pen, pixel, size);
    this.view = seen;
    this.drawn = [];
    const hidden = new Set<string>();
    for (const { text, joint, width, side } of this.groups) {
      const at = pixel(this.motion.world(joint, place));
      const box = within(boxOn(side, at, width), size);
      const room = this.hidden.has(text) ? BACK : 0;
      if (!overlap([...at, ...at], [0, 0, ...size]) || this.drawn.some((other) => overlap(box, other.box, room))) {
        hidden.add(text);
        continue;
      }
      const { to, far: length } = toBox(at, box);
      if (side >= NEAR && length > SIGN) pen.path([off(at, [(to[0] - at[0]) / length, (to[1] - at[1]) / length], SIGN, 0), to]).stroke(inks.faint, 1);
      this.drawn.push({ text, at, box });
    }
    this.hidden = hidden;
    for (const { text, box } of this.drawn) pen.text(text, [box[0], box[3] - 2], inks.soft, inks.paper);
  }

  /** Finds the side of each name in a view. */
  private arrange(pen: Pen, pixel: (at: Vector) => Point, size: Point): void {
    const before = new Map(this.groups.map(({ text, side }) => [text, side]));
    this.groups = this.together(pen, pixel);
    const taken: Box[][] = [];
    for (const group of this.groups) {
      const { points, width, text } = group;
      let least = Infinity;
      for (let side = 0; side < SIDES; side++) {
        const first = (side < NEAR ? 0 : LINE) + NEXT * (side % NEAR) - (before.get(text) === side ? STAY : 0);
        const cost = this.cost(group, side, taken, size, (least - first) * points.length) / points.length + first;
        if (cost < least) [least, group.side] = [cost, side];
      }
      points.forEach((at, k) => (taken[k] ??= []).push(within(boxOn(group.side, at, width), size)));
    }
  }

  /** What stands in the way of a name on a side over the motion; no more than `most` is of interest. */
  private cost(group: Group, side: number, taken: Box[][], size: Point, most: number): number {
    let sum = 0;
    for (let k = 0; k < group.points.length && sum < most; k++) {
      const own = group.points[k]!;
      const free = boxOn(side, own, group.width);
      const box = within(free, size);
      if (box[0] !== free[0] || box[1] !== free[1]) sum += COST.edge;
      for (const other of taken[k] ?? []) if (overlap(box, other, 1)) sum += COST.name;
      const away = toBox(own, box).far;
      for (const { points } of this.groups) {
        const at = points[k]!;
        if (points === group.points || Math.abs(at[0] - own[0]) > group.width + 60 || Math.abs(at[1] - own[1]) > 80) continue;
        const gap = toBox(at, box).far;
        sum += gap < SIGN ? COST.joint : side < NEAR && gap < away ? COST.wrong : 0;
      }
    }
    return sum;
  }

  /** The joints in groups that are at one place all the time. */
  private together(pen: Pen, pixel: (at: Vector) => Point): Group[] {
    const groups: { names: string[]; joint: Place; points: Point[] }[] = [];
    for (const { name, joint, places } of this.joints) {
      const points = places.map(pixel);
      const near = (at: Point, k: number) => Math.hypot(at[0] - points[k]![0], at[1] - points[k]![1]) < ONE;
      const known = groups.find((group) => group.points.every(near));
      if (known) known.names.push(name);
      else groups.push({ names: [name], joint, points });
    }
    return groups.map(({ names, joint, points }) => {
      const text = names.slice(0, TOGETHER).join(', ') + (names.length > TOGETHER ? ', ...' : '');
      return { text, joint, points, width: pen.width(text), side: 0 };
    });
  }
}
