// Which curves a figure has, from the results of a study.

import { type Fine, column, drawn, fine, places, valueAt } from '../curves';
import { pretty, shownIn } from '../numbers';
import type { Column, Plot, Results, Study } from '../types';
import type { Curve, Figure } from './chart';

/** Switches that are marked by lines in a figure, at most. */
const MOST_MARKED = 16;

/** A figure, and its curves at a place of the motion in view. */
export interface Drawable {
  name: string;
  figure: Figure;
  /** Whether its horizontal axis is the independent variable; and what that is divided by. */
  moves: boolean;
  size: number;
  /** The point of each curve at a place of its independent variable, as shown. */
  points: ((at: number) => [number, number])[];
  /** For each curve the number of its run. */
  runs: number[];
}

const resolved = new WeakMap<Results, Fine>();

function fineOf(results: Results): Fine {
  let known = resolved.get(results);
  if (!known) resolved.set(results, (known = fine(results)));
  return known;
}

/** Runs with their labels; of a study of one run that one. */
function runsOf(study: Study): { label: string; results: Results; index: number }[] {
  if (!study.table.reasons) return [{ label: '', results: study, index: 0 }];
  return study.runs.flatMap(({ label, results }, index) => (results && results.independent.values.length > 0 ? [{ label, results, index }] : []));
}

/** A figure that a study asks for, or a reader; none if nothing of it is there. */
export function drawable(study: Study, plot: Plot): Drawable | null {
  return plot.of_runs ? ofRuns(study, plot) : ofColumns(study, plot);
}

function ofColumns(study: Study, plot: Plot): Drawable | null {
  const runs = runsOf(study);
  const several = runs.length > 1 || study.table.reasons !== null;
  const [curves, points, numbers]: [Curve[], Drawable['points'], number[]] = [[], [], []];
  let over: Column | undefined;
  for (const { label, results, index } of runs) {
    const horizontal = plot.over ? column(results, plot.over) : results.independent;
    if (!horizontal) continue;
    over ??= horizontal;
    const size = plot.unit?.[1] ?? shownIn(horizontal).size;
    const grid = fineOf(results);
    const x = (plot.over ? drawn(horizontal.values, grid) : places(grid)).map((v) => v / size);
    for (const name of plot.show) {
      const vertical = column(results, name);
      if (!vertical) continue;
      const { unit, size: high } = shownIn(vertical);
      const y = drawn(vertical.values, grid).map((v) => v / high);
      const text = !several ? name : plot.show.length > 1 ? `${name}, ${pretty(label)}` : pretty(label);
      curves.push({ label: text, unit, x, y, color: curves.length, dash: curves.length, shown: true });
      points.push((at) => [(plot.over ? valueAt(results, horizontal.values, at) : at) / size, valueAt(results, vertical.values, at) / high]);
      numbers.push(index);
    }
  }
  if (!over || curves.length === 0) return null;
  const [unit, size] = plot.unit ?? [shownIn(over).unit, shownIn(over).size];
  const first = runs[0]!.results;
  const marked = !several && !plot.over && first.table.switches.length <= MOST_MARKED;
  const plane = plot.over !== null && over.unit === 'm' && curves.every((curve) => curve.unit === unit);
  const figure: Figure = {
    x: { label: over.name, unit },
    y: several && plot.show.length === 1 ? plot.show[0]! : '',
    curves,
    breaks: marked ? first.table.switches.map((row) => (first.independent.values[row] ?? NaN) / size) : [],
    equal: plane,
    ordered: plot.over === null,
  };
  return { name: plot.name, figure, moves: plot.over === null, size, points, runs: numbers };
}

function ofRuns(study: Study, plot: Plot): Drawable | null {
  const columns = study.table.columns;
  const over = plot.over ? columns.find((c) => c.name === plot.over) : columns[0];
  if (!over) return null;
  const [unit, size] = plot.unit ?? [shownIn(over).unit, shownIn(over).size];
  const x = over.values.map((v) => (v ?? NaN) / size);
  const shown = plot.show.flatMap((name) => columns.find((c) => c.name === name) ?? []);
  const curves = shown.map((c, k): Curve => {
    const { unit: own, size: high } = shownIn(c);
    return { label: c.name, unit: own, x, y: c.values.map((v) => (v ?? NaN) / high), color: k, dash: k, shown: true };
  });
  if (curves.length === 0) return null;
  const figure: Figure = { x: { label: over.name, unit }, y: '', curves, breaks: [], equal: false, ordered: true };
  return { name: plot.name, figure, moves: false, size, points: [], runs: [] };
}
