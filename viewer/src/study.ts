// A study in view: its stage, what it has come to, its figures and tables.

import type { Clock } from './clock';
import { column } from './curves';
import { h } from './dom';
import { type ShowPlace, facts, rowsInWords } from './facts';
import { coded, heading, pretty, shownIn } from './numbers';
import { drawable, isPath } from './plot/curves';
import { type PlotKept, PlotView } from './plot/plot';
import { Stage, type StageKept } from './stage';
import { table } from './table';
import type { Column, Plot, Results, Study } from './types';

/** What a reader has chosen in a study: it stays when the study is computed again. */
export interface Kept {
  stage: StageKept | undefined;
  plots: Map<string, PlotKept>;
  own: Plot[];
  /** Parts by their titles, and whether they are open. */
  open: Map<string, boolean>;
  scrolled: number[];
}

/** Milliseconds until what is out of view is made anew. */
const REST = 20;

/** Its kind, the variants of the model, and how many runs it has. */
function whatItIs({ kind, variants, table, runs }: Study): string {
  const which = variants.length > 0 ? [`variant${variants.length > 1 ? 's' : ''} ${variants.join(', ')}`] : [];
  return [kind, ...which, ...(table.reasons ? [`${runs.length} runs`] : [])].join(', ');
}

/** What a page of a study is made of, but for numbers: while it is the same, the page stays. */
function skeleton(study: Study): string {
  const of = ({ independent, table, curves }: Results) => [independent.name, independent.unit, independent.values.length > 1, [...table.columns, ...curves].map(({ name, unit, shown_in }) => [name, unit, shown_in?.unit])];
  return JSON.stringify([whatItIs(study), of(study), study.plots, study.table.reasons !== null, study.runs.map(({ results }) => results && of(results))]);
}

const parts = (of: HTMLElement) => [...of.querySelectorAll<HTMLDetailsElement>('details.part')];
const title = (part: HTMLDetailsElement) => part.querySelector('summary')?.textContent ?? '';

export class StudyView {
  readonly element: HTMLElement;
  readonly stage: Stage;
  private readonly plots: PlotView[] = [];
  private readonly figures = h('div', { class: 'plots' });
  private readonly rows = h('div', { class: 'tables card' });
  private readonly own: Plot[];
  private count = 0;

  private facts: HTMLElement;
  private readonly about = h('p', { class: 'about' });
  /** The run whose rows are in the table. */
  private run: number | null = null;
  private later = 0;
  private frame = 0;

  constructor(private study: Study, private readonly clock: Clock, private readonly show: ShowPlace, private readonly kept?: Kept) {
    this.stage = new Stage(study, clock, (run) => this.choose(run), kept?.stage);
    this.own = kept?.own ?? [];
    this.count = this.own.length;
    study.plots.forEach((plot) => this.add(plot));
    this.own.forEach((plot) => this.add(plot, true));
    this.facts = facts(study, show);
    this.tellAbout();
    this.element = h('article', { class: 'study', 'aria-labelledby': 'study-title' },
      h('header', { class: 'title' },
        h('p', { class: 'kind' }, whatItIs(study)),
        h('h2', { id: 'study-title', tabindex: -1 }, study.study),
        this.about),
      // beside figures results stand below the mechanism, else beside it
      h('div', { class: 'left' }, this.stage.element, this.plots.length > 0 && this.facts),
      h('div', { class: 'right' }, this.plots.length === 0 && this.facts, this.figures, this.chooser(), this.rows));
    this.tables(study.table.reasons ? null : study);
    for (const part of parts(this.element)) part.open = kept?.open.get(title(part)) ?? part.open;
  }

  /** Takes the study computed anew: what is in view at once, the rest when there is time. False if it has other parts than before. */
  update(study: Study): boolean {
    if (skeleton(study) !== skeleton(this.study)) return false;
    const drawn = this.plots.map((view) => drawable(study, view.plot));
    if (drawn.some((one) => one === null) || !this.stage.update(study)) return false;
    this.study = study;
    if (!this.plots.every((view, k) => view.update(drawn[k]!))) return false;
    this.tellAbout();
    this.tellFacts();
    this.after(() => this.rest());
    return true;
  }

