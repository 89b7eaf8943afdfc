// Gears, racks, belts and ropes in space, as lines.

import { type Motion, type Vector, cross } from '../motion';
import type { Gear, Wheel } from '../types';
import { across, add, dot, unit } from './vectors';

/** Corners of a circle, and of the arc of a belt on its wheel. */
const CORNERS = 48;
const ARC = 24;

/** A line in world axes; pitch lines are thin. */
export interface Line { points: Vector[]; thin: boolean }

/** A circle about an axis. */
interface Drum { center: Vector; axis: Vector; radius: number }

function drum(motion: Motion, { body, at, radius, axis }: Wheel, place: number): Drum {
  return { center: motion.world({ body, at }, place), axis: unit(motion.direction(body, axis?.length === 3 ? axis : [0, 0, 1], place)), radius: Math.abs(radius) };
}

/** The place of a circle's plane at two coordinates, and at a height along its axis. */
function at({ center, axis }: Drum, x: number, y: number, height = 0): Vector {
  const [u, v] = across(axis);
  return add(add(add(center, u, x), v, y), axis, height);
}

function circle(wheel: Drum): Vector[] {
  return Array.from({ length: CORNERS + 1 }, (_, k) => {
    const turn = (2 * Math.PI * k) / CORNERS;
    return at(wheel, wheel.radius * Math.cos(turn), wheel.radius * Math.sin(turn));
  });
}

/** Coordinates of a place in the plane of a circle, and its height over it. */
function own({ center, axis }: Drum, place: Vector): Vector {
  const [u, v] = across(axis);
  const from = add(place, center, -1);
  return [dot(from, u), dot(from, v), dot(from, axis)];
}

/** A belt around two wheels: their outer tangents, and the arcs between these. */
function belt(a: Drum, b: Drum): Vector[] {
  const [x, y, height] = own(a, b.center);
  const toward = Math.atan2(y, x);
  const lean = Math.acos(Math.min(Math.max((a.radius - b.radius) / (Math.hypot(x, y) || 1), -1), 1));
  const arc = (cx: number, cy: number, h: number, radius: number, from: number, to: number) => Array.from({ length: ARC + 1 }, (_, k) => {
    const angle = toward + from + ((to - from) * k) / ARC;
    return at(a, cx + radius * Math.cos(angle), cy + radius * Math.sin(angle), h);
  });
  const points = [...arc(0, 0, 0, a.radius, lean, 2 * Math.PI - lean), ...arc(x, y, height, b.radius, -lean, lean)];
  return [...points, points[0]!];
}

/** Where a rope to an end leaves its drum, on the side that goes along `goes` when the drum turns counter-clockwise. */
function leaving(wheel: Drum, end: Vector, goes: Vector): Vector {
  const [x, y] = own(wheel, end);
  const [sx, sy] = own(wheel, add(wheel.center, cross(goes, wheel.axis)));
  const distance = Math.hypot(x, y);
  if (distance <= wheel.radius) return at(wheel, wheel.radius * sx, wheel.radius * sy);
  const [toward, lean] = [Math.atan2(y, x), Math.acos(wheel.radius / distance)];
  const facing = (angle: number) => Math.cos(angle) * sx + Math.sin(angle) * sy;
  const angle = facing(toward - lean) >= facing(toward + lean) ? toward - lean : toward + lean;
  return at(wheel, wheel.radius * Math.cos(angle), wheel.radius * Math.sin(angle));
}

/** The pitch line of a rack, with teeth towards its pinion. */
function rack(pinion: Drum, from: Vector, along: Vector): Vector[] {
  const middle = add(from, along, dot(along, add(pinion.center, from, -1)));
  const out = unit(add(pinion.center, middle, -1));
  const [reach, depth, steps] = [2 * pinion.radius, 0.07 * pinion.radius, 48];
  return Array.from({ length: steps + 1 }, (_, k) => add(add(middle, along, reach * ((2 * k) / steps - 1)), out, k % 4 < 2 ? depth : -depth));
}

/** The lines of a pair of gears, a rack, a belt or a rope. */
export function lines({ kind, a, b }: Gear, motion: Motion, place: number): Line[] {
  const [first, second] = [drum(motion, a, place), drum(motion, b, place)];
  const along = () => unit(motion.direction(b.body, b.axis ?? [1, 0, 0], place));
  const pitch = (wheel: Drum): Line => ({ points: circle(wheel), thin: true });
  switch (kind) {
    case 'teeth': return [pitch(first), pitch(second)];
    case 'rack': return [pitch(first), { points: rack(first, second.center, along()), thin: false }];
    case 'belt': return [{ points: belt(first, second), thin: false }];
    case 'rope': return [{ points: circle(first), thin: false }, { points: [leaving(first, second.center, along()), second.center], thin: false }];
  }
}
