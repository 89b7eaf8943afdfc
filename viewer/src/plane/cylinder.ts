// Actuators: tubes that slide in each other between two places.

import type { Motion } from '../motion';
import type { Link } from '../types';

/** Where the tubes of an actuator end at a place of the motion, parts of what is between its ends, the rod the last; none of any other link. */
export function cylinder(link: Link, motion: Motion, place: number): number[] {
  const { tube: length, stages } = link;
  if (length === undefined) return [];
  const [p, q] = motion.ends(link, place);
  const tube = Math.min(length / Math.hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]), 1);
  const last = Math.max(stages ?? 2, 2) - 1;
  return Array.from({ length: last + 1 }, (_, k) => tube + ((1 - tube) * k) / last);
}
