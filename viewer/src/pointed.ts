// What a reader points at in a drawing.

import type { Motion, Vector } from './motion';
import { away, corners, extent, outline, part } from './outlines';
import { type Point, hull } from './plane/pen';
import { turns } from './plane/signs';
import { stagesOf } from './telescope';

/** How near it must be, pixels: a pin, the line of a bar or spring, a path. */
const PIN = 9;
const LINE = 8;
const PATH = 5;
/** A path as near as this is told with the body that it crosses, pixels. */
const ON = 3;

/** A path as it is seen. */
export interface SeenPath { name: string; points: Point[] }

/** Of space: the body that is nearest to the eye at a point, and whether it hides a place of other bodies than its own. */
export interface Front { body: number; hides(at: Vector, own: number[]): boolean }

/**
 * In words the joints at a point of the picture, else the spring or damper there, else the body that is in front, else that which is near, bars first, then what is small,
 * with a path that runs right there, else the path.
 */
export function pointed(motion: Motion, place: number, pixel: (at: Vector) => Point, paths: SeenPath[], at: Point, front: Front | null = null): string | null {
  const { joints, links, bodies } = motion.scene;
  const { within } = stagesOf(motion.scene);
  const far = (p: Point) => Math.hypot(p[0] - at[0], p[1] - at[1]);
  const seen = (body: number, own: number[]) => pixel(motion.world({ body, at: own }, place));
  const hidden = (spot: Vector, own: number[]) => front?.hides(spot, own) ?? false;
  const pins = joints.filter(({ kind, a, b }) => kind !== 'distance' && kind !== 'free' && far(seen(b.body, b.at)) < PIN && !hidden(motion.world(b, place), [a.body, b.body]));
  if (pins.length > 0) return pins.map(({ name, kind, a, b }) => `${name}: ${kind}, ${bodies[a.body]!.name} and ${bodies[b.body]!.name}`).join('\n');
  const line = links.find((link) => {
    const places = motion.ends(link, place).slice(0, turns(link.kind) ? 1 : 2);
    const ends = places.map((end) => pixel(end));
    return link.name !== '' && away(at, ends, false) < (turns(link.kind) ? 2 * LINE : LINE) && !hidden(nearest(places, ends, at), [link.a.body, link.b.body]);
  });
  if (line) return `${line.name}: ${line.kind}`;
  const path = paths.map(({ name, points }) => ({ name, off: away(at, points, false) })).reduce((a, b) => (b.off < a.off ? b : a), { name: '', off: PATH });
  const told = path.name === '' ? null : `path of ${path.name}`;
  const withPath = (name: string) => (told && path.off < ON ? `${name}\n${told}` : name);
  if (front && front.body > 0) return withPath(bodies[front.body]!.name);
  const found = bodies.flatMap(({ name, shapes }, body) => (body === 0 ? [] : shapes.flatMap((shape) => {
    const solid = motion.scene.dimensions === 3 ? corners(shape) : [];
    const { line: own, closed } = solid.length > 0 ? { line: solid, closed: true } : outline(shape);
    const points = own.map((p) => seen(body, p));
    const edge = solid.length > 0 ? hull(points) : points;
    return edge.length === 0 || away(at, edge, closed) > LINE ? [] : [{ name, size: closed ? extent(edge) : 0, above: within[body]! }];
  })));
  // of alike ones that which is drawn in front: the last one, and a cylinder before its rod
  if (found.length > 0) return withPath(found.reduce((a, b) => (b.size < a.size || (b.size === a.size && b.above >= a.above) ? b : a)).name);
  return told;
}

/** The place on a line between two places, or the one place, that is seen nearest to a point. */
function nearest([from, to = from]: Vector[], [p, q = p]: Point[], at: Point): Vector {
  const s = part(at, p!, q!);
  return from!.map((x, i) => x + s * (to![i]! - x)) as Vector;
}
