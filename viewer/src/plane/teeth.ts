// The outline of a wheel with teeth, as the figures have it: involutes of 20°, one module high and one and a quarter deep.

import type { Shape } from '../types';
import type { Point } from './pen';

export type Gear = Extract<Shape, { kind: 'gear' }>;

/** Pressure angle; height above and below the pitch circle, modules; points of a flank. */
const PRESSURE = Math.PI / 9;
const TIP = 1;
const ROOT = 1.25;
const FLANK = 5;

const involute = (angle: number) => Math.tan(angle) - angle;

/** Half of the angle that a tooth takes at some radius; below the base circle as on it. */
function half(teeth: number, pitch: number, radius: number): number {
  const base = pitch * Math.cos(PRESSURE);
  return Math.max(Math.PI / (2 * teeth) + involute(PRESSURE) - involute(Math.acos(Math.min(base / radius, 1))), 0);
}

/** The outline of a wheel in its body; of a ring that of a wheel whose teeth are its gaps. */
export function outline({ center, radius, teeth, first }: Gear): Point[] {
  const [pitch, inner] = [Math.abs(radius), radius < 0];
  const module = (2 * pitch) / teeth;
  const [low, high] = [pitch - (inner ? TIP : ROOT) * module, pitch + (inner ? ROOT : TIP) * module];
  const flank = Array.from({ length: FLANK }, (_, k) => low + ((high - low) * k) / (FLANK - 1)).map((r): Point => [r, half(teeth, pitch, r)]);
  return Array.from({ length: teeth }, (_, k) => first + (2 * Math.PI * (k + (inner ? 0.5 : 0))) / teeth).flatMap((middle) =>
    [...flank.map(([r, wide]): Point => [r, middle - wide]), ...[...flank].reverse().map(([r, wide]): Point => [r, middle + wide])].map(([r, angle]): Point => [(center[0] ?? 0) + r * Math.cos(angle), (center[1] ?? 0) + r * Math.sin(angle)]));
}

/** Radius of the rim of a ring: of its pitch circle 8 %, or a module beyond the teeth. */
export function rim({ radius, teeth }: Gear): number {
  return Math.abs(radius) * Math.max(1.08, 1 + (2 * (ROOT + 1)) / teeth);
}
