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

/**
 * A smooth piece: its rows, the places at which it is drawn, and for each of these the first row that counts and the weights of it and
 * those behind; and whether a straight line leads on to the next one, which begins at another place only because a column has no values
 * there.
 */
interface Piece { from: number; to: number; at: number[]; first: Int32Array; weights: Float64Array; leads: boolean }

/** Places of the independent variable where curves are drawn, piece by piece. */
export interface Fine { x: number[]; pieces: Piece[] }

/** Places as dense as the rows that the study had. */
function fine(results: Results): Fine {
  const x = results.independent.values.map((v) => v ?? NaN);
  const { steps: rows } = results.rows;
  return {
    x,
    pieces: pieces(results).map(([from, to]) => {
      const at: number[] = [];
      for (let i = from; i < to; i++) {
        at.push(x[i]!);
        const steps = i + 1 < to ? Math.min(FINEST, rows[i + 1] ?? 1) : 1;
        for (let k = 1; k < steps; k++) at.push(x[i]! + ((x[i + 1]! - x[i]!) * k) / steps);
      }
      const leads = x[to] !== undefined && x[to] !== x[to - 1] && !results.table.switches.includes(to - 1);
      return { from, to, at, ...weighed(x, from, to, at), leads };
    }),
  };
}

const known = new WeakMap<Results, Fine>();

/** The places of results, which are found once. */
export function fineOf(results: Results): Fine {
  let found = known.get(results);
  if (!found) known.set(results, (found = fine(results)));
  return found;
}

/** Rows that count at a place at most. */
const COUNT = 4;

/** The rows that count at some places of one piece, and their weights: the same for all columns. */
function weighed(x: number[], from: number, to: number, at: number[]): Pick<Piece, 'first' | 'weights'> {
  // a falling variable is looked at backwards
  const falls = x[to - 1]! < x[from]!;
  const nodes = falls ? x.slice(from, to).map((v) => -v) : x.slice(from, to);
  const out = { first: new Int32Array(at.length), weights: new Float64Array(COUNT * at.length) };
  let row = 0;
  at.forEach((place, i) => {
    const p = falls ? -place : place;
    while (row < nodes.length && nodes[row]! <= p) row++;
    const exact = nodes[row - 1] === p;
    const found = exact ? { first: row - 1, weights: [1] } : weights(nodes, p, 0, nodes.length, row);
    out.first[i] = from + found.first;
    out.weights.set(found.weights, COUNT * i);
  });
  return out;
}

/** Values of a column at the places of one piece. */
function along(values: Num[], { first, weights: w }: Pick<Piece, 'first' | 'weights'>): number[] {
  return Array.from(first, (row, i) => {
    let sum = 0;
    for (let k = 0; k < COUNT; k++) {
      const weight = w[COUNT * i + k]!;
      if (weight !== 0) sum += weight * (values[row + k] ?? NaN);
    }
    return sum;
  });
}

/** A column at the fine places; pieces are parted by NaN unless they lead on. */
export function drawn(values: Num[], { pieces: parts }: Fine): number[] {
  return parts.flatMap((piece, i) => {
    const y = along(values, piece);
    return i + 1 < parts.length ? [...y, piece.leads && Number.isFinite(values[piece.to] ?? NaN) ? y[y.length - 1]! : NaN] : y;
  });
}

/** The fine places themselves, as long as `drawn`. */
export function places({ pieces: parts }: Fine): number[] {
  return parts.flatMap(({ at }, i) => (i + 1 < parts.length ? [...at, at[at.length - 1]!] : at));
}

/** The weights at a place of a falling variable. */
function turned(x: number[], place: number, from: number, to: number): { first: number; weights: number[] } {
  const found = weights(x.slice(from, to).map((v) => -v), -place);
  return { first: from + found.first, weights: found.weights };
}

/** The value of a column at one place. */
export function valueAt({ x, pieces: parts }: Fine, values: Num[], at: number): number {
  // a place at an end may lie beside it by rounding
  const ends = [x[0] ?? NaN, x[x.length - 1] ?? NaN].sort((a, b) => a - b) as [number, number];
  const near = 1e-9 * (ends[1] - ends[0]);
  const place = ends.find((end) => Math.abs(at - end) < near) ?? at;
  for (const { from, to, leads } of parts) {
    const [a, b, next] = [x[from]!, x[to - 1]!, x[to]!];
    if (leads && (place - b) * (place - next) < 0) {
      const part = (place - b) / (next - b);
      return (1 - part) * (values[to - 1] ?? NaN) + part * (values[to] ?? NaN);
    }
    if ((place - a) * (place - b) > 0) continue;
    const { first, weights: w } = b < a ? turned(x, place, from, to) : weights(x, place, from, to);
    return w.reduce((sum, weight, k) => (weight === 0 ? sum : sum + weight * (values[first + k] ?? NaN)), 0);
  }
  return NaN;
}

