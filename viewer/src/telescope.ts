// Cylinders and the rods that slide in them.

import type { Scene } from './types';

/** Width of the rod of a cylinder whose true one the model does not give, as a part of that of the cylinder. */
export const ROD = 0.55;
/** Cylinders, one in the other, that are told apart. */
const MOST = 4;

/** For each body how many cylinders are around it, and rods within it, one in the other. */
export interface Stages { around: number[]; within: number[] }

export function stagesOf({ bodies, joints }: Scene): Stages {
  const slides = joints.filter(({ telescopes }) => telescopes).map(({ a, b }): [number, number] => [a.body, b.body]);
  const count = (pairs: [number, number][]) => {
    const of = (body: number, known: number): number => Math.max(known, ...pairs.flatMap(([own, other]) => (own === body && known < MOST ? [of(other, known + 1)] : [])));
    return bodies.map((_, body) => of(body, 0));
  };
  return { around: count(slides), within: count(slides.map(([rod, cylinder]) => [cylinder, rod])) };
}
