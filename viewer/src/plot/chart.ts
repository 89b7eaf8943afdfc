// A figure as SVG: panels of curves, one above the other, over one horizontal axis. The screen, the printer and a file get the same.

import { s } from '../dom';
import type { Ends } from '../types';
import { type Axis, axis, level, over, read, said, shared, withEnds } from './axis';
import { type Point, heads } from './heads';
import { bounded } from './poles';

export interface Curve {
  label: string;
  /** Unit of y as shown, and what y is of, as `force`. */
  unit: string;
  quantity: string;
  x: number[];
  y: number[];
  /** Its number among the curves of the figure, by which it has its colour and its dashes. */
  place: number;
  shown: boolean;
  /** Whether it is drawn over the axis on the right, and whether by its points alone. */
  right?: boolean;
  dots?: boolean;
  /** Whether its points are values of runs, which are marked where they are few. */
  runs?: boolean;
  /** Whether its study reports a dead point, where values may grow without bound. */
  dead?: boolean;
}

export interface Figure {
  x: { label: string; unit: string };
  /** What the vertical axis of a figure with one curve name says. */
  y: string;
  curves: Curve[];
  /** Curves of the study's figure, also those whose values the page does not have. */
  count: number;
  breaks: number[];
  equal: boolean;
  ordered: boolean;
  /** Ends of the axes that the study gives, as shown: across, of the curves of a unit, and on the right. */
  range?: Ends;
  ranges?: { unit: string; range: Ends }[];
  right?: { label: string; unit: string; range: Ends };
}

export interface View {
  width: number;
  log: boolean;
  /** Chosen ranges; the vertical one of figures of one panel alone. */
  x: [number, number] | null;
  y: [number, number] | null;
  /** The curve among many that is drawn strong. */
  strong?: (curve: number) => boolean;
}

/** Curves of one unit that are shown. */
export interface Panel { curves: Curve[]; unit: string; top: number; height: number; y: Axis; right?: Axis; clipped: boolean }
export interface Layout { left: number; right: number; width: number; height: number; x: Axis; panels: Panel[] }

export const COLORS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#3c3c3c'];
/** Half as long as in the figures of the program. */
const DASHES = ['none', '7 3.5', '1.5 3.5', '9 3 1.5 3', '4 2.5', '12 4', '7 2.5 1.5 2.5 1.5 2.5'];
/** For many curves the page has the scale of the program's figures, rising in lightness, of this many colours from `--scale-0` on. */
const STOPS = 5;
const LETTER = 6.7;
/** Letters that the ticks of an axis have room for where there is room, so that figures one below the other begin alike. */
const TICK = 6;
const NARROW = 420;
/** Names of curves on an axis at most, and their letters. */
const NAMES = 3;
const SPACE = 36;
/** The same of an axis beside others. */
const BESIDE = 22;
/** A line of so many points at most joins results of single runs, which have no direction. */
const FEW = 25;
/** How much is seen of a curve beside the chosen one. */
const FAINT = 0.62;

/** The colour of a curve; many curves take a scale. */
export function color({ place: index }: Curve, { count }: Figure): string {
  if (count <= COLORS.length) return `var(--curve-${index % COLORS.length})`;
  const place = (index / (count - 1)) * (STOPS - 1);
  const low = Math.min(Math.floor(place), STOPS - 2);
  return `color-mix(in srgb, var(--scale-${low}), var(--scale-${low + 1}) ${Math.round(1e5 * (place - low)) / 1e3}%)`;
}

/** Colour and dashes of a curve: those that the program's figures of the study have. */
export function style(curve: Curve, figure: Figure): { stroke: string; 'stroke-dasharray': string } {
  return { stroke: color(curve, figure), 'stroke-dasharray': curve.dots ? 'none' : DASHES[curve.place % DASHES.length]! };
}

