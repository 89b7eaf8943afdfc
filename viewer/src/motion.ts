// The motion of a scene: poses of all bodies at any place, and where their points are.

import { above, weights } from './lagrange';
import type { Link, Place, Scene } from './types';

export type Vector = [number, number, number];

/** Whether a variable falls from the last frame to the first. */
export function falling(values: (number | null)[], at: ArrayLike<number>): boolean {
  const [from, to] = [at[0] ?? 0, at[at.length - 1] ?? 0];
  const known = values.filter((x): x is number => x !== null);
  const near = (x: number | undefined, end: number) => x !== undefined && Math.abs(x - end) <= 1e-6 * (to - from);
  return to > from && near(known[0], to) && near(known[known.length - 1], from);
}

export class Motion {
  readonly stride: number;
  readonly width: number;
  readonly from: number;
  readonly to: number;
  /** Places that are drawn palely behind the present one: of what rests the start, or other equilibria. */
  behind: number[] = [];
  private poses: Float64Array;
  private posed = NaN;

  /** `falls` says that the independent variable falls on the way. */
  constructor(readonly scene: Scene, readonly falls = false) {
    this.stride = scene.dimensions === 2 ? 3 : 7;
    this.width = (scene.bodies.length - 1) * this.stride;
    const { at } = scene.frames;
    this.from = at[0] ?? 0;
    this.to = at[at.length - 1] ?? 0;
    this.poses = new Float64Array(this.width);
  }

  /** Where it begins. */
  get begin(): number {
    return this.falls ? this.to : this.from;
  }

  /** Where it ends. */
  get end(): number {
    return this.falls ? this.from : this.to;
  }

  /** Poses of all bodies by Lagrange's polynomial through four frames; the same array each time. */
  at(place: number): Float64Array {
    if (place === this.posed) return this.poses;
    const { at, poses } = this.scene.frames;
    const out = this.poses.fill(0);
    this.posed = place;
    if (at.length === 0) return out;
    const x = Math.min(Math.max(place, this.from), this.to);
    const { first, weights: w } = weights(at, x, 0, at.length, above(at, x));
    w.forEach((weight, k) => {
      if (weight === 0) return;
      const base = (first + k) * this.width;
      for (let i = 0; i < this.width; i++) out[i]! += weight * poses[base + i]!;
    });
    if (this.stride === 7) for (let b = 0; b < this.width; b += 7) unit(out, b + 3);
    return out;
  }

  /** Where a place on a body is, m; in the plane the third number is 0. */
  world({ body, at }: Place, place: number): Vector {
    const turned = this.direction(body, at, place);
    if (body === 0) return turned;
    const pose = this.at(place);
    const base = (body - 1) * this.stride;
    return [turned[0] + pose[base]!, turned[1] + pose[base + 1]!, turned[2] + (this.stride === 7 ? pose[base + 2]! : 0)];
  }

  /** A direction fixed in a body, in the axes of the world. */
  direction(body: number, along: ArrayLike<number>, place: number): Vector {
    const v: Vector = [along[0] ?? 0, along[1] ?? 0, along[2] ?? 0];
    if (body === 0) return v;
    const pose = this.at(place);
    const base = (body - 1) * this.stride;
    if (this.stride === 3) {
      const [sin, cos] = [Math.sin(pose[base + 2]!), Math.cos(pose[base + 2]!)];
      return [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], 0];
    }
    return rotated(pose[base + 3]!, [pose[base + 4]!, pose[base + 5]!, pose[base + 6]!], v);
  }

  /** Where the ends of a link are, m; of one that acts along a direction alone the first goes beside the second. */
  ends({ a, b, along }: Link, place: number): [Vector, Vector] {
    const [p, q] = [this.world(a, place), this.world(b, place)];
    if (!along?.length) return [p, q];
    const n: Vector = [along[0]!, along[1]!, along[2] ?? 0];
    const way = n.reduce((sum, x, i) => sum + x * (q[i]! - p[i]!), 0);
    return [[q[0] - way * n[0], q[1] - way * n[1], q[2] - way * n[2]], q];
  }

  /** Angle of a body in the plane, rad. */
  angle(body: number, place: number): number {
    return body === 0 || this.stride === 7 ? 0 : this.at(place)[(body - 1) * 3 + 2]!;
  }

  /** A joint by its name: the middle between its two points. */
  joint(name: string, place: number): number[] | null {
    const joint = this.scene.joints.find((j) => j.name === name) ?? this.scene.links.find((l) => l.name === name);
    if (!joint) return null;
    return this.world(joint.a, place).slice(0, this.scene.dimensions);
  }

  /** Places of some frames, spread over the motion. */
  sampled(most: number): number[] {
    const { at } = this.scene.frames;
    const step = Math.max(1, Math.ceil(at.length / most));
    const out = [];
    for (let i = 0; i < at.length; i += step) out.push(at[i]!);
    if (at.length > 1 && out[out.length - 1] !== this.to) out.push(this.to);
    return out;
  }

  /** Every place that is drawn, for bounds of a picture. */
  *places(): Iterable<Place> {
    const { bodies, joints, links, gears, traces } = this.scene;
    for (const { a, b, axis, stroke } of joints) {
      yield* [a, b];
      // the ends of a guide
      for (const s of stroke ?? []) yield { body: a.body, at: a.at.map((x, i) => x + s * (axis[i] ?? 0)) };
    }
    for (const { a, b } of links) yield* [a, b];
    for (const { a, b, kind } of gears) {
      yield* round(a.body, a.at, a.radius);
      if (kind !== 'rack') yield* round(b.body, b.at, b.radius);
    }
    for (const { body, at } of traces) yield { body, at };
    for (let body = 0; body < bodies.length; body++) {
      for (const shape of bodies[body]!.shapes) {
        if (shape.kind === 'bar' || shape.kind === 'cylinder') yield* [{ body, at: shape.from }, { body, at: shape.to }];
        else if (shape.kind === 'hull' || shape.kind === 'polygon') for (const at of shape.points) yield { body, at };
        else if (shape.kind === 'mass') yield { body, at: shape.at };
        else if (shape.kind === 'box') yield* round(body, shape.center, Math.max(...shape.size) / 2);
        else yield* round(body, shape.center, shape.radius);
      }
    }
  }
}

function* round(body: number, center: number[], radius: number): Iterable<Place> {
  for (let axis = 0; axis < center.length; axis++) {
    for (const side of [-radius, radius]) yield { body, at: center.map((x, i) => (i === axis ? x + side : x)) };
  }
}

function unit(values: Float64Array, from: number): void {
  const length = Math.hypot(values[from]!, values[from + 1]!, values[from + 2]!, values[from + 3]!);
  if (length > 0) for (let i = from; i < from + 4; i++) values[i]! /= length;
}

/** v turned by a unit quaternion: v + 2 u × (u × v + w v). */
function rotated(w: number, u: Vector, v: Vector): Vector {
  const inner = cross(u, v);
  const outer = cross(u, [inner[0] + w * v[0], inner[1] + w * v[1], inner[2] + w * v[2]]);
  return [v[0] + 2 * outer[0], v[1] + 2 * outer[1], v[2] + 2 * outer[2]];
}

export function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
