// A figure that can be looked at closely: a cursor with values, zoom, a logarithmic axis, and the time of the motion.

import type { Clock } from '../clock';
import { button, h, icon, s } from '../dom';
import { pretty, words } from '../numbers';
import { type Curve, type Layout, type View, axisOf, below, color, draw, layout, readOf, style } from './chart';
import { PAPER } from '../paper';
import type { Plot } from '../types';
import type { Drawable } from './curves';
import { saveCsv, saveSvg } from './export';

/** Entries of a legend from which on they stand close, and that are all in view. */
const DENSE = 8;
const MANY = 16;
/** Letters of a value, and the width of a letter, em. */
const VALUE = 9;
const LETTER = 0.52;
/** Pixels of a drag that is no click. */
const DRAG = 5;

/** What a reader has chosen in a figure. */
export interface PlotKept { view: View; hidden: string[] }

export class PlotView {
  readonly element: HTMLElement;
  private readonly stage = h('div', { class: 'plot-stage', tabindex: 0, role: 'group' });
  private readonly entries: HTMLElement[] = [];
  private readonly values: HTMLElement[] = [];
  private readonly note = h('p', { class: 'note', role: 'status', hidden: true });
  /** The run of a sweep that is looked at. */
  private run: number | null = null;
  private view: View = { width: 0, log: false, x: null, y: null };
  private place!: Layout;
  private overlay!: SVGGElement;
  /** A place on the horizontal axis at which the values are shown; none: at the time of the motion. */
  private cursor: number | null = null;
  private onPaper = false;

  /** Whether what is drawn is out of date, and whether it is in view or near. */
  private stale = false;
  private near = true;

  constructor(private of: Drawable, readonly plot: Plot, private readonly study: string, private readonly clock: Clock, remove?: () => void, kept?: PlotKept) {
    const { figure, name } = of;
    const keeper = new IntersectionObserver(([seen]) => {
      this.near = seen?.isIntersecting ?? true;
      if (this.near) this.refresh();
    }, { rootMargin: '200px' });
    if (kept) this.view = { ...kept.view, width: 0 };
    for (const curve of figure.curves) if (kept?.hidden.includes(curve.label)) curve.shown = false;
    const title = words(name);
    const log = button('log', `${title}: logarithmic axis`, () => {
      this.view = { ...this.view, log: !this.view.log, y: null };
      log.setAttribute('aria-pressed', String(this.view.log));
      this.draw();
    }, { 'aria-pressed': String(this.view.log) });
    const file = `${study}-${name}`;
    const tools = h('div', { class: 'tools' },
      log,
      button('whole', `${title}: whole range`, () => this.reset()),
      button('SVG', `${title}: save as SVG`, () => saveSvg(file, this.title(), this.of.figure, this.view)),
      button('CSV', `${title}: save as CSV`, () => saveCsv(file, this.of.figure)),
      remove && button(icon('M4 4l8 8M12 4l-8 8'), `${title}: remove`, remove));
    const dotted = figure.breaks.length > 0 && h('p', { class: 'dotted soft' }, 'dotted lines: switches, where a formula changes');
    this.element = h('figure', { class: 'plot card', 'data-plot': name }, h('figcaption', {}, h('h4', {}, title), tools), this.legend(), this.stage, dotted, this.note);
    this.stage.setAttribute('aria-label', `${title}; arrow keys move the cursor, + and − zoom, escape shows the whole range`);
    this.listen();
    new ResizeObserver(() => this.fit()).observe(this.stage);
    keeper.observe(this.element);
  }

  /** Takes the figure computed anew, and draws it if it is in view; false if it has other curves. */
  update(of: Drawable): boolean {
    const same = (a: Curve, b: Curve | undefined) => a.label === b?.label && a.unit === b.unit;
    const [before, next] = [this.of.figure.curves, of.figure.curves];
    if (before.length !== next.length || !before.every((curve, k) => same(curve, next[k]))) return false;
    next.forEach((curve, k) => (curve.shown = before[k]!.shown));
    this.of = of;
    this.stale = true;
    if (this.near) this.refresh();
    return true;
  }

  /** Draws what is out of date; tells whether there was anything to draw. */
  refresh(): boolean {
    const { stale } = this;
    if (stale) this.draw();
    return stale;
  }

  /** The name of the figure, and what a reader has chosen in it. */
  keep(): [string, PlotKept] {
    const hidden = this.of.figure.curves.filter((curve) => !curve.shown).map((curve) => curve.label);
    return [this.of.name, { view: this.view, hidden }];
  }

  /** Draws the time of the motion. */
  tick(): void {
    if (this.overlay && !this.stale && this.cursor === null) this.mark();
  }

  /** Draws the curves of a run strong, the others faint. */
  choose(run: number): void {
    this.run = run;
    const { runs } = this.of;
    if (new Set(runs).size < 2) return;
    this.entries.forEach((entry, k) => entry.classList.toggle('strong', runs[k] === run));
    this.stale = true;
    if (this.near) this.refresh();
  }

