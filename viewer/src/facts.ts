// What a study has come to beside its rows: scalars, extremes, findings, the certificate, events, lists, matrices.

import { type Child, h } from './dom';
import { broken, coded, digits, heading, hinted, pretty, shownIn, valued } from './numbers';
import { plain } from './table';
import type { Certificate, Column, Fault, Finding, Num, Results, Run, Scalar, Solution, Statistics, Study } from './types';

/** Part of the largest number of a list below which another is nothing but rounding. */
const NOTHING = 1e-14;

export type ShowPlace = (place: string) => void;

/** A part of a study with its heading; none without content. */
function part(title: string, open: boolean, ...content: Child[]): HTMLElement | null {
  if (content.every((child) => !child)) return null;
  return h('details', { class: 'part', ...(open ? { open: true } : {}) }, h('summary', {}, title), ...content);
}

/** Names and values, one below the other. */
function list(entries: [string, Child][]): HTMLElement {
  return h('dl', { class: 'values' }, ...entries.map(([name, value]) => h('div', {}, h('dt', {}, ...broken(name)), h('dd', {}, value))));
}

function scalars(all: Scalar[]): HTMLElement | null {
  if (all.length === 0) return null;
  return list(all.map((scalar) => {
    const { text, full, unit } = valued(scalar, scalar.value);
    const value = `${text} ${unit}`.trim();
    return [scalar.name, text === full ? value : h('span', { title: `${full} ${unit}`.trim() }, value)];
  }));
}

function solution(solved: Solution | null): HTMLElement | null {
  if (!solved) return null;
  const { text, full, unit } = valued(solved.parameter, solved.parameter.value);
  return h('p', { class: 'lead' }, 'solved: ', h('strong', { title: `${full} ${unit}`.trim() }, `${solved.parameter.name} = ${text} ${unit}`.trim()),
    `, with which ${solved.of} is `, hinted(solved.found), ` (${solved.runs} runs)`);
}

/** A button that leads to a place of the model file. */
function link(place: string, show: ShowPlace): HTMLElement | null {
  return place === '' ? null : h('button', { type: 'button', class: 'place', title: 'show in the model file', click: () => show(place) }, place);
}

/** Why a study has no results. */
export function faults(all: Fault[], show: ShowPlace): HTMLElement {
  const entry = ({ message, place, help }: Fault) =>
    h('li', { class: 'bad' }, h('span', {}, ...coded(message)), ' ', link(place, show), help !== '' && h('p', { class: 'help soft' }, 'help: ', ...coded(help)));
  return h('ul', { class: 'findings' }, ...all.map(entry));
}

/** Findings that say that the numbers of a motion are wrong by more than they should be: `Finding::is_warning` of the program. */
const WARNINGS = ['energy', 'open-constraints'];

/** Why it stopped, which expectations are not met, and what was found, warnings first. */
function findings(results: Results, show: ShowPlace): HTMLElement | null {
  const entry = (kind: string, message: string, place: string) => h('li', { class: kind }, kind === 'warning' && h('strong', {}, 'warning: '), h('span', {}, ...coded(message)), ' ', link(place, show));
  const found = [...results.findings, ...(results.solution?.findings ?? [])];
  const warns = (f: Finding) => WARNINGS.includes(f.code);
  const all = [
    ...(results.stopped ? [entry('bad', results.stopped, results.undefined?.place || results.place)] : []),
    ...results.expectations.filter((e) => !e.met).map((e) => entry('bad', e.message, e.place)),
    ...found.filter(warns).map((f) => entry('warning', f.message, f.path)),
    ...found.filter((f) => !warns(f)).map((f) => entry('', f.message, f.path)),
  ];
  return all.length === 0 ? null : h('ul', { class: 'findings' }, ...all);
}