/** Where everything stands. */
export function layout(figure: Figure, view: View): Layout {
  const shown = figure.curves.filter((curve) => curve.shown);
  const units = [...new Set(figure.curves.filter((curve) => !curve.right).map((curve) => curve.unit))];
  const unit = figure.x.unit;
  const x = view.x ? over(...view.x, unit, false, 80, true) : limited(figure.range, unit, false, 80, axis(all(figure.curves), unit, { tight: figure.ordered, plain: figure.equal, gap: 80 }));
  const height = units.length > 1 ? 170 : 250;
  const upright = (curves: Curve[], of: string, range: Ends | undefined, log: boolean): [Axis, boolean] => {
    const bounds = log ? null : bounded(curves);
    const values = [...within(curves, view.x ?? [x.low, x.high])].map((y) => (bounds ? Math.min(Math.max(y, bounds[0]), bounds[1]) : y));
    return [limited(range, of, log, 44, axis(values, of, { log, plain: figure.equal, gap: 44 })), bounds !== null];
  };
  const panels = units.map((own, k): Panel => {
    const left = shown.filter((curve) => curve.unit === own && !curve.right);
    const others = k === 0 ? shown.filter((curve) => curve.right) : [];
    const [fitted, cut] = upright(left, own, figure.ranges?.find((r) => r.unit === own)?.range, view.log);
    const chosen = view.y && units.length === 1 ? over(...view.y, own, view.log, 44, true) : null;
    const [beside, cutRight] = k === 0 && figure.right ? upright(others, figure.right.unit, figure.right.range, false) : [undefined, false];
    const open = (range: Ends | undefined) => (range ?? []).every((end) => end === null);
    const free = !chosen && open(figure.ranges?.find((r) => r.unit === own)?.range) && open(figure.right?.range);
    const [y, right] = beside && free ? level(fitted, beside, 44) : [chosen ?? fitted, beside];
    return { curves: [...left, ...others], unit: own, top: 12 + k * (height + 18), height, y, clipped: cut || cutRight, ...(right && { right }) };
  });
  const letters = (of: Axis | undefined, room: number) => (of ? of.ticks(room).map(({ text }) => text.length) : []);
  const labels = panels.flatMap((panel) => letters(panel.y, panel.height));
  const beside = panels.flatMap((panel) => letters(panel.right, panel.height));
  const aside = beside.length > 0 ? 34 + LETTER * Math.max(1, ...beside) : 14;
  const left = Math.min(34 + LETTER * Math.max(view.width > NARROW ? TICK : 1, ...labels), view.width / 3);
  const bottom = panels[panels.length - 1];
  const out: Layout = { left, right: view.width - aside, width: view.width, height: (bottom ? bottom.top + bottom.height : 0) + 46, x, panels };
  if (figure.equal && panels.length === 1) equalise(out, panels[0]!, figure, view);
  return out;
}

/** An axis with the ends that are given. */
function limited(range: Ends | undefined, unit: string, log: boolean, gap: number, fitted: Axis): Axis {
  const [low, high] = range ?? [null, null];
  if (low === null && high === null) return fitted;
  const ends = [low ?? fitted.low, high ?? fitted.high] as [number, number];
  // one end may lie beyond all curves
  if (ends[0] > ends[1]) ends.splice(0, 2, ...(low !== null && high !== null ? [high, low] : [low ?? high!, low ?? high!]));
  if (ends[0] === ends[1]) ends[1] += Math.abs(ends[0]) || 1;
  return over(...ends, unit, log, gap);
}

/** Values in view that a logarithmic axis cannot show. */
export function below(figure: Figure, { x: { low, high } }: Layout): number {
  let count = 0;
  for (const y of within(figure.curves.filter((curve) => curve.shown && !curve.right), [low, high])) if (y <= 0) count++;
  return count;
}

/** The vertical axis of a curve. */
export function axisOf(panel: Panel, curve: Curve): Axis {
  return curve.right && panel.right ? panel.right : panel.y;
}

/** A value of a curve as it is read at the cursor. */
export function readOf({ panels }: Layout, curve: Curve, value: number): string {
  const panel = curve.right ? panels[0] : panels.find(({ unit }) => unit === curve.unit);
  return panel ? read(value, axisOf(panel, curve), curve.unit) : '';
}

function* all(curves: Curve[]): Iterable<number> {
  for (const { x } of curves) yield* x;
}

function* within(curves: Curve[], range: [number, number] | null): Iterable<number> {
  for (const { x, y } of curves) for (let i = 0; i < y.length; i++) if (!range || (x[i]! >= range[0] && x[i]! <= range[1])) yield y[i]!;
}

