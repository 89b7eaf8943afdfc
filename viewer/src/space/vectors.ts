// Vectors and faces in space.

import { type Vector, cross } from '../motion';

export const add = (a: Vector, b: Vector, by = 1): Vector => [a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2]];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const scaled = (a: Vector, by: number): Vector => [a[0] * by, a[1] * by, a[2] * by];

export function unit(a: Vector): Vector {
  const length = Math.hypot(...a);
  return length > 1e-12 ? scaled(a, 1 / length) : [0, 0, 1];
}

/** Two unit directions across a unit one. */
export function across(axis: Vector): [Vector, Vector] {
  const other: Vector = Math.abs(axis[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0];
  const u = unit(cross(axis, other));
  return [u, cross(axis, u)];
}

/** The same, so that the direction at an angle from the first to the second is that towards the eye, unless the axis points there. */
export function facing(axis: Vector, eye: Vector, angle: number): [Vector, Vector] {
  const [u, v] = across(axis);
  const [x, y] = [dot(u, eye), dot(v, eye)];
  if (Math.hypot(x, y) < 0.1) return [u, v];
  const turn = Math.atan2(y, x) - angle;
  return [add(scaled(u, Math.cos(turn)), v, Math.sin(turn)), add(scaled(v, Math.cos(turn)), u, -Math.sin(turn))];
}

/** A plane face of a body, in the frame of the body, around its outward normal; one that is clear lets through what is behind it. */
export interface Face { points: Vector[]; normal: Vector; color: string; edged: boolean; clear?: boolean }

/** A face around its corners, counter-clockwise from outside. */
export function face(points: Vector[], color: string, edged: boolean): Face {
  const normal = unit(cross(add(points[1]!, points[0]!, -1), add(points[2]!, points[1]!, -1)));
  return { points, normal, color, edged };
}

/** A prism or frustum around an axis, with closed ends. */
export function tube(from: Vector, to: Vector, radius: number, end: number, sides: number, color: string): Face[] {
  const axis = unit(add(to, from, -1));
  const [u, v] = across(axis);
  const ring = (center: Vector, r: number) => Array.from({ length: sides }, (_, k): Vector => {
    const turn = (2 * Math.PI * k) / sides;
    return add(add(center, u, r * Math.cos(turn)), v, r * Math.sin(turn));
  });
  const [a, b] = [ring(from, radius), ring(to, end)];
  const walls = a.map((_, k) => face([a[k]!, a[(k + 1) % sides]!, b[(k + 1) % sides]!, b[k]!], color, false));
  return [...walls, face([...a].reverse(), color, true), face(b, color, true)];
}

/** A box along the axes. */
export function box(center: Vector, size: Vector, color: string): Face[] {
  const at = (i: number, j: number, k: number): Vector => add(center, [(i * size[0]) / 2, (j * size[1]) / 2, (k * size[2]) / 2]);
  const sides: [number, number, number][][] = [
    [[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]], [[-1, -1, -1], [-1, -1, 1], [-1, 1, 1], [-1, 1, -1]],
    [[-1, 1, -1], [-1, 1, 1], [1, 1, 1], [1, 1, -1]], [[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1]],
    [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], [[-1, -1, -1], [-1, 1, -1], [1, 1, -1], [1, -1, -1]],
  ];
  return sides.map((corners) => face(corners.map(([i, j, k]) => at(i, j, k)), color, true));
}

/** A flat sheet that is seen from both sides. */
export function sheet(points: Vector[], color: string): Face[] {
  return [face(points, color, true), face([...points].reverse(), color, true)];
}

/** A ball of flat faces. */
export function ball(center: Vector, radius: number, color: string): Face[] {
  const [rings, sides] = [7, 12];
  const at = (i: number, k: number): Vector => {
    const [theta, phi] = [(Math.PI * i) / rings, (2 * Math.PI * k) / sides];
    return add(center, [radius * Math.sin(theta) * Math.cos(phi), radius * Math.sin(theta) * Math.sin(phi), radius * Math.cos(theta)]);
  };
  const out: Face[] = [];
  for (let i = 0; i < rings; i++) {
    for (let k = 0; k < sides; k++) {
      const corners = i === 0 ? [at(0, 0), at(1, k), at(1, k + 1)] : i === rings - 1 ? [at(i, k), at(rings, 0), at(i, k + 1)] : [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
      out.push(face(corners, color, false));
    }
  }
  return out;
}
