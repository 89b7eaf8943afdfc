// Signs of the field: bearings, slides, slots, springs, dampers, gears.

import type { Inks } from '../theme';
import { driveInk, mixed, stopInk } from '../theme';
import type { Joint, LinkKind } from '../types';
import { type Pen, type Point, off, toward } from './pen';

/** Half the length and half the width of the box of a slide. */
const BOX: Point = [13, 8];
/** Dashes of centre lines. */
const CENTRE = [11, 3.5, 2, 3.5];
/** Dashes of pitch circles; radius of the rim of a ring without teeth, as a multiple of that of its pitch circle, as in the figures. */
const PITCH = [8, 3, 1.5, 3];
const RIM = 1.08;

/** A line with the hatch of solid ground on its right side, seen from a to b. */
export function hatched(pen: Pen, a: Point, b: Point, inks: Inks): void {
  const { along, length } = toward(a, b);
  const count = Math.max(1, Math.round(length / 8));
  for (let k = 1; k <= count; k++) {
    const s = (length * k) / count;
    pen.path([off(a, along, s, 0), off(a, along, s - 7, 7)]).stroke(inks.faint, 1);
  }
  pen.path([a, b]).stroke(inks.soft, 1.6);
}

/** The bearing of the frame below a hinge, or above it. */
export function bearing(pen: Pen, at: Point, inks: Inks, above = false): void {
  const side = above ? -1 : 1;
  const foot = at[1] + side * 20;
  pen.path([at, [at[0] - 12, foot], [at[0] + 12, foot]], true).fill(mixed(inks.paper, inks.faint, 0.25)).stroke(inks.soft, 1.4);
  hatched(pen, [at[0] - side * 17, foot], [at[0] + side * 17, foot], inks);
}

/** A piece of ground at the end of a link that comes along a direction. */
export function anchor(pen: Pen, at: Point, along: Point, inks: Inks): void {
  hatched(pen, off(at, along, 0, 9), off(at, along, 0, -9), inks);
}

/** What a slide slides on, from one end to the other: hatched ground on its lower side, or on its upper one, at least `clear` pixels away, or a guide on a body of these colours, as wide as the box. */
export function slideway(pen: Pen, a: Point, b: Point, body: { fill: string; edge: string } | null, clear: number, inks: Inks, upper = false): void {
  if (body) {
    pen.path([a, b]).stroke(body.edge, 2 * BOX[1] + 7).stroke(mixed(inks.paper, body.fill, 0.25), 2 * BOX[1] + 4);
    return;
  }
  const [from, to] = isBackwards([b[0] - a[0], b[1] - a[1]]) !== upper ? [b, a] : [a, b];
  const { along } = toward(from, to);
  const below = Math.max(BOX[1] + 1, clear);
  hatched(pen, off(from, along, 0, below), off(to, along, 0, below), inks);
}

/** Whether a direction has its lower side on the left. */
export function isBackwards([u, v]: Point): boolean {
  return u < -1e-6 || (Math.abs(u) <= 1e-6 && v > 0);
}

/** The ground below the box of a slide that goes along a direction. */
export function foot(pen: Pen, at: Point, along: Point, inks: Inks): void {
  const [u, v]: Point = isBackwards(along) ? [-along[0], -along[1]] : along;
  hatched(pen, off(at, [u, v], -BOX[0], BOX[1] + 1), off(at, [u, v], BOX[0], BOX[1] + 1), inks);
}

/** The box of a slide. */
export function box(pen: Pen, at: Point, along: Point, inks: Inks): void {
  const corner = (s: number, t: number) => off(at, along, s * BOX[0], t * BOX[1]);
  pen.path([corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)], true).fill(mixed(inks.paper, inks.faint, 0.3)).stroke(inks.ink, 1.6);
}

/** A slide that the areas of both of its bodies hide: the outline of its box, and the line of its way. */
export function hidden(pen: Pen, at: Point, along: Point, inks: Inks): void {
  const corner = (s: number, t: number) => off(at, along, s * BOX[0], t * BOX[1]);
  pen.path([corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)], true).stroke(inks.ink, 1.2);
  pen.path([corner(-2.2, 0), corner(2.2, 0)]).stroke(inks.ink, 1, CENTRE);
}

/** What a slot is cut into, where its body has no area of its own. */
export function slotFrame(pen: Pen, a: Point, b: Point, { fill, edge }: { fill: string; edge: string }): void {
  pen.path([a, b]).stroke(edge, 25).stroke(fill, 22);
}