/** The same scale along both axes. */
function equalise(out: Layout, panel: Panel, figure: Figure, view: View): void {
  const room = out.right - out.left;
  const [w, h] = [out.x.high - out.x.low, panel.y.high - panel.y.low];
  panel.height = Math.min(Math.max((room * h) / w, 180), 380);
  const scale = Math.min(room / w, panel.height / h);
  const wider = (a: Axis, size: number, gap: number) => withEnds((a.low + a.high - size) / 2, (a.low + a.high + size) / 2, figure.x.unit === panel.unit ? shared(panel.unit, out.x, panel.y) : a.shown, gap);
  if (!view.log) [out.x, panel.y] = [wider(out.x, room / scale, 60), wider(panel.y, panel.height / scale, 40)];
  out.height = panel.top + panel.height + 46;
}

/** The pieces of a curve in pixels; points that cannot be told apart are left out. */
function pieces(curve: Curve, { left, right, x: across }: Layout, panel: Panel): Point[][] {
  const { x, y, dots } = curve;
  const { top, height } = panel;
  const up = axisOf(panel, curve);
  const out: Point[][] = [];
  let piece: Point[] | null = null;
  let [px, py] = [NaN, NaN];
  const n = x.length;
  for (let i = 0; i < n; i++) {
    const u = left + across.part(x[i]!) * (right - left);
    const v = top + (1 - up.part(y[i]!)) * height;
    if (!Number.isFinite(u + v)) {
      piece = null;
      continue;
    }
    if (!dots && piece && Math.abs(u - px) + Math.abs(v - py) < 0.4 && i + 1 < n && Number.isFinite(y[i + 1]!)) continue;
    if (!piece) out.push((piece = []));
    piece.push([u, v]);
    [px, py] = [u, v];
  }
  return out;
}

/** The line through pieces, or their points alone. */
function path(lines: Point[][], dots = false): string {
  // far out of the picture numbers are too long for some renderers
  const text = ([u, v]: Point) => `${clamp(u)} ${clamp(v)}`;
  return lines.map((line) => (dots ? line.map((at) => `M${text(at)}h0`).join('') : `M${line.map(text).join('L')}`)).join('');
}

/** What of pieces is in a panel, to whole points. */
function inside(lines: Point[][], { left, right }: Layout, { top, height }: Panel): Point[][] {
  return lines.flatMap((line) => {
    const out: Point[][] = [[]];
    for (const at of line) {
      if (at[0] >= left && at[0] <= right && at[1] >= top && at[1] <= top + height) out[out.length - 1]!.push(at);
      else if (out[out.length - 1]!.length > 0) out.push([]);
    }
    return out;
  });
}

/** Arrows where pieces leave a panel above or below. */
function leaving(lines: Point[][], { top, height }: Panel): Point[][] {
  const out: Point[][] = [];
  for (const line of lines) {
    line.slice(1).forEach(([u, v], k) => {
      const [pu, pv] = line[k]!;
      for (const [edge, way] of [[top, 1], [top + height, -1]] as const) {
        if ((v - edge) * (pv - edge) >= 0) continue;
        const at = pu + ((edge - pv) / (v - pv)) * (u - pu);
        out.push([[at, edge + way], [at - 4, edge + 9 * way], [at + 4, edge + 9 * way]]);
      }
    });
  }
  return out;
}

function clamp(x: number): string {
  return Math.min(Math.max(x, -1e5), 1e5).toFixed(1);
}

let count = 0;

