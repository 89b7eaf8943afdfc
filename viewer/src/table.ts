// Tables that can be sorted and saved; of long ones only the rows in view are made.

import { writing } from './carried';
import { type Child, button, h, save } from './dom';
import { broken, coded, heading, shownIn } from './numbers';
import type { Column, Num } from './types';
import { wide } from './wide';

const ROW = 26;
const IN_VIEW = 14;
/** Rows beside those in view that are made. */
const MORE = 10;

export interface Extra { name: string; values: string[] }
type Side = 'before' | 'after';

/** Rows on both sides of a switch, which stand at one place: which side they are on; and those that say nothing beside the one before. */
function sides(places: Num[], breaks: number[], alike: (row: number) => boolean): { of: Map<number, Side>; again: Set<number> } {
  const [of, again] = [new Map<number, Side>(), new Set<number>()];
  for (const row of breaks) {
    if (places[row] === null || places[row] !== places[row + 1]) continue;
    if (alike(row)) again.add(row + 1);
    else of.set(row, 'before').set(row + 1, 'after');
  }
  return { of, again };
}

/** A table of columns, the first of which says where its rows are; `extra` are columns of words behind them. Behind rows of `breaks` a new smooth piece begins. */
export function table(title: string, file: string, columns: Column[], extra: Extra[] = [], breaks: number[] = []): HTMLElement {
  const count = columns[0]?.values.length ?? extra[0]?.values.length ?? 0;
  const shown = columns.map((column) => {
    const { unit, size } = shownIn(column);
    return { column, unit, ...writing(column.values, size) };
  });
  const heads = [...shown.map(({ column, unit }) => heading(column.name, unit)), ...extra.map((e) => e.name)];
  const number = (k: number, row: number): Num => shown[k]?.column.values[row] ?? null;
  const text = (k: number, row: number) => shown[k]!.text(number(k, row));
  const word = (k: number, row: number) => extra[k - shown.length]?.values[row] ?? '';
  const { of: side, again } = sides(columns[0]?.values ?? [], breaks, (row) => shown.every((_, k) => text(k, row) === text(k, row + 1)));
  const all = Array.from({ length: count }, (_, i) => i).filter((row) => !again.has(row));
  let order = all;
  let sorted: { k: number; down: boolean } | null = null;

  const body = h('tbody');
  const [before, behind] = [h('tr', { 'aria-hidden': 'true' }), h('tr', { 'aria-hidden': 'true' })];
  const box = h('div', { class: 'rows', tabindex: 0, role: 'region', 'aria-label': title });
  const cell = (k: number, row: number): HTMLElement => {
    if (k >= shown.length) return h('td', { class: 'word' }, ...coded(word(k, row)));
    const here = k === 0 && side.get(row);
    return h('td', {}, here && h('span', { class: 'side', title: `just ${here} the switch` }, here), text(k, row));
  };
  const fill = () => {
    const from = Math.max(0, Math.floor(box.scrollTop / ROW) - MORE);
    const to = Math.min(order.length, from + IN_VIEW + 2 * MORE);
    before.style.height = `${from * ROW}px`;
    behind.style.height = `${(order.length - to) * ROW}px`;
    body.replaceChildren(before, ...order.slice(from, to).map((row, i) =>
      h('tr', { 'aria-rowindex': from + i + 2, class: (from + i) % 2 ? 'even' : '' }, ...heads.map((_, k) => cell(k, row)))), behind);
  };
  const sort = (k: number) => {
    sorted = sorted?.k === k ? (sorted.down ? null : { k, down: true }) : { k, down: false };
    order = [...all];
    if (sorted) {
      const sign = sorted.down ? -1 : 1;
      const compare = (a: number, b: number) => {
        if (k >= shown.length) return sign * word(k, a).localeCompare(word(k, b));
        const [x, y] = [number(k, a), number(k, b)];
        // what has no value stands last
        return x === null || y === null ? Number(x === null) - Number(y === null) : sign * (x - y);
      };
      order.sort((a, b) => compare(a, b) || a - b);
    }
    cells.forEach((head, i) => head.setAttribute('aria-sort', sorted?.k === i ? (sorted.down ? 'descending' : 'ascending') : 'none'));
    fill();
  };
  const cells = heads.map((name, k) => h('th', { scope: 'col', 'aria-sort': 'none' }, h('button', { type: 'button', title: 'sort', click: () => sort(k) }, name)));
  box.append(h('table', { 'aria-rowcount': order.length + 1 }, h('thead', {}, h('tr', {}, ...cells)), body));
  box.addEventListener('scroll', fill);
  fill();
  const csv = () => {
    const quoted = (name: string) => (/[",\n]/.test(name) ? `"${name.replace(/"/g, '""')}"` : name);
    const line = (row: number) => heads.map((_, k) => (k < shown.length ? shown[k]!.full(number(k, row)) : quoted(word(k, row)))).join(',');
    save(`${file}.csv`, [heads.map(quoted).join(','), ...order.map(line)].join('\n') + '\n', 'text/csv');
  };
  const tools = h('div', { class: 'tools' }, button('CSV', `${title}: save as CSV`, csv));
  return h('div', { class: 'table' }, h('div', { class: 'head' }, h('h3', {}, title), tools), wide(box, IN_VIEW * ROW));
}

/** A small table as it is, with a name for those who do not see it: heads and rows of texts; of lists lines may be broken. */
export function plain(title: string, heads: string[], rows: Child[][], wrap = false): HTMLElement {
  const named = (cell: Child) => h('th', { scope: 'row' }, ...(typeof cell === 'string' ? broken(cell) : [cell]));
  return wide(h('div', { class: wrap ? 'rows short wrap' : 'rows short', tabindex: 0, role: 'region', 'aria-label': title }, h('table', {},
    h('thead', {}, h('tr', {}, ...heads.map((text) => h('th', { scope: 'col' }, text)))),
    h('tbody', {}, ...rows.map((row, i) => h('tr', { class: i % 2 ? 'even' : '' }, ...row.map((cell, k) => (k === 0 ? named(cell) : h('td', {}, cell)))))))));
}