  /** How the figure is seen, with the run that is looked at. */
  private look(): View {
    const { runs } = this.of;
    const several = this.run !== null && runs.includes(this.run) && new Set(runs).size > 1;
    return several ? { ...this.view, strong: (k) => runs[k] === undefined || runs[k] === this.run } : this.view;
  }

  /** Tells what an axis leaves out. */
  private tellBelow(): void {
    const count = this.view.log ? below(this.of.figure, this.place) : 0;
    const clipped = this.place.panels.some((panel) => panel.clipped);
    const { curves } = this.of.figure;
    this.note.hidden = count === 0 && !clipped;
    this.note.textContent = count === 0 ? (clipped ? `arrows: without bound${curves.some(({ dead }) => dead) ? ' towards a dead point' : ''}` : '') : `${count} ${count === 1 ? 'value' : 'values'} ≤ 0 ${count === 1 ? 'is' : 'are'} not shown on the logarithmic axis`;
  }

  private title(): string {
    return `${this.study}: ${words(this.of.name)}`;
  }

  private legend(): HTMLElement {
    const { curves } = this.of.figure;
    const entries = curves.map((curve, k) => {
      const value = h('output', { class: 'value' });
      this.values.push(value);
      const line = s('svg', { width: 22, height: 8, 'aria-hidden': 'true' },
        s('path', { d: curve.dots ? 'M4 4h0M11 4h0M18 4h0' : 'M1 4h20', ...style(curve, this.of.figure), 'stroke-width': curve.dots ? 5 : 2.4, 'stroke-linecap': curve.dots ? 'round' : 'butt' }));
      const entry = h('button', { type: 'button', 'aria-pressed': String(curve.shown), title: 'show or hide', click: () => {
        const own = this.of.figure.curves[k]!;
        own.shown = !own.shown;
        entry.setAttribute('aria-pressed', String(own.shown));
        this.draw();
      } }, line, h('span', {}, curve.right ? `${curve.label} (right)` : curve.label), value);
      this.entries.push(entry);
      return entry;
    });
    const legend = h('div', { class: `legend${curves.length >= DENSE ? ' dense' : ''}${curves.length > MANY ? ' many' : ''}` }, ...entries);
    const most = (texts: string[]) => Math.max(0, ...texts.map(({ length }) => length));
    const [name, value] = [most(curves.map(({ label }) => label)), VALUE + most(curves.map(({ unit }) => pretty(unit)))];
    legend.style.setProperty('--entry', `calc(${LETTER * (name + value)}em + 42px)`);
    legend.style.setProperty('--name', `${LETTER * name}em`);
    return legend;
  }

  /** Draws for paper, in the width of its column there, or for the screen again. */
  paper(on: boolean): void {
    this.onPaper = on;
    this.fit();
  }

  private fit(): void {
    const width = this.onPaper ? PAPER.column : Math.round(this.stage.clientWidth);
    if (width > 0 && width !== this.view.width) {
      this.view.width = width;
      this.draw();
    }
  }

  private draw(): void {
    if (this.view.width === 0) return;
    this.stale = false;
    this.place = layout(this.of.figure, this.view);
    const svg = draw(this.of.figure, this.look(), this.place, this.title());
    this.tellBelow();
    this.overlay = s('g', { class: 'overlay' });
    svg.append(this.overlay);
    this.stage.replaceChildren(svg);
    this.mark();
  }

  private reset(): void {
    this.view = { ...this.view, x: null, y: null };
    this.draw();
  }

  /** Draws the cursor, or the time, and writes the values there. */
  private mark(): void {
    const { figure, moves, points, size } = this.of;
    const { left, right, x: across, panels } = this.place;
    const u = (x: number) => left + across.part(x) * (right - left);
    const at = this.cursor ?? (moves ? this.clock.at / size : null);
    this.overlay.replaceChildren();
    const inside = at !== null && across.part(at) >= -1e-9 && across.part(at) <= 1 + 1e-9;
    const last = panels[panels.length - 1];
    if (inside && last && figure.ordered) {
      const line = { x1: u(at), x2: u(at), y1: panels[0]!.top, y2: last.top + last.height, stroke: 'var(--accent)', 'stroke-width': this.cursor === null ? 1.4 : 1, 'stroke-dasharray': this.cursor === null ? 'none' : '3 3', class: 'now', 'data-at': at };
      this.overlay.append(s('line', line));
    }
    figure.curves.forEach((curve, k) => {
      const point = this.point(k, at, points);
      const panel = panels.find((p) => p.curves.includes(curve));
      this.values[k]!.textContent = point && Number.isFinite(point[1]) ? readOf(this.place, curve, point[1]) : '';
      if (!point || !panel || !Number.isFinite(point[0] + point[1])) return;
      const [px, py] = [across.part(point[0]), axisOf(panel, curve).part(point[1])];
      if (!(px >= -1e-9 && px <= 1 + 1e-9 && py >= -1e-9 && py <= 1 + 1e-9)) return;
      this.overlay.append(s('circle', { cx: u(point[0]), cy: panel.top + (1 - py) * panel.height, r: 3.6, fill: color(curve, figure), stroke: 'var(--paper)', 'stroke-width': 1.4 }));
    });
  }

