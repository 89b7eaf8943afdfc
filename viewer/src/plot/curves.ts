// Which curves a figure has, from the results of a study.

import { column, drawn, fineOf, places, valueAt } from '../curves';
import { pretty, shownIn } from '../numbers';
import type { Column, Ends, Num, Plot, PlotAxis, Results, Study } from '../types';
import type { Curve, Figure } from './chart';
import { broken, families } from './families';

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

/** A curve whose points are computed when they are first asked for. */
class Later implements Curve {
  shown = true;
  private points: { x: number[]; y: number[] } | null = null;

  constructor(readonly label: string, readonly unit: string, readonly place: number, readonly quantity: string, private readonly make: () => { x: number[]; y: number[] }, readonly right = false, readonly dots = false, readonly dead = false, readonly runs = false) {}

  get x(): number[] {
    return (this.points ??= this.make()).x;
  }

  get y(): number[] {
    return (this.points ??= this.make()).y;
  }
}

/** Runs whose rows the page has, with their labels, and with their numbers among all that have begun; of a study of one run that one. */
function runsOf(study: Study): { label: string; results: Results; index: number; begun: number }[] {
  if (!study.table.reasons) return [{ label: '', results: study, index: 0, begun: 0 }];
  let begun = 0;
  return study.runs.flatMap(({ label, results }, index) => (results ? [{ label, results, index, begun: begun++ }] : [])).filter(({ results }) => results.independent.values.length > 0);
}

/** Names that a figure shows, and whether over the axis on the right. */
function sides({ show, right }: Plot): { name: string; right: boolean }[] {
  return [...show.map((name) => ({ name, right: false })), ...(right?.show ?? []).map((name) => ({ name, right: true }))];
}

/** The unit of a column: that of an axis for its quantity, else as columns are shown. */
function unitOf(of: Pick<Column, 'unit' | 'shown_in'>, axis: PlotAxis | null): { unit: string; size: number } {
  if (axis?.unit && axis.si === of.unit) return { unit: axis.unit[0], size: axis.unit[1] };
  return shownIn(of);
}

/** Adds curves that do not come from the study, behind `count` of it; how many there are then. */
function beside(plot: Plot, size: number, found: (name: string) => Column | undefined, curves: Curve[], count: number): number {
  for (const { label, of, x, y, measured } of plot.beside) {
    const like = found(of);
    if (!like) continue;
    const right = plot.right?.show.includes(of) ?? false;
    const { unit, size: high } = unitOf(like, right ? plot.right!.axis : plot.y);
    const by = (values: Num[], part: number) => values.map((v) => (v ?? NaN) / part);
    curves.push(new Later(label, unit, count++, like.quantity, () => ({ x: by(x, size), y: by(y, high) }), right, measured));
  }
  return count;
}

/** Ends of axes, as shown. */
function ranges(plot: Plot, size: number, found: (name: string) => Column | undefined): Pick<Figure, 'range' | 'ranges' | 'right'> {
  const ends = (range: Ends, by: number) => range.map((end) => (end === null ? null : end / by)) as Ends;
  const { y, right } = plot;
  const own = y && unitOf({ unit: y.si, shown_in: plot.show.map(found).find((c) => c?.unit === y.si)?.shown_in ?? null }, y);
  const other = right && found(right.show[0] ?? '');
  const of = other ? unitOf(other, right.axis) : null;
  return {
    range: ends(plot.range, size),
    ranges: y && own ? [{ unit: own.unit, range: ends(y.range, own.size) }] : [],
    ...(right && of && { right: { label: right.show.length === 1 ? right.show[0]! : right.show.join(', '), unit: of.unit, range: ends(right.axis.range, of.size) } }),
  };
}

