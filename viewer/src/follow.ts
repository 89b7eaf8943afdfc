// A body that stays where it is in a drawing while all else moves past it.

import type { Motion, Vector } from './motion';
import type { Place } from './types';

/** Places of the motion that are looked at, bodies that may be followed at first, and of all points about so many. */
const LOOKS = 12;
const BODIES = 40;
const POINTS = 400;
/** How many times larger all of the motion must be than what is seen around a body, so that this is followed at first. */
const FAR = 3;
/** What is seen around a body is at least this part of the whole motion: a point alone shows nothing. */
export const LEAST = 0.02;

/** Where the drawing goes with a body: how far that is from the origin. */
export class Followed {
  private body = 0;
  private readonly places: Place[];

  constructor(private readonly motion: Motion) {
    this.places = [...motion.places()];
  }

  /** Follows a body by its name, or none; whether that changes anything. */
  take(name: string | null): boolean {
    const before = this.body;
    this.body = name === null ? 0 : Math.max(0, this.motion.scene.bodies.findIndex((body) => body.name === name));
    return before !== this.body;
  }

  /** What is in the middle of the drawing at a place of the motion. */
  base(place: number): Vector {
    return this.motion.world({ body: this.body, at: [] }, place);
  }

  /** Points of a picture as they are seen at a place of the motion; of the ground none if that moves past. */
  *seen(place: number): Iterable<Vector> {
    const [x, y, z] = this.base(place);
    const kept = this.body === 0 ? this.places : this.places.filter(({ body }) => body !== 0);
    for (const point of kept) {
      const at = this.motion.world(point, place);
      yield [at[0] - x, at[1] - y, at[2] - z];
    }
  }
}

/** The body to follow at first: none, unless all travel so far together that they would be small in a picture of the whole motion, and nothing reaches from them to the ground. */
export function leading(motion: Motion): string | null {
  const { bodies, links, gears } = motion.scene;
  if ([...links.filter(({ kind }) => kind === 'actuator' || kind === 'rod'), ...gears].some(({ a, b }) => (a.body === 0) !== (b.body === 0))) return null;
  const moving = [...motion.places()].filter(({ body }) => body !== 0);
  const points = moving.filter((_, i) => i % Math.ceil(moving.length / POINTS) === 0);
  const places = motion.sampled(LOOKS);
  const size = (all: Vector[]) => Math.hypot(...[0, 1, 2].map((i) => Math.max(...all.map((p) => p[i]!)) - Math.min(...all.map((p) => p[i]!))));
  const around = (body: number) => size(places.flatMap((place) => {
    const [x, y, z] = motion.world({ body, at: [] }, place);
    return points.map((point) => motion.world(point, place)).map((p): Vector => [p[0] - x, p[1] - y, p[2] - z]);
  }));
  if (points.length === 0) return null;
  const whole = around(0);
  if (!(whole > FAR * Math.max(...places.map((place) => size(points.map((point) => motion.world(point, place))))))) return null;
  const found = bodies.slice(1, BODIES + 1).map(({ name }, k) => ({ name, size: around(k + 1) })).reduce((a, b) => (b.size < a.size ? b : a));
  return whole > FAR * found.size && found.size > LEAST * whole ? found.name : null;
}
