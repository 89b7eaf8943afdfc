// What is nearest to the eye at a point of a picture in space.

import type { Vector } from '../motion';
import { away } from '../outlines';
import type { Point } from '../plane/pen';
import type { Front } from '../pointed';
import { type Face, dot } from './vectors';

/** From where faces are seen: directions of the picture and to the eye, pixels of a metre, and where points and depths are. */
export interface Sight {
  right: Vector;
  above: Vector;
  toEye: Vector;
  scale: number;
  pixel(at: Vector): Point;
  depth(at: Vector): number;
}

/** How bodies stand. */
interface Stand {
  direction(body: number, along: Vector): Vector;
  world(body: number, at: Vector): Vector;
}

/** The body whose face is nearest to the eye at a point, with all that lies deeper by more than `margin` (m) hidden; one that is seen through counts where nothing else is. */
export function front(all: Face[][], stand: Stand, sight: Sight, at: Point, margin: number): Front | null {
  let nearest: { body: number; depth: number; clear: boolean } | null = null;
  for (const [body, faces] of all.entries()) {
    for (const { points, normal, clear = false } of faces) {
      const out = stand.direction(body, normal);
      const towards = dot(out, sight.toEye);
      if (towards <= 0) continue;
      const world = points.map((point) => stand.world(body, point));
      const seen = world.map((point) => sight.pixel(point));
      if (away(at, seen, true) > 0) continue;
      // on the plane of the face
      const [x, y] = [(at[0] - seen[0]![0]) / sight.scale, (seen[0]![1] - at[1]) / sight.scale];
      const depth = sight.depth(world[0]!) - (dot(out, sight.right) * x + dot(out, sight.above) * y) / towards;
      if (!nearest || (nearest.clear === clear ? depth > nearest.depth : nearest.clear)) nearest = { body, depth, clear };
    }
  }
  const found = nearest;
  return found && { body: found.body, hides: (point, own) => !found.clear && !own.includes(found.body) && sight.depth(point) < found.depth - margin };
}
