// Actuators: a cylinder and its rod between two places.

import type { Motion } from '../motion';
import type { Link } from '../types';

/** Length of the cylinder, as part of the shortest distance of its ends. */
const CYLINDER = 0.8;

/** Length of the cylinder of an actuator at a place of the motion, as part of what is between its ends; 0 for any other link. */
export function cylinder({ kind, a, b, rest }: Link, motion: Motion, place: number): number {
  if (kind !== 'actuator' || rest === null) return 0;
  const [p, q] = [motion.world(a, place), motion.world(b, place)];
  return (CYLINDER * rest) / Math.hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
}