/** A slot between two points, in the ground hatched. */
export function slot(pen: Pen, a: Point, b: Point, edge: string | null, inks: Inks): void {
  pen.path([a, b]).stroke(edge ?? inks.ink, 12).stroke(inks.paper, 8.5);
  if (edge) return;
  const [from, to] = isBackwards([b[0] - a[0], b[1] - a[1]]) ? [b, a] : [a, b];
  const { along } = toward(from, to);
  hatched(pen, off(from, along, 0, 9), off(to, along, 0, 9), inks);
}

/** The sign at the point of a joint. */
export function pin(pen: Pen, kind: string, at: Point, driven: boolean, inks: Inks): void {
  const edge = driven ? inks.accent : inks.ink;
  if (kind === 'fixed') pen.path([[at[0] - 5, at[1] - 5], [at[0] + 5, at[1] - 5], [at[0] + 5, at[1] + 5], [at[0] - 5, at[1] + 5]], true).fill(inks.ink);
  else if (kind === 'pin-in-slot') pen.circle(at, 4).fill(inks.ink);
  else if (kind === 'slider' || kind === 'prismatic') pen.circle(at, 2.4).fill(inks.ink);
  else pen.circle(at, 4.8).fill(inks.paper).stroke(edge, driven ? 2.4 : 1.8);
}

/** Joints that are no sign in the picture, and those whose second body slides. */
const UNSEEN = ['distance', 'free', 'point'];
const SLIDES = ['slider', 'prismatic', 'pin-in-slot'];
export const seen = ({ kind }: Joint): boolean => !UNSEEN.includes(kind);
export const slides = ({ kind }: Joint): boolean => SLIDES.includes(kind);
/** Radius of the arrow of what drives a hinge. */
export const DRIVE = 15;

/**
 * What drives a joint: an arrow above the box of a slide that goes along a direction, or about a hinge, whose plane is seen in two
 * directions across its axis; both ways if it has no sense.
 */
export function drive(pen: Pen, at: Point, slide: Point | null, across: [Point, Point], sense: number, inks: Inks): void {
  const color = driveInk(inks);
  const ahead = sense || 1;
  const [from, to] = ahead < 0 ? [2.6, -1.1] : [-1.1, 2.6];
  const about = (k: number): Point => {
    const [cos, sin] = [DRIVE * Math.cos(from + ((to - from) * k) / 30), DRIVE * Math.sin(from + ((to - from) * k) / 30)];
    return [at[0] + cos * across[0][0] + sin * across[1][0], at[1] + cos * across[0][1] + sin * across[1][1]];
  };
  const side = slide && slide[0] >= 0 ? -BOX[1] - 8 : BOX[1] + 8;
  const points = slide ? [-16, 16].map((reach) => off(at, slide, ahead * reach, side)) : Array.from({ length: 31 }, (_, k) => about(k));
  pen.path(points).stroke(color, 2);
  const head = (all: Point[]) => {
    const tip = all[all.length - 1]!;
    const behind = [...all].reverse().find((p) => Math.hypot(p[0] - tip[0], p[1] - tip[1]) > 5);
    if (!behind) return;
    const { along } = toward(behind, tip);
    const end = off(tip, along, 3, 0);
    pen.path([end, off(end, along, -8, 3.6), off(end, along, -8, -3.6)], true).fill(color);
  };
  head(points);
  if (sense === 0) head([...points].reverse());
}

/**
 * The stops of a slide along a direction, at the places where it meets them: bars across the way where the box ends, or what slides, so many
 * pixels back and ahead, and as high as that, at least `clear` pixels to either side.
 */
export function stops(pen: Pen, places: (Point | null)[], along: Point, reach: Point, clear: number, inks: Inks): void {
  const half = Math.max(BOX[1], clear);
  places.forEach((at, k) => {
    const beyond = (k === 0 ? -1 : 1) * (Math.max(BOX[0], reach[k]!) + 3);
    if (at) pen.path([off(at, along, beyond, -half), off(at, along, beyond, half)]).stroke(stopInk(inks), 3.2);
  });
}

/** A direction as it is seen, and that a quarter turn on. */
export type Turned = [Point, Point];

/** A direction in the plane by its angle. */
export function turnedBy(angle: number): Turned {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  return [[cos, -sin], [-sin, -cos]];
}

