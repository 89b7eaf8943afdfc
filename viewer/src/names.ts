// Names beside the joints of a drawing, and of its bodies, springs and paths where there is room. Each keeps its side over the whole motion, so that nothing
// jumps while it plays: the side on which it meets the fewest other names and joints at some places of the motion. Where names meet all the
// same, the later one is left out.

import type { Motion, Vector } from './motion';
import { type Box, around, away, circle, corners, extent, outline } from './outlines';
import { type Pen, type Point, hull, off } from './plane/pen';
import { type Inks, bodyInks, driveInk, pathInk } from './theme';
import type { Shape } from './types';

/** A name that is drawn: where its joint or a place on its body is, and where its text stands. */
export interface Named { text: string; at: Point; box: Box; of: 'joint' | Other['of'] }

/** Joints that are at one place all the time, by the first of them, or something else; how wide their names are, how much room signs take, and where names stand. */
interface Group { text: string; at(place: number): Vector; width: number; room: number; points: Point[]; side: number; other: Other | null; bodies: number[] }

/** A body, spring or path with its name and the places where that may stand. */
interface Other { name: string; of: 'body' | 'link' | 'path'; spots: Spot[]; color(inks: Inks): string; body?: number }

/** A place on a body where its name may stand, and its places over the motion; on what is wide the name lies within. */
interface Spot { at(place: number): Vector; places: Vector[]; wide: boolean }

/** The line of a body, or the edge of what is wide, at the places that are looked at; of what is solid its corners. */
interface Part { body: number; closed: boolean; solid: boolean; lines: Vector[][] }

/** A part as it is seen. */
interface SeenPart { body: number; closed: boolean; lines: Point[][]; boxes: Box[] }

/** Where names stand at the places that are looked at. */
type Taken = Map<Group, Box[]>;

/** Where a point is seen at a place of the motion. */
type Seen = (at: Vector, place: number) => Point;

/** Places of the motion that are looked at, and comparisons of a name with a joint, at most. */
const LOOKS = 24;
const MOST = 3e6;
/** How often the names of joints are placed, each beside those of all others. */
const ROUNDS = 3;
/** Joints that are no farther apart, pixels, have one text, of so many names if there are more than one more. */
const ONE = 4;
const TOGETHER = 3;
/** Room around a joint, pixels, which is its sign's. */
const SIGN = 6;
/** More of it that the arrow of what drives a joint, or stops, take. */
const MARKS = 9;
/** Room that a name needs to come back, pixels, so that one that just fits does not come and go. */
const BACK = 5;
/** Where a text begins from its joint: to the right and upwards first, where a name is looked for; then farther away, at the end of a line, which is longer where much is in the way. */
const near = (w: number): Point[] => [[9, -8], [9, 16], [-9 - w, -8], [-9 - w, 16], [-w / 2, -14], [-w / 2, 22], [13, 4], [-13 - w, 4]];
const far = (w: number): Point[] => [[22, -24], [22, 32], [-22 - w, -24], [-22 - w, 32], [-w / 2, -32], [-w / 2, 42], [36, 4], [-36 - w, 4]];
const farther = (w: number): Point[] => [[44, -52], [44, 60], [-44 - w, -52], [-44 - w, 60], [-w / 2, -62], [-w / 2, 72], [72, 4], [-72 - w, 4]];
const NEAR = 8;
const SIDES = 3 * NEAR;
/** The sides of joints, which all have their names. */
const OF_JOINTS = 2 * NEAR;
/** The side of a name that lies on its body. */
const ON = SIDES;
/** How bad it is, at a place of the motion, to meet a name (for that of a joint more), the edge of the picture or its corner that is taken, or a joint, to stand nearer to a wrong joint or to a wrong body, or in front of one in space. */
const COST = { name: 10, joints: 20, edge: 12, joint: 9, wrong: 9, astray: 3.5, over: 4 };
/** How bad a line is, how much worse a longer one, and by how much the next side is worse than the one before; how much better another side must be than that of before. */
const LINE = 2.5;
const LONGER = 0.7;
const NEXT = 0.1;
const STAY = 0.6;
/** From which cost on a body has no name, and the part of the picture that all names may cover if bodies are to have theirs. */
const CROWDED = 4;
const NAMED = 0.2;
const ROW = 14;
/** Space between names in a row, pixels. */
const WORD = 5;
/** Parts of a bar where its name may stand, and of the radius of a disc, in so many directions. */
const ALONG = [0.5, 0.35, 0.65, 0.2, 0.8];
const RIM = 0.82;
/** Parts of the way from the middle of a plate to its edge, and the edges that are looked at, at most. */
const TO_EDGE = [0.5, 0.8];
const SIDES_NAMED = 6;
const ROUND = 8;

