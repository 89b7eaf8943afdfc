// Columns of a thinned table as curves: between the rows that are there they are Lagrange's polynomials, as the program made sure.

import { weights } from './lagrange';
import type { Column, Num, Results } from './types';

/** Points between two rows at most. */
const FINEST = 48;

/** A column by its name; figures may show curves that the table has not, and the independent variable. */
export function column(results: Results, name: string): Column | undefined {
  const of = (columns: Column[]) => columns.find((c) => c.name === name);
  return of(results.table.columns) ?? of(results.curves) ?? (results.independent.name === name ? results.independent : undefined);
}

/** Smooth pieces of the rows: from each, behind each. */
export function pieces(results: Results): [number, number][] {
  const count = results.independent.values.length;
  const ends = [...(results.rows.breaks ?? []).map((k) => k + 1), count];
  return ends.map((end, i) => [ends[i - 1] ?? 0, end]);
}

/** Places of the independent variable where curves are drawn, piece by piece, with rows of each. */
export interface Fine { x: number[]; pieces: { from: number; to: number; at: number[] }[] }

/** Places as dense as the rows that the study had. */
export function fine(results: Results): Fine {
  const x = results.independent.values.map((v) => v ?? NaN);
  const { kept } = results.rows;
  return {
    x,
    pieces: pieces(results).map(([from, to]) => {
      const at: number[] = [];
      for (let i = from; i < to; i++) {
        at.push(x[i]!);
        const steps = i + 1 < to ? Math.min(FINEST, (kept[i + 1] ?? i + 1) - (kept[i] ?? i)) : 1;
        for (let k = 1; k < steps; k++) at.push(x[i]! + ((x[i + 1]! - x[i]!) * k) / steps);
      }
      return { from, to, at };
    }),
  };
}

/** Values of a column at some places of one piece. */
function along(values: Num[], x: number[], from: number, to: number, at: number[]): number[] {
  // a falling variable is looked at backwards
  const falls = x[to - 1]! < x[from]!;
  const nodes = falls ? x.map((v) => -v) : x;
  let row = from;
  return at.map((place) => {
    const p = falls ? -place : place;
    while (row < to && nodes[row]! <= p) row++;
    if (nodes[row - 1] === p) return values[row - 1] ?? NaN;
    const { first, weights: w } = weights(nodes, p, from, to, row);
    return w.reduce((sum, weight, k) => sum + weight * (values[first + k] ?? NaN), 0);
  });
}

/** A column at the fine places; pieces are parted by NaN. */
export function drawn(values: Num[], { x, pieces: parts }: Fine): number[] {
  return parts.flatMap(({ from, to, at }, i) => {
    const y = along(values, x, from, to, at);
    return i + 1 < parts.length ? [...y, NaN] : y;
  });
}

/** The fine places themselves, as long as `drawn`. */
export function places({ pieces: parts }: Fine): number[] {
  return parts.flatMap(({ at }, i) => (i + 1 < parts.length ? [...at, at[at.length - 1]!] : at));
}

/** The value of a column at one place. */
export function valueAt(results: Results, values: Num[], place: number): number {
  const x = results.independent.values.map((v) => v ?? NaN);
  for (const [from, to] of pieces(results)) {
    const [a, b] = [x[from]!, x[to - 1]!];
    if ((place - a) * (place - b) <= 0) return along(values, x, from, to, [place])[0]!;
  }
  return NaN;
}