/** The stops of a hinge, in the directions in which it meets them: radial bars beside it, between which an arc is its range. */
export function ends(pen: Pen, at: Point, stops: (Turned | null)[], swing: number | null, inks: Inks): void {
  const from = stops[0];
  const along = (s: number, t: number, [u, v]: Turned): Point => [at[0] + s * u[0] + t * v[0], at[1] + s * u[1] + t * v[1]];
  if (from && swing !== null) {
    // of more than a turn a spiral
    const on = (turn: number): Point => {
      const radius = 28 * (swing > 2 * Math.PI ? 1 + (0.2 * turn) / (2 * Math.PI) : 1);
      return along(radius * Math.cos(turn), radius * Math.sin(turn), from);
    };
    pen.path(Array.from({ length: 97 }, (_, k) => on((swing * k) / 96))).stroke(stopInk(inks), 1.1);
  }
  stops.forEach((stop, k) => {
    const aside = k === 0 ? -10.5 : 10.5;
    if (stop) pen.path([along(10, aside, stop), along(28, aside, stop)]).stroke(stopInk(inks), 3.2);
  });
}

/**
 * The damping of a joint: a small dashpot behind the box of a slide that goes along a direction, beside a rod that goes through it, or behind
 * what slides, so many pixels back, or bent about a hinge, to its upper left, where its bearing is not.
 */
export function dashpot(pen: Pen, center: Point, slide: Point | null, back: number, grounded: boolean, inks: Inks): void {
  const color = inks.rust;
  // s from what moves to what holds it, t across
  const aside = (slide && slide[0] >= 0 ? -1 : 1) * (back > BOX[0] ? 4 : 10);
  const at = ([s, t]: Point): Point => {
    if (slide) return off(center, slide, -Math.max(BOX[0], back) - 24 * s, aside + 4 * t);
    const [angle, radius] = [3 - 1.8 * s, 19 + 5.5 * t];
    return [center[0] + radius * Math.cos(angle), center[1] - radius * Math.sin(angle)];
  };
  const run = (from: number, to: number, t: number) => Array.from({ length: 9 }, (_, k): Point => [from + ((to - from) * k) / 8, t]);
  const line = (places: Point[], width: number) => pen.path(places.map(at)).stroke(color, width);
  line(run(0, 0.55, 0), 1.7);
  line([[0.55, -0.65], [0.55, 0.65]], 2.4);
  line([...run(0.35, 0.8, -1), ...run(0.8, 0.35, 1)], 1.7);
  line(run(0.8, 1, 0), 1.7);
  line([[1, -0.9], [1, 0.9]], 1.7);
  line([[0, 0], [0, slide ? -Math.sign(aside) : -2.4]], 1.7);
  // the hatch of the ground
  if (slide && grounded) for (const t of [-0.9, -0.3, 0.3, 0.9]) line([[1, t], [1.2, t + 0.5]], 1);
}

/** The points of a coil between two points of the line from a along `along`. */
function coil(a: Point, along: Point, from: number, to: number, across: number): Point[] {
  const coils = Math.min(Math.max(Math.round((to - from) / 10), 4), 14);
  const step = (to - from) / (2 * coils);
  const zigzag = Array.from({ length: 2 * coils }, (_, k) => off(a, along, from + (k + 0.5) * step, across + (k % 2 === 0 ? 6 : -6)));
  return [off(a, along, from, across), ...zigzag, off(a, along, to, across)];
}

function damper(pen: Pen, a: Point, along: Point, from: number, to: number, across: number, color: string): void {
  const [low, high] = [from + 0.3 * (to - from), from + 0.7 * (to - from)];
  const p = (s: number, t: number) => off(a, along, s, across + t);
  pen.path([p(from, 0), p(low, 0)]).stroke(color, 1.8);
  pen.path([p(high, -6), p(low, -6), p(low, 6), p(high, 6)]).stroke(color, 1.8);
  pen.path([p((low + high) / 2, 0), p(to, 0)]).stroke(color, 1.8);
  pen.path([p((low + high) / 2, -4), p((low + high) / 2, 4)]).stroke(color, 2.6);
}

/** Tubes that slide in each other, which end at parts of what is between a and b, the last one a rod. */
function actuator(pen: Pen, a: Point, b: Point, mouths: number[], inks: Inks): void {
  const color = driveInk(inks);
  const { along, length } = toward(a, b);
  const [half, last] = [Math.min(7, 0.2 * length), mouths.length - 1];
  const foot = Math.min(0.08 * mouths[0]! * length, 7);
  const at = (s: number, t: number) => off(a, along, s, t * half);
  pen.path([a, at(foot, 0)]).stroke(color, 3.2);
  pen.path([at(mouths[last - 1]! * length, 0), b]).stroke(color, 3.2);
  for (let k = last - 1; k >= 0; k--) {
    const [from, to, wide] = [k === 0 ? foot : mouths[k - 1]! * length, mouths[k]! * length, 1 - (0.8 * k) / last];
    pen.path([at(from, -wide), at(to, -wide), at(to, wide), at(from, wide)], true).fill(mixed(inks.paper, color, 0.15)).stroke(color, 1.6);
  }
  [a, b].forEach((point) => pen.circle(point, 2.6).fill(color));
}