/** The figure. */
export function draw(figure: Figure, view: View, out: Layout, title: string): SVGSVGElement {
  const svg = s('svg', { viewBox: `0 0 ${view.width} ${out.height}`, width: view.width, height: out.height, role: 'img', 'aria-label': title, class: 'chart' });
  const { left, right } = out;
  const last = out.panels[out.panels.length - 1]!;
  for (const panel of out.panels) {
    const id = `clip-${count++}`;
    const { top, height } = panel;
    svg.append(s('clipPath', { id }, s('rect', { x: left, y: top - 2, width: Math.max(right - left, 0), height: height + 4 })));
    for (const { at, text } of panel.y.ticks(height)) {
      const y = top + (1 - panel.y.part(at)) * height;
      svg.append(s('line', { x1: left, x2: right, y1: y, y2: y, stroke: 'var(--grid)' }), label(text, left - 7, y + 4, 'end'));
    }
    for (const { at, text } of out.x.ticks(right - left)) {
      const x = left + out.x.part(at) * (right - left);
      svg.append(s('line', { x1: x, x2: x, y1: top, y2: top + height, stroke: 'var(--grid)' }));
      if (panel === last) svg.append(label(text, x, top + height + 17, 'middle'));
    }
    for (const at of figure.breaks) {
      const x = left + out.x.part(at) * (right - left);
      if (x > left && x < right) svg.append(s('line', { x1: x, x2: x, y1: top, y2: top + height, stroke: 'var(--faint)', 'stroke-dasharray': '2 3' }));
    }
    svg.append(s('path', { d: `M${left} ${top}V${top + height}H${right}`, fill: 'none', stroke: 'var(--line)' }));
    // whole at the ends of the axis, too
    const marked: SVGElement[] = [];
    const lines = panel.curves.flatMap((curve) => {
      const own = pieces(curve, out, panel);
      const strong = view.strong?.(figure.curves.indexOf(curve));
      const width = curve.dots ? 5 : strong ? 3 : strong === false ? 1.4 : 1.8;
      const [{ stroke, ...dash }, opacity] = [style(curve, figure), strong === false ? FAINT : 1];
      const line = s('path', { d: path(own, curve.dots), fill: 'none', stroke, ...dash, 'stroke-width': width, 'stroke-opacity': opacity, 'stroke-linejoin': 'round', 'stroke-linecap': curve.dots ? 'round' : 'butt' });
      const seen = curve.dots || curve.x.length <= FEW ? [] : heads(inside(own, out, panel), right - left, panel.curves.length);
      const leaves = panel.clipped ? leaving(own, panel).map((corners) => s('polygon', { points: corners.map(([u, v]) => `${clamp(u)},${clamp(v)}`).join(' '), fill: stroke, class: 'leaving' })) : [];
      if (curve.runs && !curve.dots && curve.x.length <= FEW) marked.push(...inside(own, out, panel).flat().map(([u, v]) => s('circle', { cx: clamp(u), cy: clamp(v), r: 3, fill: stroke, 'fill-opacity': opacity, class: 'run' })));
      return [line, ...leaves, ...seen.map((head) => s('polygon', { points: head.map(([u, v]) => `${clamp(u)},${clamp(v)}`).join(' '), fill: stroke, opacity }))];
    });
    svg.append(s('g', { 'clip-path': `url(#${id})` }, ...lines), ...marked);
    const own = panel.curves.filter((curve) => !curve.right);
    const upright = label(said(figure.y || named(own, out.panels.length > 1 ? BESIDE : SPACE), panel.y, panel.unit), 0, 0, 'middle');
    upright.setAttribute('transform', `translate(12 ${top + height / 2}) rotate(-90)`);
    svg.append(upright);
    if (panel.right && figure.right) {
      for (const { at, text: tick } of panel.right.ticks(height)) svg.append(label(tick, right + 7, top + (1 - panel.right.part(at)) * height + 4, 'start'));
      svg.append(s('path', { d: `M${right} ${top}V${top + height}`, stroke: 'var(--line)' }));
      const side = label(said(figure.right.label, panel.right, figure.right.unit), 0, 0, 'middle');
      side.setAttribute('transform', `translate(${out.width - 4} ${top + height / 2}) rotate(-90)`);
      svg.append(side);
    }
  }
  svg.append(label(said(figure.x.label, out.x, figure.x.unit), (left + right) / 2, out.height - 8, 'middle'));
  return svg;
}

/** What an axis says of its curves: their names if they are few, else what they are of. */
function named(curves: Curve[], space: number): string {
  const names = [...new Set(curves.map(({ label: name }) => name))];
  const quantities = new Set(curves.map(({ quantity }) => quantity));
  if (names.length <= NAMES && names.join(', ').length <= space) return names.join(', ');
  return quantities.size === 1 ? [...quantities][0]! : '';
}

function label(text: string, x: number, y: number, anchor: string): SVGTextElement {
  return s('text', { x, y, 'text-anchor': anchor, fill: 'var(--soft)', 'font-size': 12 }, text);
}