function extremes(results: Results): HTMLElement | null {
  const columns = new Map(results.table.columns.map((c) => [c.name, c]));
  const place = shownIn(results.independent);
  const rows = results.extremes.flatMap(([name, both]) => {
    const column: Column | undefined = columns.get(name);
    if (!both || !column) return [];
    const { unit, size } = shownIn(column);
    const { min, max } = both;
    const value = (x: number | null) => hinted(x === null ? null : x / size);
    const at = (x: number | null) => hinted(x === null ? null : x / place.size);
    return [[heading(name, unit), value(min.value), at(min.at), value(max.value), at(max.at)]];
  });
  // of one position each number is both
  if (rows.length === 0 || results.independent.values.length === 1) return null;
  const at = heading('at', place.unit);
  return plain('Extremes', ['', 'least', at, 'greatest', at], rows);
}

function certificate(c: Certificate, results: Results): HTMLElement | null {
  const { march, resolved } = c;
  const entries: [string, string][] = [];
  if (c.evaluations > 0) entries.push(['constraints off by', digits(c.constraint, 2)]);
  if (march) {
    entries.push(
      ['energy balanced to', `${digits(march.energy_drift, 2)} of ${digits(march.energy_scale, 4)} J`],
      ['velocity constraints off by', digits(march.velocity, 2)],
      ['integrator', march.tolerance === null ? march.schemes : `${march.schemes}, tolerance ${digits(march.tolerance, 2)}`],
      ['steps', `${march.counts.steps} (${march.counts.rejected} rejected), ${march.counts.evaluations} evaluations`],
    );
    for (const name of ['drivers', 'loads', 'dampers', 'stops', 'impacts'] as const) {
      if (Math.abs(march[name] ?? 0) > 1e-12 * (march.energy_scale ?? 0)) entries.push([`work of ${name}`, `${digits(march[name], 7)} J`]);
    }
    if (march.counts.events) entries.push(['events located', String(march.counts.events)]);
  } else if (c.evaluations > 0 && ['inverse', 'kinematics', 'balance'].includes(results.kind)) entries.push(['power balanced to', digits(c.power_balance, 2)]);
  if (resolved) entries.push(['columns resolved to', digits(resolved.width, 2) + (resolved.open > 0 ? `, but for ${resolved.open}` : '')]);
  if (c.switches > 0) entries.push(['switches located', String(c.switches)]);
  const expected = results.expectations.length;
  if (expected > 0) entries.push(['expectations met', `${results.expectations.filter((e) => e.met).length} of ${expected}`]);
  return entries.length === 0 ? null : list(entries);
}

/** How the numbers of drawn runs are distributed, and what has a part in their variance. */
function distributions(study: Study): Child[] {
  const row = (s: Statistics) => {
    const { unit, size } = shownIn(s);
    const values = [s.mean, s.deviation, ...s.percentiles, ...s.range];
    return [heading(s.name, unit), ...values.map((x) => hinted(x === null ? null : x / size))];
  };
  const varied = study.statistics.filter((s) => s.parts.length > 0);
  const parameters = varied[0]?.parts.map((p) => p.parameter) ?? [];
  const share = (x: number | null) => (x === null ? '' : `${digits(Math.round(1000 * x) / 10 + 0, 4)} %`);
  return [
    study.statistics.length === 0 ? null : plain('Distribution', ['', 'mean', 'deviation', '5 %', '25 %', '50 %', '75 %', '95 %', 'least', 'most'], study.statistics.map(row)),
    varied.length === 0 ? null : h('h4', {}, 'Shares of the variance'),
    varied.length === 0 ? null : plain('Shares of the variance', ['', ...parameters], varied.map((s) => [s.name, ...s.parts.map((p) => share(p.share))])),
  ];
}

/** A number; what is nothing beside numbers of a size `most` is 0. */
function sized(v: Num, most: number): Child {
  return v !== null && v !== 0 && Math.abs(v) < NOTHING * most ? h('span', { title: digits(v) }, '0') : hinted(v);
}

/** The largest magnitude of some numbers. */
function largest(values: Num[]): number {
  return Math.max(0, ...values.map((v) => Math.abs(v ?? 0)));
}

/** Numbers of one quantity; what is nothing beside the largest of them is 0. */
function beside(values: Num[]): Child[] {
  const most = largest(values);
  return values.map((v) => sized(v, most));
}

/** The entries of a matrix by rows; what is nothing beside the largest of its row and of its column, which have units of their own, is 0. */
function cells(matrix: Num[][]): Child[][] {
  const columns = (matrix[0] ?? []).map((_, k) => largest(matrix.map((row) => row[k] ?? null)));
  return matrix.map((row) => {
    const most = largest(row);
    return row.map((v, k) => sized(v, Math.min(most, columns[k] ?? 0)));
  });
}

