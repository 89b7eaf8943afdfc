// Faces of the bodies of a mechanism, each in the frame of its body.

import type { Vector } from '../motion';
import { ROD, stagesOf } from '../telescope';
import type { Scene, Shape } from '../types';
import { type Face, add, ball, box, face, scaled, sheet, tube, unit } from './vectors';

/** Sides of round bars and discs. */
const SIDES = 14;
/** Sides of a wheel. */
const RIM = 48;

const vector = (at: number[]): Vector => [at[0] ?? 0, at[1] ?? 0, at[2] ?? 0];

/** Colours of a body and of a point mass on it. */
export interface Colors { body: string; mass: string }

/** Faces of a shape; `thin` is the radius of a bar whose true one the model does not give. */
function faces(shape: Shape, thin: number, { body: color, mass }: Colors): Face[] {
  switch (shape.kind) {
    case 'bar': return tube(vector(shape.from), vector(shape.to), Math.max((shape.width ?? 0) / 2, thin), Math.max((shape.width ?? 0) / 2, thin), 10, color);
    case 'cylinder': return tube(vector(shape.from), vector(shape.to), shape.radius, shape.radius, SIDES, color);
    case 'sphere': return ball(vector(shape.center), shape.radius, color);
    // in the plane alone
    case 'gear': return [];
    case 'mass': return ball(vector(shape.at), Math.max(shape.radius, 1.6 * thin), mass);
    case 'box': return box(vector(shape.center), vector(shape.size), color);
    case 'polygon': return shape.points.length > 2 ? sheet(shape.points.map(vector), color) : [];
    case 'disc': {
      const half = scaled(unit(vector(shape.axis ?? [0, 0, 1])), Math.max((shape.thickness ?? 0) / 2, 0.4 * thin));
      const center = vector(shape.center);
      return tube(add(center, half, -1), add(center, half), shape.radius, shape.radius, RIM, color).map((one) => ({ ...one, clear: (shape.thickness ?? 0) <= shape.radius }));
    }
    case 'hull': {
      const points = shape.points.map(vector);
      if (points.length === 1) return ball(points[0]!, 1.8 * thin, color);
      if (points.length === 2) return tube(points[0]!, points[1]!, thin, thin, 10, color);
      if (shape.faces?.length) return shape.faces.map((corners) => face(corners.map((k) => points[k]!), color, true));
      const middle = scaled(points.reduce((sum, p) => add(sum, p), [0, 0, 0] as Vector), 1 / points.length);
      return points.flatMap((point) => tube(middle, point, 0.7 * thin, 0.7 * thin, 8, color));
    }
  }
}

/** Cut across, so that long faces are sorted well by their middles. */
function pieces(all: Face[], longest: number): Face[] {
  return all.flatMap((one) => {
    const [a, b, c, d] = one.points;
    if (one.points.length !== 4 || one.edged) return [one];
    const along = add(d!, a!, -1);
    const count = Math.min(8, Math.ceil(Math.hypot(...along) / longest));
    if (count < 2) return [one];
    const between = (p: Vector, q: Vector, k: number) => add(p, add(q, p, -1), k / count);
    return Array.from({ length: count }, (_, k) => ({ ...one, points: [between(a!, d!, k), between(b!, c!, k), between(b!, c!, k + 1), between(a!, d!, k + 1)] }));
  });
}

/** Faces of all bodies, body by body. */
export function bodies(scene: Scene, size: number, colors: (body: number) => Colors): Face[][] {
  const thin = 0.013 * size;
  const { around } = stagesOf(scene);
  // a body of one point is shown by the joint there, if there is one
  const ends = scene.joints.filter(({ kind }) => kind !== 'free' && kind !== 'distance').flatMap(({ a, b }) => [a, b]);
  const same = (at: number[], point: number[]) => at.every((x, i) => Math.abs(x - point[i]!) <= 1e-6 * size);
  const hidden = (shape: Shape, body: number) => shape.kind === 'hull' && shape.points.length === 1 && ends.some((end) => end.body === body && same(end.at, shape.points[0]!));
  return scene.bodies.map(({ shapes }, index) => pieces(shapes.filter((shape) => !hidden(shape, index)).flatMap((shape) => faces(shape, thin * ROD ** around[index]!, colors(index))), 0.12 * size));
}