/** Whether two columns are coordinates of one place by their names: `P.x` and `P.y`. */
export function isPath(show: string, over: string | null): boolean {
  const [own, other] = [show, over ?? ''].map((name) => /^(.+)\.([xyz])$/.exec(name));
  return Boolean(own && other && own[1] === other[1] && own[2] !== other[2]);
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
  const shown = sides(plot).filter(({ name }) => runs[0] && column(runs[0].results, name));
  for (const { label, results, index, begun } of runs) {
    const horizontal = plot.over ? column(results, plot.over) : results.independent;
    if (!horizontal) continue;
    over ??= horizontal;
    const size = plot.unit?.[1] ?? shownIn(horizontal).size;
    let x: number[] | null = null;
    const across = () => (x ??= (plot.over ? drawn(horizontal.values, fineOf(results)) : places(fineOf(results))).map((v) => v / size));
    const dead = plot.over === null && results.findings.some(({ code }) => code === 'dead-point');
    const value = (values: Column['values'], at: number) => valueAt(fineOf(results), values, at);
    for (const [k, { name, right }] of shown.entries()) {
      const vertical = column(results, name);
      if (!vertical) continue;
      const { unit, size: high } = unitOf(vertical, right ? plot.right!.axis : plot.y);
      const text = !several ? name : shown.length > 1 ? `${name}, ${pretty(label)}` : pretty(label);
      curves.push(new Later(text, unit, begun * shown.length + k, vertical.quantity, () => ({ x: across(), y: drawn(vertical.values, fineOf(results)).map((v) => v / high) }), right, false, dead));
      points.push((at) => [(plot.over ? value(horizontal.values, at) : at) / size, value(vertical.values, at) / high]);
      numbers.push(index);
    }
  }
  if (!over || curves.length === 0) return null;
  const [unit, size] = plot.unit ?? [shownIn(over).unit, shownIn(over).size];
  const begun = study.table.reasons ? study.runs.filter(({ results }) => results).length : 1;
  const count = beside(plot, size, (name) => column(runs[0]!.results, name), curves, begun * shown.length);
  const first = runs[0]!.results;
  const marks = several || plot.over ? [] : marked(first, shown.map(({ name }) => name));
  const free = !plot.right && !plot.y?.range.some((end) => end !== null) && !plot.range.some((end) => end !== null);
  const plane = free && plot.path && curves.every((curve) => curve.unit === unit);
  const figure: Figure = {
    x: { label: over.name, unit },
    y: (several || plot.beside.length > 0) && plot.show.length === 1 ? plot.show[0]! : '',
    curves,
    count,
    breaks: marks.map((row) => (first.independent.values[row] ?? NaN) / size),
    equal: plane,
    ordered: plot.over === null,
    ...ranges(plot, size, (name) => column(first, name)),
  };
  return { name: plot.name, figure, moves: plot.over === null, size, points, runs: numbers };
}

/** Rows before switches at which curves show; none where their lines would cover the curves. */
function marked(results: Results, names: string[]): number[] {
  const rows = [...new Set(names.flatMap((name) => results.rows?.bends?.[name] ?? []))];
  return rows.length > MOST_MARKED ? [] : rows;
}

function ofRuns(study: Study, plot: Plot): Drawable | null {
  const columns = study.table.columns;
  const over = plot.over ? columns.find((c) => c.name === plot.over) : columns[0];
  if (!over) return null;
  const [unit, size] = plot.unit ?? [shownIn(over).unit, shownIn(over).size];
  const found = (name: string) => columns.find((c) => c.name === name);
  const shown = sides(plot).flatMap(({ name, right }) => (found(name) ? [{ c: found(name)!, right }] : []));
  const { families: all, dots } = families(study, plot.over);
  const several = all.length > 1;
  const curves: Curve[] = [];
  for (const { label, rows } of all) {
    for (const { c, right } of shown) {
      const { unit: own, size: high } = unitOf(c, right ? plot.right!.axis : plot.y);
      const at = (of: Column, by: number) => rows.map((row) => (of.values[row] ?? NaN) / by);
      const text = !several ? c.name : shown.length > 1 ? `${c.name}, ${label}` : label;
      curves.push(new Later(text, own, curves.length, c.quantity, () => broken(at(over, size), at(c, high)), right, dots, false, true));
    }
  }
  if (curves.length === 0) return null;
  const count = beside(plot, size, found, curves, curves.length);
  const y = several && shown.length === 1 ? shown[0]!.c.name : '';
  const figure: Figure = { x: { label: over.name, unit }, y, curves, count, breaks: [], equal: false, ordered: !dots, ...ranges(plot, size, found) };
  return { name: plot.name, figure, moves: false, size, points: [], runs: [] };
}
