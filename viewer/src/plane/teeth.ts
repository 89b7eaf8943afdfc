// Teeth of wheels that mesh, in the plane. A model gives pitch circles alone; the drawing has the smallest numbers of teeth in the ratio of
// the radii, of one module in each train, with which all of its pairs mesh. Flanks are involutes of 20°.
//
// At the point of contact of two pitch circles a tooth of one meets a gap of the other. With u the number of teeth from a wheel's own first
// one to that point, counted along its turn, that is u_a + u_b = 1/2 plus a whole number; within a ring, where both turn alike,
// u_a − u_b = 1/2. As wheels roll on each other these sums stay as they are.

import type { Motion } from '../motion';
import type { Gear, Wheel } from '../types';
import type { Point } from './pen';

/** Least number of teeth that are not undercut by a rack at 20°, and the most that are drawn. */
const LEAST = 17;
const MOST = 400;
/** How far numbers of teeth may be from whole ones, and pairs from meshing, parts of a pitch. */
const WHOLE = 1e-6;
const MESHES = 1e-2;
/** Pressure angle; height above and below the pitch circle, modules; points of a flank. */
const PRESSURE = Math.PI / 9;
const TIP = 1;
const ROOT = 1.25;
const FLANK = 5;

/** A wheel with its number of teeth, and the direction of the first one in the body, rad; without a number it has its pitch circle alone. */
export interface Toothed { wheel: Wheel; teeth: number; phase: number; outline: Point[] }
/** A rack of a pinion: its pitch line from one end to the other through the point of contact, with teeth if the pinion has any. */
export interface Rack { gear: Gear; pinion: Toothed; first: number }

type Turn = (wheel: Wheel) => { at: Point; angle: number };

const involute = (angle: number) => Math.tan(angle) - angle;

/** Half of the angle that a tooth takes at some radius; below the base circle as on it. */
function half(teeth: number, pitch: number, radius: number): number {
  const base = pitch * Math.cos(PRESSURE);
  return Math.max(Math.PI / (2 * teeth) + involute(PRESSURE) - involute(Math.acos(Math.min(base / radius, 1))), 0);
}

/** The outline of a wheel in its body; a ring is around the outline of a wheel whose teeth are its gaps. */
function outline({ at, radius }: Wheel, teeth: number, phase: number): Point[] {
  const [pitch, inner] = [Math.abs(radius), radius < 0];
  const module = (2 * pitch) / teeth;
  const [low, high] = [pitch - (inner ? TIP : ROOT) * module, pitch + (inner ? ROOT : TIP) * module];
  const flank = Array.from({ length: FLANK }, (_, k) => low + ((high - low) * k) / (FLANK - 1)).map((r): Point => [r, half(teeth, pitch, r)]);
  return Array.from({ length: teeth }, (_, k) => phase + (2 * Math.PI * (k + (inner ? 0.5 : 0))) / teeth).flatMap((middle) =>
    [...flank.map(([r, wide]): Point => [r, middle - wide]), ...[...flank].reverse().map(([r, wide]): Point => [r, middle + wide])].map(([r, angle]): Point => [(at[0] ?? 0) + r * Math.cos(angle), (at[1] ?? 0) + r * Math.sin(angle)]));
}

const same = (a: Wheel, b: Wheel) => {
  const near = 1e-6 * Math.abs(a.radius);
  return a.body === b.body && Math.abs(a.radius - b.radius) < near && a.at.every((x, i) => Math.abs(x - (b.at[i] ?? 0)) < near);
};

/** Smallest whole numbers in the ratio of radii; none if they are too large. */
export function ratio(radii: number[]): number[] | null {
  const least = Math.min(...radii);
  for (let n = 1; n * (Math.max(...radii) / least) <= MOST; n++) {
    const numbers = radii.map((radius) => (n * radius) / least);
    if (numbers.every((x) => Math.abs(x - Math.round(x)) < WHOLE)) return numbers.map(Math.round);
  }
  return null;
}

/** Teeth between the first one of a wheel and a direction. */
const count = (teeth: number, turned: number, direction: number) => (teeth * (direction - turned)) / (2 * Math.PI);

/** The direction of contact from the centre of each of two wheels, if their pitch circles touch, and whether both turn alike. */
function contact(a: Wheel, b: Wheel, turn: Turn): { from: [number, number]; alike: boolean } | null {
  const [p, q] = [turn(a).at, turn(b).at];
  const [dx, dy] = [q[0] - p[0], q[1] - p[1]];
  const apart = Math.abs(a.radius + b.radius);
  if (Math.abs(Math.hypot(dx, dy) - apart) > 1e-5 * Math.abs(a.radius)) return null;
  const toward = Math.atan2(dy, dx);
  if (b.radius < 0) return { from: [toward + Math.PI, toward + Math.PI], alike: true };
  return { from: [toward, a.radius < 0 ? toward : toward + Math.PI], alike: a.radius < 0 };
}

/** The directions of first teeth with which all pairs of a train mesh; none if there are no such. */
function phases(wheels: Wheel[], pairs: [number, number][], teeth: number[], turn: Turn): number[] | null {
  const found: (number | undefined)[] = wheels.map((_, k) => (k === 0 ? 0 : undefined));
  const open = [0];
  for (let from = open.shift(); from !== undefined; from = open.shift()) {
    for (const pair of pairs) {
      if (!pair.includes(from)) continue;
      const to = pair[0] === from ? pair[1] : pair[0];
      const meets = contact(wheels[from]!, wheels[to]!, turn);
      if (!meets) return null;
      const here = count(teeth[from]!, turn(wheels[from]!).angle + found[from]!, meets.from[0]);
      const wanted = meets.alike ? here - 0.5 : 0.5 - here;
      const free = count(teeth[to]!, turn(wheels[to]!).angle, meets.from[1]);
      if (found[to] === undefined) {
        found[to] = ((free - wanted) * 2 * Math.PI) / teeth[to]!;
        open.push(to);
      } else {
        const off = free - (found[to]! * teeth[to]!) / (2 * Math.PI) - wanted;
        if (Math.abs(off - Math.round(off)) > MESHES) return null;
      }
    }
  }
  return found.map((phase) => phase ?? 0);
}

