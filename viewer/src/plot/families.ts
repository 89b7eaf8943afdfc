// Which runs of a sweep make one curve of numbers of whole runs.

import { digits, pretty, shownIn } from '../numbers';
import type { Column, Study } from '../types';

/** Digits of values in names of curves, and all that a number has. */
const IN_NAMES = 6;
const ALL = 17;

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

/** A parameter with its value in a row, in the unit that the model asks for, else in that in which its values are written. */
function valued(study: Study, parameter: number, row: number, count: number): string {
  const column: Column = study.table.columns[parameter]!;
  const written = column.shown_in ? null : study.swept?.[parameter]?.written_in;
  const { unit, size } = written ?? shownIn(column);
  return `${column.name} = ${digits((column.values[row] ?? NaN) / size, count)} ${pretty(unit)}`.trimEnd();
}