/** A spring, a damper or both between two points, or an actuator with the ends of its tubes. Springs about a hinge are spirals. */
export function link(pen: Pen, kind: LinkKind, a: Point, b: Point, mouths: number[], inks: Inks): void {
  if (kind === 'actuator') return actuator(pen, a, b, mouths, inks);
  const color = inks.rust;
  const { along, length } = toward(a, b);
  const end = Math.min(0.2 * length, 16);
  [a, b].forEach((point) => pen.circle(point, 2.6).fill(color));
  if (kind === 'spring') pen.path([a, ...coil(a, along, end, length - end, 0), b]).stroke(color, 1.7);
  if (kind === 'damper') damper(pen, a, along, 0, length, 0, color);
  if (kind === 'spring-damper') {
    for (const s of [end, length - end]) pen.path([off(a, along, s, -9), off(a, along, s, 9)]).stroke(color, 1.8);
    pen.path([a, off(a, along, end, 0)]).stroke(color, 1.8);
    pen.path([b, off(a, along, length - end, 0)]).stroke(color, 1.8);
    pen.path(coil(a, along, end, length - end, -9)).stroke(color, 1.6);
    damper(pen, a, along, end, length - end, 9, color);
  }
}

/** Whether a link acts on turning alone, or holds a joint. */
export function turns(kind: LinkKind): boolean {
  return kind === 'torsion' || kind === 'shaft' || kind === 'clutch' || kind === 'brake';
}

/** A spring about a hinge or between two, a clutch, or a brake, between bodies that stand at two angles. */
export function turning(pen: Pen, kind: LinkKind, [a, b]: [Point, Point], [first, second]: Point, inks: Inks): void {
  const { along, length } = toward(a, b);
  if (kind === 'torsion') spiral(pen, a, first, second, inks);
  if (kind === 'shaft') spiral(pen, shaft(pen, a, b, 16, inks), first, second, inks);
  if (kind === 'clutch') {
    if (length < 26) {
      shoes(pen, a, first, 15, inks);
      shoes(pen, a, second, 10.5, inks);
      return;
    }
    const middle = shaft(pen, a, b, 3, inks);
    for (const side of [-2.7, 2.7]) pen.path([off(middle, along, side, -9), off(middle, along, side, 9)]).stroke(inks.rust, 2.8);
  }
  if (kind === 'brake' && length < 1) {
    shoes(pen, a, first, 13, inks);
    for (const way of [[Math.cos(first), -Math.sin(first)], [-Math.cos(first), Math.sin(first)]] as Point[]) pen.path([off(a, way, 13, 0), off(a, way, 20, 0)]).stroke(inks.rust, 1.7);
  } else if (kind === 'brake') {
    const up = along[0] < 0 ? 1 : -1;
    const at = (s: number, t: number) => off(b, along, s, up * (BOX[1] + t));
    pen.path([at(-0.7 * BOX[0], 3), at(0.7 * BOX[0], 3)]).stroke(inks.rust, 3.4);
    pen.path([at(0, 3), at(0, 11)]).stroke(inks.rust, 1.7);
  }
}

/** A line between two hinges with a gap in its middle, which it gives. */
function shaft(pen: Pen, a: Point, b: Point, half: number, inks: Inks): Point {
  const { along, length } = toward(a, b);
  [a, b].forEach((end) => pen.circle(end, 2.6).fill(inks.rust));
  if (0.5 * length > half) {
    pen.path([a, off(a, along, 0.5 * length - half, 0)]).stroke(inks.rust, 1.3, CENTRE);
    pen.path([b, off(a, along, 0.5 * length + half, 0)]).stroke(inks.rust, 1.3, CENTRE);
  }
  return off(a, along, 0.5 * length, 0);
}

/** Thick arcs on both sides of a hinge. */
function shoes(pen: Pen, at: Point, angle: number, radius: number, inks: Inks): void {
  for (const side of [angle, angle + Math.PI]) {
    const arc = Array.from({ length: 15 }, (_, k): Point => [at[0] + radius * Math.cos(side + 0.1 * (k - 7)), at[1] - radius * Math.sin(side + 0.1 * (k - 7))]);
    pen.path(arc).stroke(inks.rust, 3);
  }
}