  /** Does something once the browser has shown what there is. */
  private after(work: () => void): void {
    clearTimeout(this.later);
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => (this.later = window.setTimeout(work, REST)));
  }

  /** What waits until the picture is there: rows, then figures out of view, one after the other. */
  private rest(): void {
    const scrolled = [...this.rows.querySelectorAll('.rows')].map((box) => box.scrollTop);
    const { study } = this;
    const run = this.run === null ? undefined : study.runs[this.run];
    this.tables(study.table.reasons ? (run?.results ?? null) : study, run?.label);
    this.rows.querySelectorAll('.rows').forEach((box, i) => (box.scrollTop = scrolled[i] ?? 0));
    const next = () => {
      if (this.plots.find((plot) => plot.refresh())) this.after(next);
    };
    this.after(next);
  }

  /** What it has come to, with the parts open that are open. */
  private tellFacts(): void {
    const open = new Map(parts(this.facts).map((part) => [title(part), part.open]));
    const next = facts(this.study, this.show, this.run === null ? undefined : this.study.runs[this.run]);
    for (const part of parts(next)) part.open = open.get(title(part)) ?? part.open;
    this.facts.replaceWith(next);
    this.facts = next;
  }

  private tellAbout(): void {
    this.about.replaceChildren(...coded(this.study.about).filter((part) => part !== ''));
    this.about.hidden = this.study.about === '';
  }

  /** What a reader has chosen. */
  keep(): Kept {
    const open = new Map(parts(this.element).map((part) => [title(part), part.open]));
    const scrolled = [...this.rows.querySelectorAll('.rows')].map((box) => box.scrollTop);
    return { stage: this.stage.keep(), plots: new Map(this.plots.map((plot) => plot.keep())), own: this.own, open, scrolled };
  }

  /** Tables stand where they stood; once the study is on the page. */
  scroll(): void {
    this.rows.querySelectorAll('.rows').forEach((box, i) => (box.scrollTop = this.kept?.scrolled[i] ?? 0));
  }

  tick(): void {
    this.stage.tick();
    this.plots.forEach((plot) => plot.tick());
  }

  /** Draws all for paper, or for the screen again. */
  paper(on: boolean): void {
    this.stage.paper(on);
    this.plots.forEach((plot) => plot.paper(on));
  }

  private add(plot: Plot, own = false): void {
    const drawn = drawable(this.study, plot);
    if (!drawn) return;
    const view: PlotView = new PlotView(drawn, plot, this.study.study, this.clock, own ? () => {
      this.plots.splice(this.plots.indexOf(view), 1);
      this.own.splice(this.own.indexOf(plot), 1);
      view.element.remove();
    } : undefined, this.kept?.plots.get(plot.name));
    if (this.run !== null) view.choose(this.run);
    this.plots.push(view);
    this.figures.append(view.element);
  }

  /** Results whose columns can be drawn. */
  private source(): Results {
    return this.study.table.reasons ? (this.study.runs.find((run) => run.results?.independent.values.length)?.results ?? this.study) : this.study;
  }

  /** A figure of columns that the reader chooses. */
  private chooser(): HTMLElement | null {
    const results = this.source();
    const of = [...results.table.columns, ...results.curves];
    const runs = this.study.table.reasons ? this.study.table.columns : [];
    if (of.length + runs.length === 0 || (runs.length === 0 && results.independent.values.length < 2)) return null;
    const options = (columns: Column[], kind: string) => columns.map((c) => h('option', { value: `${kind}${c.name}` }, heading(c.name, shownIn(c).unit)));
    const show = h('select', { 'aria-label': 'column to draw' }, ...options(of, 'c:'), ...(runs.length > 1 ? [h('optgroup', { label: 'of each run' }, ...options(runs, 'r:'))] : []));
    // the variable itself over itself is no figure
    if (of.length > 1 && of[0]!.name === results.independent.name) show.selectedIndex = 1;
    const over = h('select', { 'aria-label': 'drawn over' }, h('option', { value: '' }, results.independent.name || runs[0]?.name || ''), ...options(of, ''));
    const draw = () => {
      const [kind, name] = [show.value.slice(0, 2), show.value.slice(2)];
      const horizontal = kind === 'r:' || over.value === '' || !column(this.source(), over.value) ? null : over.value;
      const plot = { name: `${name}${horizontal ? ` over ${horizontal}` : ''}${this.count++ > 0 ? ` (${this.count})` : ''}`, show: [name], over: horizontal, unit: null, of_runs: kind === 'r:', path: isPath(name, horizontal), range: [null, null] as [null, null], y: null, right: null, beside: [] };
      this.own.push(plot);
      this.add(plot, true);
    };
    return h('div', { class: 'chooser card' }, h('label', {}, 'Draw ', show), h('label', {}, ' over ', over), h('button', { type: 'button', class: 'primary', click: draw }, 'Add figure'));
  }

  private choose(run: number): void {
    this.run = run;
    this.plots.forEach((plot) => plot.choose(run));
    this.tellFacts();
    this.tables(this.study.runs[run]?.results ?? null, this.study.runs[run]?.label);
  }

  /** The table of the runs of a sweep, and the rows of one study or run. */
  private tables(results: Results | null, label = ''): void {
    const { study } = this;
    const parts: HTMLElement[] = [];
    if (study.table.reasons) {
      const reasons = study.table.reasons;
      parts.push(table('Runs', study.study, study.table.columns, reasons.some((r) => r !== '') ? [{ name: 'remark', values: reasons }] : []));
    }
    if (results && results.independent.values.length > 0) {
      const { independent } = results;
      // one position has no place along a motion
      const own = results.table.columns.some((c) => c.name === independent.name) || (independent.values.length === 1 && results.table.columns.length > 0);
      const columns = own ? results.table.columns : [independent, ...results.table.columns];
      const rows = table(label ? `Rows, ${pretty(label)}` : 'Rows', `${study.study}-rows`, columns, [], results.rows?.breaks);
      const note = rowsInWords(results);
      if (note) rows.append(h('p', { class: 'note' }, note));
      parts.push(rows);
    }
    this.rows.replaceChildren(...parts);
    this.rows.hidden = parts.length === 0;
  }
}