/** Wheels that mesh with each other, directly or through others. */
function trains(wheels: Wheel[], pairs: [number, number][]): number[][] {
  const of = wheels.map((_, k) => k);
  for (const [a, b] of pairs) {
    const [from, to] = [of[b]!, of[a]!];
    of.forEach((train, k) => train === from && (of[k] = to));
  }
  return [...new Set(of)].map((train) => of.flatMap((one, k) => (one === train ? [k] : [])));
}

/** Teeth of a train. */
function train(wheels: Wheel[], pairs: [number, number][], turn: Turn): Toothed[] {
  const numbers = ratio(wheels.map(({ radius }) => Math.abs(radius)));
  if (numbers) {
    for (let k = Math.ceil(LEAST / Math.min(...numbers)); k * Math.max(...numbers) <= MOST; k++) {
      const teeth = numbers.map((n) => k * n);
      const found = phases(wheels, pairs, teeth, turn);
      if (found) return wheels.map((wheel, i) => ({ wheel, teeth: teeth[i]!, phase: found[i]!, outline: outline(wheel, teeth[i]!, found[i]!) }));
    }
  }
  return wheels.map((wheel) => ({ wheel, teeth: 0, phase: 0, outline: [] }));
}

/** All wheels with teeth of a mechanism, from the outside to the inside of what lies over each other, and its racks. */
export function toothed(motion: Motion): { wheels: Toothed[]; racks: Rack[] } {
  const wheels: Wheel[] = [];
  const number = (wheel: Wheel): number => {
    const known = wheels.findIndex((one) => same(one, wheel));
    return known >= 0 ? known : wheels.push(wheel) - 1;
  };
  const gears = motion.scene.gears.filter(({ kind }) => kind === 'teeth' || kind === 'rack');
  const pairs = gears.flatMap(({ kind, a, b }): [number, number][] => (kind === 'teeth' ? [[number(a), number(b)]] : (number(a), [])));
  const turn: Turn = ({ body, at }) => ({ at: motion.world({ body, at }, motion.from).slice(0, 2) as Point, angle: motion.angle(body, motion.from) });
  const all = trains(wheels, pairs).flatMap((own) => train(own.map((k) => wheels[k]!), pairs.filter(([a]) => own.includes(a)).map(([a, b]) => [own.indexOf(a), own.indexOf(b)]), turn));
  const racks = gears.filter(({ kind }) => kind === 'rack').map((gear) => {
    const pinion = all.find(({ wheel }) => same(wheel, gear.a))!;
    return { gear, pinion, first: beginning(gear, pinion, motion) };
  });
  return { wheels: all.sort((a, b) => Number(b.wheel.radius < 0) - Number(a.wheel.radius < 0) || b.wheel.radius - a.wheel.radius), racks };
}

/** Where a rack is touched: along it from its own point, and the direction there from the centre of its pinion. */
export function touched({ a, b }: Gear, motion: Motion, place: number): { from: Point; along: Point; at: number; direction: number; apart: number } {
  const [center, from] = [a, b].map((wheel) => motion.world(wheel, place).slice(0, 2) as Point) as [Point, Point];
  const [x, y] = motion.direction(b.body, b.axis?.length ? b.axis : [1, 0], place);
  const at = (center[0] - from[0]) * x + (center[1] - from[1]) * y;
  const [dx, dy] = [from[0] + at * x - center[0], from[1] + at * y - center[1]];
  return { from, along: [x, y], at, direction: Math.atan2(dy, dx), apart: Math.hypot(dx, dy) };
}

/** Where along a rack one of its teeth is. */
function beginning(gear: Gear, { wheel, teeth, phase }: Toothed, motion: Motion): number {
  const { along, at, direction } = touched(gear, motion, motion.from);
  const sense = Math.sign(along[1] * Math.cos(direction) - along[0] * Math.sin(direction));
  const own = sense * (count(teeth, motion.angle(wheel.body, motion.from) + phase, direction) - 0.5);
  return at - (own * 2 * Math.PI * wheel.radius) / (teeth || 1);
}

/** The toothed line of a rack in the world, as long as twice the pinion; without teeth its pitch line. */
export function rackLine({ gear, pinion: { wheel, teeth }, first }: Rack, motion: Motion, place: number): Point[] {
  const { from, along, at, direction } = touched(gear, motion, place);
  const reach = 2 * wheel.radius;
  const point = (s: number, height: number): Point => [from[0] + s * along[0] - height * Math.cos(direction), from[1] + s * along[1] - height * Math.sin(direction)];
  if (teeth === 0) return [point(at - reach, 0), point(at + reach, 0)];
  const [pitch, module] = [(2 * Math.PI * wheel.radius) / teeth, (2 * wheel.radius) / teeth];
  const wide = (height: number) => pitch / 4 - height * Math.tan(PRESSURE);
  const out: Point[] = [];
  for (let k = Math.ceil((at - reach - first) / pitch); first + k * pitch <= at + reach; k++) {
    const middle = first + k * pitch;
    const [low, high] = [-ROOT * module, TIP * module];
    out.push(point(middle - wide(low), low), point(middle - wide(high), high), point(middle + wide(high), high), point(middle + wide(low), low));
  }
  return out;
}