const overlap = (a: Box, b: Box, room = 0) => a[0] - room < b[2] && b[0] - room < a[2] && a[1] - room < b[3] && b[1] - room < a[3];

/** Whether two names meet, or read as one in a row. */
const meet = ([left, top, right, bottom]: Box, other: Box, room = 0) => overlap([left - WORD, top, right + WORD, bottom], other, room);

/** The box of a text on one of its sides, where a sign takes more room than that of a joint. */
function boxOn(side: number, [x, y]: Point, { width, room }: Pick<Group, 'width' | 'room'>): Box {
  if (side === ON) return [x - width / 2, y - 6, x + width / 2, y + 6];
  let [dx, dy] = [near, far, farther][Math.floor(side / NEAR)]!(width)[side % NEAR]!;
  if (side < NEAR && dx > 0) dx += room;
  else if (side < NEAR && dx < -width) dx -= room;
  else if (side < NEAR) dy += Math.sign(dy) * room;
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

/** Where the name of a body may stand, in its frame: along a bar, in the middle of what is wide and towards its edges. */
function spots(shape: Shape): { places: number[][]; wide: boolean } {
  const middle = (points: number[][]) => points[0]!.map((_, i) => points.reduce((sum, p) => sum + p[i]!, 0) / points.length);
  const toward = (from: number[], to: number[], s: number) => from.map((x, i) => x + s * (to[i]! - x));
  const along = (from: number[], to: number[]) => ALONG.map((s) => toward(from, to, s));
  const within = (points: number[][]) => {
    const center = middle(points);
    if (points.length < 3 || center.length > 2) return [center];
    const every = Math.ceil(points.length / SIDES_NAMED);
    const edges = points.flatMap((point, k) => (k % every === 0 ? [toward(point, points[(k + 1) % points.length]!, 0.5)] : []));
    return [center, ...TO_EDGE.flatMap((s) => edges.map((edge) => toward(center, edge, s)))];
  };
  switch (shape.kind) {
    case 'bar': return { places: along(shape.from, shape.to), wide: false };
    case 'cylinder': return { places: [middle([shape.from, shape.to])], wide: true };
    case 'hull': return shape.points.length === 2 ? { places: along(shape.points[0]!, shape.points[1]!), wide: false } : { places: within(shape.points), wide: shape.points.length > 2 };
    case 'polygon': return { places: within(shape.points), wide: true };
    case 'mass': return { places: [shape.at], wide: false };
    case 'disc': case 'gear': return { places: [...(shape.radius > 0 ? [shape.center] : []), ...circle(shape.center, RIM * Math.abs(shape.radius), ROUND)], wide: true };
    default: return { places: [shape.center], wide: true };
  }
}

/** Whether the middle of a box, or one of its ends, lies within a part that is wide, at a place that is looked at. */
function covers({ closed, lines, boxes }: SeenPart, look: number, box: Box): boolean {
  if (!closed || !overlap(boxes[look]!, box)) return false;
  const [y, line] = [(box[1] + box[3]) / 2, lines[look]!];
  return [box[0], (box[0] + box[2]) / 2, box[2]].some((x) => away([x, y], line, true) === 0);
}

export class Names {
  /** What was drawn last. */
  drawn: Named[] = [];
  /** What has no name in the present view, as there is no room for it. */
  left: string[] = [];
  private groups: Group[] = [];
  private readonly joints: (Spot & { name: string; room: number; bodies: number[] })[];
  private readonly others: Other[];
  /** The names that were left out last. */
  private hidden = new Set<string>();
  private view = '';
  /** The places of the motion that are looked at, and where bodies are there. */
  private readonly looks: number[];
  private readonly parts: Part[];
  /** Parts in the present view; in space names keep clear of those of other bodies, whatever is in front. */
  private seenParts: SeenPart[] = [];
  private readonly inSpace: boolean;

  /** Names of a motion, clear of what stands in the lower left corner of the picture. */
  constructor(motion: Motion, private readonly corner: Point = [0, 0]) {
    const joints = motion.scene.joints.filter(({ kind }) => kind !== 'distance');
    const { bodies, links, traces } = motion.scene;
    this.inSpace = motion.scene.dimensions === 3;
    const looks = Math.max(1, Math.min(LOOKS, Math.floor(MOST / (SIDES * Math.max(joints.length + bodies.length, 1) ** 2))));
    const at = motion.sampled(looks);
    this.looks = at;
    const spot = (of: (place: number) => Vector, wide = false): Spot => ({ at: of, places: at.map(of), wide });
    this.joints = joints.map(({ name, a, b, driven, ends }) => ({ name, room: driven || ends ? MARKS : 0, bodies: [a.body, b.body], ...spot((place) => motion.world(b, place)) }));
    this.parts = bodies.flatMap(({ shapes: [shape] }, body): Part[] => {
      if (body === 0 || !shape) return [];
      const solid = this.inSpace ? corners(shape) : [];
      const { line, closed } = solid.length > 0 ? { line: solid, closed: true } : outline(shape);
      return [{ body, closed, solid: solid.length > 0, lines: at.map((place) => line.map((own) => motion.world({ body, at: own }, place))) }];
    });
    this.others = bodies.flatMap(({ name, shapes: [shape], color }, body): Other[] => {
      if (body === 0 || !shape) return [];
      const { places, wide } = spots(shape);
      const all = places.map((own) => spot((place) => motion.world({ body, at: own }, place), wide));
      return [{ name, of: 'body', spots: all, color: (inks) => bodyInks(color, inks).edge, body }];
    });
    for (const { name, kind, a, b } of links) {
      const between = (s: number) => (place: number): Vector => {
        const [from, to] = [motion.world(a, place), motion.world(b, place)];
        return [0, 1, 2].map((i) => from[i]! + s * (to[i]! - from[i]!)) as Vector;
      };
      if (name !== '') this.others.push({ name, of: 'link', spots: (kind === 'torsion' || kind === 'brake' ? [0.5] : ALONG).map((s) => spot(between(s))), color: (inks) => (kind === 'actuator' ? driveInk(inks) : inks.rust) });
    }
    // the one path of a joint or body that is named goes without a name of its own
    const known = new Set([...joints, ...bodies].map(({ name }) => name));
    traces.forEach(({ name, body, at: own }, k) => {
      if (known.has(name) && traces.length === 1) return;
      const text = known.has(name) ? `path of ${name}` : name;
      this.others.push({ name: text, of: 'path', spots: [spot((place) => motion.world({ body, at: own }, place))], color: (inks) => pathInk(k, inks) });
    });
  }

  /** Finds the sides anew with the next drawing, whatever they were. */
  forget(): void {
    [this.groups, this.view] = [[], ''];
    this.hidden.clear();
  }

  /** Draws the names at a place of the motion, where `pixel` sees points; `view` is another one when it sees them elsewhere; with those of paths if these are drawn. */
  draw(pen: Pen, place: number, pixel: Seen, view: number[], size: Point, inks: Inks, paths: boolean): void {
    const seen = [...view, ...size, paths].join();
    if (seen !== this.view) this.arrange(pen, pixel, size, paths);
    this.view = seen;
    this.drawn = [];
    const hidden = new Set<string>();
    const colors: string[] = [];
    for (const group of this.groups) {
      const { text, at: where, side, other } = group;
      const at = pixel(where(place), place);
      const box = within(boxOn(side, at, group), size);
      const room = this.hidden.has(text) ? BACK : 0;
      if (!overlap([...at, ...at], [0, 0, ...size]) || this.drawn.some((one) => meet(box, one.box, room))) {
        hidden.add(text);
        continue;
      }
      const { to, far: length } = toBox(at, box);
      if (side >= NEAR && side < ON && length > SIGN) pen.path([off(at, [(to[0] - at[0]) / length, (to[1] - at[1]) / length], SIGN, 0), to]).stroke(inks.faint, 1);
      if (side >= NEAR && side < ON && other) pen.circle(at, 1.8).fill(inks.soft);
      this.drawn.push({ text, at, box, of: other?.of ?? 'joint' });
      colors.push(other ? other.color(inks) : inks.soft);
    }
    this.hidden = hidden;
    this.drawn.forEach(({ text, box }, k) => pen.text(text, [box[0], box[3] - 2], colors[k]!, inks.paper));
  }

  /** Finds the side of each name in a view. */
  private arrange(pen: Pen, pixel: Seen, size: Point, paths: boolean): void {
    const before = new Map(this.groups.map(({ text, side }) => [text, side]));
    this.seenParts = this.parts.map(({ body, closed, solid, lines }) => {
      const flat = lines.map((line, k) => line.map((p) => pixel(p, this.looks[k]!)));
      const edges = solid ? flat.map(hull) : flat;
      return { body, closed, lines: edges, boxes: edges.map(around) };
    });
    this.groups = this.together(pen, pixel);
    const taken: Taken = new Map();
    const take = (group: Group) => taken.set(group, group.points.map((at) => within(boxOn(group.side, at, group), size)));
    for (let round = 0; round < ROUNDS; round++) {
      for (const group of this.groups) {
        taken.delete(group);
        this.choose(group, OF_JOINTS, before.get(group.text), taken, size);
        take(group);
      }
    }
    const joints = this.groups;
    const others = this.others.filter(({ of }) => of !== 'path' || paths);
    this.left = [];
    const area = [...joints.map(({ width }) => width), ...others.map(({ name }) => pen.width(name))].reduce((sum, width) => sum + width * ROW, 0);
    if (area > NAMED * size[0] * size[1]) {
      this.left = others.map(({ name }) => name);
      return;
    }
    for (const other of others) {
      const { name: text, spots: all } = other;
      const width = pen.width(text);
      const groups = all.map(({ at, places, wide }, k) => {
        const group: Group = { text, at, width, room: 0, points: this.seen(places, pixel), side: 0, other, bodies: other.body === undefined ? [] : [other.body] };
        const cost = this.choose(group, wide ? ON + 1 : SIDES, before.get(text), taken, size) + NEXT * k;
        return { group, cost, all: other.body === undefined ? cost : cost + this.astray(group, other.body, size) };
      });
      const best = groups.reduce((a, b) => (b.all < a.all ? b : a));
      if (best.cost > CROWDED) {
        this.left.push(text);
        continue;
      }
      take(best.group);
      this.groups = [...this.groups, best.group];
    }
  }

  /** Where a point is seen over the motion. */
  private seen(places: Vector[], pixel: Seen): Point[] {
    return places.map((at, k) => pixel(at, this.looks[k]!));
  }

  /** Gives a name the best of its sides; how bad that is. */
  private choose(group: Group, sides: number, before: number | undefined, taken: Taken, size: Point): number {
    const { points } = group;
    let least = Infinity;
    for (let side = 0; side < sides; side++) {
      const first = (side < NEAR || side === ON ? 0 : LINE) + (side >= 2 * NEAR && side < ON ? LONGER : 0) + (side === ON ? -NEXT : NEXT * (side % NEAR)) - (before === side ? STAY : 0);
      const cost = this.cost(group, side, taken, size, (least - first) * points.length) / points.length + first;
      if (cost < least) [least, group.side] = [cost, side];
    }
    return least;
  }

  /** What stands in the way of a name on a side over the motion; no more than `most` is of interest. */
  private cost(group: Group, side: number, taken: Taken, size: Point, most: number): number {
    let sum = 0;
    for (let k = 0; k < group.points.length && sum < most; k++) {
      const own = group.points[k]!;
      const free = boxOn(side, own, group);
      const box = within(free, size);
      if (box[0] !== free[0] || box[1] !== free[1] || (box[0] < this.corner[0] && box[3] > size[1] - this.corner[1])) sum += COST.edge;
      for (const boxes of taken.values()) if (meet(box, boxes[k]!, 1)) sum += group.other ? COST.name : COST.joints;
      if (this.inSpace && group.bodies.length > 0) sum += COST.over * this.seenParts.filter((part) => !group.bodies.includes(part.body) && covers(part, k, box)).length;
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

  /** How bad it is that a name, or the place where it begins, is nearer to other bodies than to its own, or within a smaller one. */
  private astray(group: Group, body: number, size: Point): number {
    const parts = this.seenParts;
    const own = parts.find((part) => part.body === body);
    if (!own) return 0;
    let wrong = 0;
    const { points } = group;
    points.forEach((at, k) => {
      const [left, top, right, bottom] = within(boxOn(group.side, at, group), size);
      const middle: Point = [(left + right) / 2, (top + bottom) / 2];
      const line = own.lines[k]!;
      const [gap, most] = [away(middle, line, own.closed), extent(line)];
      const taken = (part: typeof own) => {
        const other = part.lines[k]!;
        const near = away(middle, other, part.closed);
        // what is larger is behind in the plane
        if (!this.inSpace && near === 0 && extent(other) >= most) return false;
        if (own.closed && gap === 0) return near === 0;
        return near < gap || (!own.closed && away(at, other, part.closed) < SIGN);
      };
      if (parts.some((part) => part !== own && taken(part))) wrong++;
    });
    return (COST.astray * wrong) / points.length;
  }

  /** The joints in groups that are at one place all the time. */
  private together(pen: Pen, pixel: Seen): Group[] {
    const groups: { names: string[]; at: Group['at']; points: Point[]; room: number; bodies: number[] }[] = [];
    for (const { name, at, places, room, bodies } of this.joints) {
      const points = this.seen(places, pixel);
      const near = (p: Point, k: number) => Math.hypot(p[0] - points[k]![0], p[1] - points[k]![1]) < ONE;
      const known = groups.find((group) => group.points.every(near));
      if (known) {
        known.names.push(name);
        known.room = Math.max(known.room, room);
        known.bodies.push(...bodies);
      } else groups.push({ names: [name], at, points, room, bodies: [...bodies] });
    }
    return groups.map(({ names, at, points, room, bodies }) => {
      const text = names.length <= TOGETHER + 1 ? names.join(', ') : `${names.slice(0, TOGETHER).join(', ')}, ...`;
      return { text, at, points, room, width: pen.width(text), side: 0, other: null, bodies };
    });
  }
}
