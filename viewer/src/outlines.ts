// Outlines of bodies: in their frames, and as they are seen.

import type { Point } from './plane/pen';
import { across, unit } from './space/vectors';
import type { Shape } from './types';

/** Left, top, right, bottom. */
export type Box = [number, number, number, number];

/** Corners of the edge of a disc. */
const EDGES = 16;
/** The same of one in space. */
const ROUND = 12;

/** Whether a shape has an area. */
export function isArea(shape: Shape): boolean {
  return shape.kind === 'hull' ? shape.points.length > 2 : ['polygon', 'disc', 'gear', 'box'].includes(shape.kind);
}

/** Points of a circle in the plane; none in space. */
export function circle(center: number[], radius: number, count: number): number[][] {
  const turn = (k: number) => (2 * Math.PI * k) / count;
  return center.length > 2 ? [] : Array.from({ length: count }, (_, k) => [center[0]! + radius * Math.cos(turn(k)), center[1]! + radius * Math.sin(turn(k))]);
}

/** The line of a body in its frame, or the edge of what is wide. */
export function outline(shape: Shape): { line: number[][]; closed: boolean } {
  switch (shape.kind) {
    case 'bar': case 'cylinder': return { line: [shape.from, shape.to], closed: false };
    case 'hull': case 'polygon': return { line: shape.points, closed: shape.points.length > 2 && shape.points[0]!.length === 2 };
    case 'mass': return { line: [shape.at], closed: false };
    case 'disc': case 'gear': return shape.center.length > 2 ? { line: [shape.center], closed: false } : { line: circle(shape.center, Math.abs(shape.radius), EDGES), closed: true };
    default: return { line: [shape.center], closed: false };
  }
}

/** Corners of what is solid in space; none of a bar, which is its line. */
export function corners(shape: Shape): number[][] {
  const beside = (center: number[], radius: number) => [0, 1, 2].flatMap((axis) => [-radius, radius].map((x) => center.map((c, i) => (i === axis ? c + x : c))));
  switch (shape.kind) {
    case 'hull': return shape.points.length > 2 ? shape.points : [];
    case 'box': return Array.from({ length: 8 }, (_, k) => shape.center.map((c, i) => c + ((k >> i) % 2 ? 0.5 : -0.5) * (shape.size[i] ?? 0)));
    case 'cylinder': return [shape.from, shape.to].flatMap((end) => ring(end, shape.to.map((x, i) => x - shape.from[i]!), shape.radius));
    case 'disc': {
      const axis = shape.axis ?? [0, 0, 1];
      const half = (shape.thickness ?? 0) / 2 / Math.hypot(...axis);
      return [-half, half].flatMap((s) => ring(shape.center.map((x, i) => x + s * axis[i]!), axis, shape.radius));
    }
    // a cube about what is round is near enough
    case 'sphere': return beside(shape.center, shape.radius);
    default: return [];
  }
}

/** Corners of a circle in space about an axis. */
function ring(center: number[], axis: number[], radius: number): number[][] {
  const [u, v] = across(unit([axis[0] ?? 0, axis[1] ?? 0, axis[2] ?? 0]));
  return Array.from({ length: ROUND }, (_, k) => {
    const [sin, cos] = [Math.sin((2 * Math.PI * k) / ROUND), Math.cos((2 * Math.PI * k) / ROUND)];
    return center.map((x, i) => x + radius * (cos * u[i]! + sin * v[i]!));
  });
}

/** The box around points. */
export function around(points: Point[]): Box {
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

/** The part of the way from one point to another at which it is nearest to a third, from 0 to 1. */
export function part([x, y]: Point, [ax, ay]: Point, [bx, by]: Point): number {
  const [dx, dy] = [bx - ax, by - ay];
  return Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
}

/** How far a point is from a line in the picture; 0 within an edge. */
export function away([x, y]: Point, line: Point[], closed: boolean): number {
  let [least, inside] = [Infinity, false];
  for (let i = closed ? 0 : Math.min(1, line.length - 1); i < line.length; i++) {
    const [[ax, ay], [bx, by]] = [line[(i || line.length) - 1]!, line[i]!];
    const s = part([x, y], [ax, ay], [bx, by]);
    least = Math.min(least, Math.hypot(ax + s * (bx - ax) - x, ay + s * (by - ay) - y));
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) inside = !inside;
  }
  return closed && inside ? 0 : least;
}

/** How large a line is in the picture. */
export function extent(line: Point[]): number {
  const [left, top, right, bottom] = around(line);
  return Math.hypot(right - left, bottom - top);
}