  /** The point of a curve at the cursor or at the time. */
  private point(k: number, at: number | null, points: Drawable['points']): [number, number] | null {
    const { figure, moves, size } = this.of;
    const own = points[k];
    if (own && (moves ? at !== null : this.cursor === null)) return own(moves ? at! * size : this.clock.at);
    if (at === null) return null;
    // numbers of whole runs, and paths: the nearest point
    const { x, y } = figure.curves[k]!;
    let [best, off] = [-1, Infinity];
    x.forEach((value, i) => {
      if (Math.abs(value - at) < off && Number.isFinite(y[i]!)) [best, off] = [i, Math.abs(value - at)];
    });
    return best < 0 ? null : [x[best]!, y[best]!];
  }

  /** The part of the horizontal axis under a pointer, and of the vertical one of the first panel. */
  private under(event: PointerEvent | MouseEvent): [number, number] {
    const box = this.stage.getBoundingClientRect();
    const { left, right, panels } = this.place;
    const panel = panels[0]!;
    const part = (event.clientX - box.left - left) / (right - left);
    return [Math.min(Math.max(part, 0), 1), 1 - (event.clientY - box.top - panel.top) / panel.height];
  }

  private listen(): void {
    let from: [number, number] | null = null;
    let began = 0;
    const { stage } = this;
    stage.addEventListener('pointerdown', (event) => {
      if (event.button !== 0 || event.pointerType === 'touch') return;
      [from, began] = [this.under(event), event.clientX];
      stage.setPointerCapture(event.pointerId);
    });
    stage.addEventListener('pointermove', (event) => {
      const here = this.under(event);
      this.cursor = this.place.x.value(here[0]);
      this.mark();
      if (from && Math.abs(event.clientX - began) > DRAG) this.overlay.append(this.band(from, here));
    });
    stage.addEventListener('pointerup', (event) => {
      const here = this.under(event);
      if (from && Math.abs(event.clientX - began) > DRAG) this.zoom(from, here);
      else this.seek(this.place.x.value(here[0]));
      from = null;
    });
    stage.addEventListener('pointerleave', () => {
      this.cursor = null;
      this.mark();
    });
    stage.addEventListener('dblclick', () => this.reset());
    stage.addEventListener('blur', () => {
      this.cursor = null;
      this.mark();
    });
    stage.addEventListener('keydown', (event) => this.key(event));
  }

  private seek(x: number): void {
    if (this.of.moves) this.clock.seek(x * this.of.size);
  }

  private band(a: [number, number], b: [number, number]): SVGRectElement {
    const { left, right, panels } = this.place;
    const [low, high] = [Math.min(a[0], b[0]), Math.max(a[0], b[0])];
    const last = panels[panels.length - 1]!;
    const whole = this.of.figure.ordered;
    const panel = panels[0]!;
    const [top, bottom] = whole ? [panel.top, last.top + last.height] : [panel.top + (1 - Math.max(a[1], b[1])) * panel.height, panel.top + (1 - Math.min(a[1], b[1])) * panel.height];
    return s('rect', { x: left + low * (right - left), width: (high - low) * (right - left), y: top, height: bottom - top, fill: 'var(--accent)', opacity: 0.14 });
  }

  private zoom(a: [number, number], b: [number, number]): void {
    const { x, panels } = this.place;
    const sorted = (p: number, q: number): [number, number] => [Math.min(p, q), Math.max(p, q)];
    const range = sorted(x.value(a[0]), x.value(b[0]));
    const own = panels[0]!.y;
    this.view = { ...this.view, x: range, y: this.of.figure.ordered ? null : sorted(own.value(a[1]), own.value(b[1])) };
    this.draw();
  }

  private key(event: KeyboardEvent): void {
    const { x } = this.place;
    const range = x.high - x.low;
    const at = this.cursor ?? (this.of.moves ? this.clock.at / this.of.size : (x.low + x.high) / 2);
    const move = { ArrowLeft: -0.01, ArrowRight: 0.01, PageUp: -0.1, PageDown: 0.1 }[event.key];
    if (move) {
      this.cursor = Math.min(Math.max(at + move * range, x.low), x.high);
      this.mark();
    } else if (event.key === 'Enter') this.seek(at);
    else if (event.key === '+' || event.key === '-') {
      const half = (range / 2) * (event.key === '+' ? 0.7 : 1.4);
      this.view = { ...this.view, x: [at - half, at + half] };
      this.draw();
    } else if (event.key === 'Escape') this.reset();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
