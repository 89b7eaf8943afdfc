// What a reader points at in a drawing.

import type { Motion, Vector } from './motion';
import { away, corners, extent, outline } from './outlines';
import { type Point, hull } from './plane/pen';
import { turns } from './plane/signs';
import { stagesOf } from './telescope';

/** How near it must be, pixels: a pin, the line of a bar or spring, a path. */
const PIN = 9;
const LINE = 8;
const PATH = 5;

/** A path as it is seen. */
export interface SeenPath { name: string; points: Point[] }

/** In words the joints at a point of the picture, else the spring or damper there, else the body, bars first, then what is small, else the path. */
export function pointed(motion: Motion, place: number, pixel: (at: Vector) => Point, paths: SeenPath[], at: Point): string | null {
  const { joints, links, bodies } = motion.scene;
  const { within } = stagesOf(motion.scene);
  const far = (p: Point) => Math.hypot(p[0] - at[0], p[1] - at[1]);
  const seen = (body: number, own: number[]) => pixel(motion.world({ body, at: own }, place));
  const pins = joints.filter(({ kind, b }) => kind !== 'distance' && kind !== 'free' && far(seen(b.body, b.at)) < PIN);
  if (pins.length > 0) return pins.map(({ name, kind, a, b }) => `${name}: ${kind}, ${bodies[a.body]!.name} and ${bodies[b.body]!.name}`).join('\n');
  const line = links.find((link) => {
    const ends = motion.ends(link, place).map((end) => pixel(end));
    return link.name !== '' && away(at, turns(link.kind) ? ends.slice(0, 1) : ends, false) < (turns(link.kind) ? 2 * LINE : LINE);
  });
  if (line) return `${line.name}: ${line.kind}`;
  const found = bodies.flatMap(({ name, shapes }, body) => (body === 0 ? [] : shapes.flatMap((shape) => {
    const solid = motion.scene.dimensions === 3 ? corners(shape) : [];
    const { line: own, closed } = solid.length > 0 ? { line: solid, closed: true } : outline(shape);
    const points = own.map((p) => seen(body, p));
    const edge = solid.length > 0 ? hull(points) : points;
    return edge.length === 0 || away(at, edge, closed) > LINE ? [] : [{ name, size: closed ? extent(edge) : 0, above: within[body]! }];
  })));
  // of alike ones that which is drawn in front: the last one, and a cylinder before its rod
  if (found.length > 0) return found.reduce((a, b) => (b.size < a.size || (b.size === a.size && b.above >= a.above) ? b : a)).name;
  const path = paths.find(({ points }) => away(at, points, false) < PATH);
  return path ? `path of ${path.name}` : null;
}
