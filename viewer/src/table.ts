// Tables that can be sorted and saved; of long ones only the rows in view are made.

import { button, h, save } from './dom';
import { digits, heading, shownIn } from './numbers';
import type { Column, Num } from './types';

const ROW = 26;
const IN_VIEW = 14;
/** Rows beside those in view that are made. */
const MORE = 10;

export interface Extra { name: string; values: string[] }

/** A table of columns; `extra` are columns of words behind them. */
export function table(title: string, file: string, columns: Column[], extra: Extra[] = []): HTMLElement {
  const count = columns[0]?.values.length ?? extra[0]?.values.length ?? 0;
  const shown = columns.map((column) => ({ ...shownIn(column), column }));
  const heads = [...shown.map(({ column, unit }) => heading(column.name, unit)), ...extra.map((e) => e.name)];
  const number = (k: number, row: number): Num => {
    const value = shown[k]?.column.values[row];
    return value === null || value === undefined ? null : value / shown[k]!.size;
  };
  const word = (k: number, row: number) => extra[k - shown.length]?.values[row] ?? '';
  let order = Array.from({ length: count }, (_, i) => i);
  let sorted: { k: number; down: boolean } | null = null;

  const body = h('tbody');
  const [before, behind] = [h('tr', { 'aria-hidden': 'true' }), h('tr', { 'aria-hidden': 'true' })];
  const box = h('div', { class: 'rows', tabindex: 0, role: 'region', 'aria-label': title });
  const fill = () => {
    const from = Math.max(0, Math.floor(box.scrollTop / ROW) - MORE);
    const to = Math.min(count, from + IN_VIEW + 2 * MORE);
    before.style.height = `${from * ROW}px`;
    behind.style.height = `${(count - to) * ROW}px`;
    body.replaceChildren(before, ...order.slice(from, to).map((row, i) =>
      h('tr', { 'aria-rowindex': from + i + 2 }, ...heads.map((_, k) =>
        k < shown.length ? h('td', {}, digits(number(k, row), 7)) : h('td', { class: 'word' }, word(k, row))))), behind);
  };
  const sort = (k: number) => {
    sorted = sorted?.k === k ? (sorted.down ? null : { k, down: true }) : { k, down: false };
    order = Array.from({ length: count }, (_, i) => i);
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
    cells.forEach((cell, i) => cell.setAttribute('aria-sort', sorted?.k === i ? (sorted.down ? 'descending' : 'ascending') : 'none'));
    fill();
  };
  const cells = heads.map((text, k) => h('th', { scope: 'col', 'aria-sort': 'none' }, h('button', { type: 'button', title: 'sort', click: () => sort(k) }, text)));
  box.append(h('table', { 'aria-rowcount': count + 1 }, h('thead', {}, h('tr', {}, ...cells)), body));
  box.addEventListener('scroll', fill);
  fill();
  const csv = () => {
    const quoted = (text: string) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
    const line = (row: number) => heads.map((_, k) => (k < shown.length ? String(number(k, row) ?? '') : quoted(word(k, row)))).join(',');
    save(`${file}.csv`, [heads.map(quoted).join(','), ...order.map(line)].join('\n') + '\n', 'text/csv');
  };
  const tools = h('div', { class: 'tools' }, button('CSV', `${title}: save as CSV`, csv));
  return h('div', { class: 'table' }, h('div', { class: 'head' }, h('h3', {}, title), tools), box);
}

/** A small table as it is: heads and rows of texts; of lists lines may be broken. */
export function plain(heads: string[], rows: (string | Node)[][], wrap = false): HTMLElement {
  return h('div', { class: wrap ? 'rows short wrap' : 'rows short' }, h('table', {},
    h('thead', {}, h('tr', {}, ...heads.map((text) => h('th', { scope: 'col' }, text)))),
    h('tbody', {}, ...rows.map((row) => h('tr', {}, ...row.map((cell, k) => (k === 0 ? h('th', { scope: 'row' }, cell) : h('td', {}, cell))))))));
}