/** A spring about a hinge: from the first body outside to the second one inside, wound by the angle between them. */
function spiral(pen: Pen, at: Point, a: number, b: number, inks: Inks): void {
  const [inner, outer, turn] = [7, 16, 2 * Math.PI];
  const to = b + 2 * turn - turn * Math.floor((b - a) / turn);
  const points = Array.from({ length: 61 }, (_, k): Point => {
    const [angle, radius] = [a + (k / 60) * (to - a), outer + (k / 60) * (inner - outer)];
    return [at[0] + radius * Math.cos(angle), at[1] - radius * Math.sin(angle)];
  });
  pen.path(points).stroke(inks.rust, 1.6);
}

/** A wheel: its teeth along an outline, if there are any, its pitch circle, and a line that shows how it turns; of a ring also its rim. */
export function gear(pen: Pen, center: Point, radius: number, outline: Point[], turned: Point, rim: number | null, fill: string, color: string): void {
  if (rim !== null && outline.length > 0) {
    // the ring between its rim and its teeth, in one line with a seam
    const round = Array.from({ length: 97 }, (_, k): Point => [center[0] + rim * Math.cos((k * Math.PI) / 48), center[1] - rim * Math.sin((k * Math.PI) / 48)]);
    pen.path([...round, ...[...outline, outline[0]!].reverse()], true).fill(fill);
  }
  const wheel = outline.length > 0 ? pen.path(outline, true) : pen.circle(center, radius);
  if (rim === null) wheel.fill(fill);
  if (outline.length > 0 || rim === null) wheel.stroke(color, 1.2);
  pen.circle(center, radius).stroke(color, 0.8, PITCH);
  if (rim !== null) pen.circle(center, rim).stroke(color, 1.8);
  else pen.path([center, off(center, turned, 0.8 * radius, 0)]).stroke(color, 1);
}

/** The pitch circle of a wheel without teeth; of a ring also its rim. */
export function pitch(pen: Pen, center: Point, radius: number, inner: boolean, inks: Inks): void {
  pen.circle(center, radius).stroke(inks.soft, 0.8, PITCH);
  if (inner) pen.circle(center, RIM * radius).stroke(inks.soft, 1.8);
}

/** The pitch line of a rack without teeth. */
export function pitchLine(pen: Pen, a: Point, b: Point, inks: Inks): void {
  pen.path([a, b]).stroke(inks.soft, 0.8, PITCH);
}

/** A belt around two wheels: their outer tangents, and the arcs between these. */
export function belt(pen: Pen, a: Point, ra: number, b: Point, rb: number, inks: Inks): void {
  const toward = Math.atan2(b[1] - a[1], b[0] - a[0]);
  const lean = Math.acos(Math.min(Math.max((ra - rb) / (Math.hypot(b[0] - a[0], b[1] - a[1]) || 1), -1), 1));
  const arc = ([x, y]: Point, radius: number, from: number, to: number) => Array.from({ length: 33 }, (_, k): Point => {
    const angle = toward + from + ((to - from) * k) / 32;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
  });
  pen.path([...arc(a, ra, lean, 2 * Math.PI - lean), ...arc(b, rb, -lean, lean)], true).stroke(inks.soft, 2.6);
}

/**
 * A rope: around its drum, and from there along the tangent to its end. Of the two points where that touches the drum it is the one on the
 * side that goes along `goes` when the drum turns counter-clockwise.
 */
export function rope(pen: Pen, center: Point, radius: number, end: Point, goes: Point, inks: Inks): void {
  const { along, length } = toward(center, end);
  // upwards is negative in pixels: the side is a quarter turn clockwise from the way
  const side: Point = [-goes[1], goes[0]];
  const lean = Math.acos(Math.min(radius / (length || 1), 1));
  const touches = [lean, -lean].map((angle) => off(center, along, radius * Math.cos(angle), radius * Math.sin(angle)));
  const facing = (at: Point) => (at[0] - center[0]) * side[0] + (at[1] - center[1]) * side[1];
  const from = length <= radius ? off(center, side, radius, 0) : touches.reduce((a, b) => (facing(a) >= facing(b) ? a : b));
  pen.circle(center, radius).stroke(inks.soft, 2.4);
  pen.path([from, end]).stroke(inks.soft, 2.4);
}
