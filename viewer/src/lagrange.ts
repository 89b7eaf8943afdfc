// Lagrange's polynomial through the four nodes around a place.

const NODES = 4;

/** The first node behind x, by halving; `at` rises from `from` to `to`. */
export function above(at: ArrayLike<number>, x: number, from = 0, to = at.length): number {
  let [low, high] = [from, to];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (at[middle]! <= x) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The first of the nodes around a place, and their weights there; nodes are those of `at` in from..to. */
export function weights(at: ArrayLike<number>, x: number, from = 0, to = at.length, behind = above(at, x, from, to)): { first: number; weights: number[] } {
  const count = Math.min(NODES, to - from);
  const first = Math.max(from, Math.min(behind - NODES / 2, to - count));
  const out: number[] = [];
  for (let k = first; k < first + count; k++) {
    let weight = 1;
    for (let i = first; i < first + count; i++) if (i !== k) weight *= (x - at[i]!) / (at[k]! - at[i]!);
    out.push(weight);
  }
  return { first, weights: out };
}
