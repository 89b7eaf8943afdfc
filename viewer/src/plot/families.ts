// Which runs of a sweep make one curve of numbers of whole runs.

import { digits, pretty, shownIn } from '../numbers';
import type { Column, Study } from '../types';
import { bound, isPole } from './poles';

/** Digits of values in names of curves, and all that a number has. */
const IN_NAMES = 6;
const ALL = 17;
/** How much steeper than beside it a curve of whole runs is where it jumps. */
const STEEP = 8;

/** Runs that make one curve: what tells it from others, empty if there is no other; and their rows in the table. */
export interface Family {
  label: string;
  rows: number[];
}

/**
 * The runs of a sweep as curves over a column of its table, by default the first parameter: one for each combination of the other
 * parameters. `dots` says that no lines run between them, since values are drawn or come from a list of points.
 */
export function families(study: Study, over: string | null): { families: Family[]; dots: boolean } {
  const swept = study.swept ?? [];
  const along = Math.max(0, study.table.columns.slice(0, swept.length).findIndex((c) => c.name === over));
  const onGrid = swept[along]?.by === 'grid';
  const others = swept.flatMap(({ by }, k) => (k !== along && (by === 'grid' || (onGrid && by === 'points')) ? [k] : []));
  const found = new Map<string, number[]>();
  for (let row = 0; row < (study.table.columns[0]?.values.length ?? 0); row++) {
    const key = others.map((k) => study.table.columns[k]!.values[row]).join(' ');
    const rows = found.get(key);
    if (rows) rows.push(row);
    else found.set(key, [row]);
  }
  const label = ([first]: number[], count: number) => others.map((k) => valued(study, k, first!, count)).join(', ');
  const labels = (count: number) => [...found.values()].map((rows) => label(rows, count));
  const short = labels(IN_NAMES);
  const names = new Set(short).size === short.length ? short : labels(ALL);
  return {
    families: [...found.values()].map((rows, k) => ({ label: names[k]!, rows })),
    dots: swept.some(({ by }) => by === 'drawn') || (swept.length > 0 && !onGrid),
  };
}

/**
 * A curve of whole runs with a gap where it jumps from one run to the next, as in the figures of the program: where its slope is STEEP
 * times those on both sides, over more than a tenth of its range; and at a pole. Lines lead to values without bound.
 */
export function broken(x: number[], y: number[]): { x: number[]; y: number[] } {
  const slope = (k: number) => Math.abs((y[k + 1]! - y[k]!) / (x[k + 1]! - x[k]!));
  const most = bound(y);
  const known = y.filter((value) => Math.abs(value) < most);
  const range = known.reduce((most, v) => Math.max(most, v), -Infinity) - known.reduce((least, v) => Math.min(least, v), Infinity);
  const bounds = (k: number) => Math.abs(y[k]!) < most && Math.abs(y[k + 1]!) < most;
  const jumps = (k: number) => bounds(k) && Math.abs(y[k + 1]! - y[k]!) > 0.1 * range && k > 0 && k + 2 < y.length && slope(k) > STEEP * Math.max(slope(k - 1), slope(k + 1));
  const [u, v]: [number[], number[]] = [[], []];
  y.forEach((value, k) => {
    u.push(x[k]!);
    v.push(value);
    if (!jumps(k) && !isPole(x, y, k)) return;
    u.push(x[k]!);
    v.push(NaN);
  });
  return { x: u, y: v };
}

/** A parameter with its value in a row, in the unit that the model asks for, else in that in which its values are written. */
function valued(study: Study, parameter: number, row: number, count: number): string {
  const column: Column = study.table.columns[parameter]!;
  const written = column.shown_in ? null : study.swept?.[parameter]?.written_in;
  const { unit, size } = written ?? shownIn(column);
  return `${column.name} = ${digits((column.values[row] ?? NaN) / size, count)} ${pretty(unit)}`.trimEnd();
}