/** What the lists of a kind of study are of. */
function listed(kind: string): string {
  return ({ statics: 'Equilibria', linearize: 'Poles', periodic: 'Multipliers' } as Record<string, string>)[kind] ?? 'Modes';
}

function lists(results: Results): Child[] {
  const all = results.lists.map(({ name, unit, shown_in = null, values }) => {
    const shown = shownIn({ unit, shown_in });
    const numbers = beside(values.map((v) => (v === null ? null : v / shown.size)));
    return [heading(name, shown.unit), h('span', {}, ...numbers.flatMap((text, i) => (i > 0 ? [',  ', text] : [text])))];
  });
  const shapes = results.shapes.map((shape, k) => [`shape ${k + 1}`, shape.join(',  ').replace(/ -(?=\d)/g, ' −')]);
  return all.length + shapes.length > 0 ? [plain(listed(results.kind), ['', 'values'], [...all, ...shapes], true)] : [];
}

function matrices(results: Results): Child[] {
  const { linear } = results;
  if (!linear) return [];
  const heads: Record<string, string[]> = { A: linear.states, C: linear.states, B: linear.inputs, D: linear.inputs };
  const rows: Record<string, string[]> = { A: linear.states, B: linear.states, C: linear.outputs, D: linear.outputs };
  return linear.matrices.filter(([, m]) => m.length > 0 && (m[0]?.length ?? 0) > 0).flatMap(([name, matrix]) => [
    h('h4', {}, name),
    plain(`Matrix ${name}`, ['', ...(heads[name] ?? linear.coordinates)], cells(matrix).map((row, i) => [(rows[name] ?? linear.coordinates)[i] ?? '', ...row])),
  ]);
}

function events(results: Results): HTMLElement | null {
  const { independent } = results;
  const { unit, size } = shownIn(independent);
  return results.events.length === 0 ? null : plain('Events', ['event', heading('at', unit)], results.events.map((e) => [e.name, hinted(e.at === null ? null : e.at / size)]));
}

/** The values of the parameters: of a sweep those of the run that is shown, without one those that all of its runs have. */
function parameters(study: Study, run: Run | undefined): Child[] {
  if (run?.results) return [h('p', { class: 'note' }, `of the run ${pretty(run.label)}`), scalars(run.results.parameters)];
  const given = study.table.columns.slice(0, study.swept?.length ?? 0).map(({ name }) => name);
  return [scalars(study.parameters.filter(({ name }) => !given.includes(name)))];
}

/** All of it: first what it has come to, then the parts that can be opened; `run` is the one that is shown of a sweep. */
export function facts(study: Study, show: ShowPlace, run?: Run): HTMLElement {
  const found = findings(study, show);
  const own = study.kind === 'modes' ? study.scalars.filter((scalar) => scalar.by !== 'kind') : study.scalars;
  const rest = study.kind === 'modes' ? study.scalars.filter((scalar) => scalar.by === 'kind') : [];
  const summary = [solution(study.solution), scalars(own), found && h('div', {}, h('h3', {}, 'Findings'), found)].filter((child) => child !== null);
  return h('div', { class: 'facts card' },
    summary.length > 0 && h('div', { class: 'summary' }, ...summary),
    part('Distribution', true, ...distributions(study)),
    part(listed(study.kind), true, ...lists(study)),
    part('Results of the kind', false, scalars(rest)),
    part('Matrices', true, ...matrices(study)),
    part('Extremes', false, extremes(study)),
    part('Events', false, events(study)),
    part('Certificate', false, certificate(study.certificate, study)),
    part('Parameters', false, ...parameters(study, run)));
}

/** How much of the rows is there, in words. */
export function rowsInWords(results: Results): string {
  const { rows, independent } = results;
  const there = independent.values.length;
  if (!rows || there === 0 || there >= rows.of) return '';
  const within = digits(rows.within, 2);
  return `rows shown: ${there} of ${rows.of}, curves within ${within} of the range of their axes`;
}

