// The text of the model file: coloured, with line numbers, and the line of a path of keys.

import { h } from './dom';

const TOKENS = /("(?:[^"\\]|\\.)*"|'(?:[^']|'')*')|((?:^|\s)#.*$)|([\w.@-]+(?:\([^)]*\))?)(?=\s*:(?:\s|$))|([-+]?\b\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?\b)/g;
const KINDS = ['string', 'comment', 'key', 'number'];

/** A line of YAML, coloured. */
function colored(line: string): (Node | string)[] {
  const out: (Node | string)[] = [];
  let last = 0;
  for (const match of line.matchAll(TOKENS)) {
    const kind = KINDS.find((_, k) => match[k + 1] !== undefined);
    out.push(line.slice(last, match.index), h('span', { class: `y-${kind}` }, match[0]));
    last = match.index + match[0].length;
  }
  out.push(line.slice(last));
  return out;
}

/** Text of blocks (`about: |`) is no YAML: from each line whether it is such text. */
function blocks(lines: string[]): boolean[] {
  let inside = -1;
  return lines.map((line) => {
    const indent = line.search(/\S/);
    if (inside >= 0 && (indent > inside || indent < 0)) return true;
    inside = /:\s*[|>][-+]?\s*(#.*)?$/.test(line) ? indent : -1;
    return false;
  });
}

/** The number, from 0, of the line in which a path of keys ends, or the deepest part of it that is found; none for no path. */
export function lineOf(lines: string[], path: string): number | null {
  const text = blocks(lines);
  let [row, indent, found]: [number, number, number | null] = [0, -1, null];
  let rest = path;
  while (rest !== '') {
    // names may have points in them: the longest that is found
    const parts = rest.split('.');
    let next: { row: number; indent: number; used: number } | null = null;
    for (let used = parts.length; used > 0 && !next; used--) {
      const at = child(lines, text, row, indent, parts.slice(0, used).join('.'));
      if (at) next = { ...at, used };
    }
    if (!next) break;
    [row, indent, found] = [next.row, next.indent, next.row];
    rest = parts.slice(next.used).join('.');
  }
  return found;
}

/** Where a key stands below a line of some indent. */
function child(lines: string[], text: boolean[], row: number, indent: number, key: string): { row: number; indent: number } | null {
  const escaped = key.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
  const own = new RegExp(`^\\s*(?:- )?["']?${escaped}["']?\\s*:`);
  const flow = new RegExp(`[{,]\\s*["']?${escaped}["']?\\s*:`);
  let level = -1;
  for (let i = indent < 0 ? row : row + 1; i < lines.length; i++) {
    const line = lines[i]!;
    const here = line.search(/[^\s]/);
    if (text[i] || here < 0 || line[here] === '#') continue;
    if (here <= indent) break;
    if (level < 0) level = here;
    if (here === level && own.test(line)) return { row: i, indent: here };
  }
  const line = indent >= 0 ? lines[row]! : '';
  return flow.test(line) ? { row, indent: indent } : null;
}

export interface Source {
  element: HTMLDetailsElement;
  /** Brings the line of a path into view, and tells whether there is one. */
  show(place: string): boolean;
  /** Brings a line, from 0, into view. */
  showLine(row: number): boolean;
  line(place: string): number | null;
}

/** The text of the file. */
export function source(text: string, path: string): Source {
  const lines = text.replace(/\n$/, '').split('\n');
  const plain = blocks(lines);
  const rows = lines.map((line, i) => h('li', {}, h('code', {}, ...(plain[i] ? [h('span', { class: 'y-text' }, line)] : colored(line)))));
  const list = h('ol', { class: 'yaml' }, ...rows);
  const details = h('details', { class: 'card source' }, h('summary', {}, 'Model file ', h('span', { class: 'soft' }, path)), list);
  const showLine = (row: number) => {
    const line = rows[row];
    if (!line) return false;
    details.open = true;
    rows.forEach((r, i) => r.classList.toggle('here', i === row));
    line.scrollIntoView({ block: 'center' });
    line.setAttribute('tabindex', '-1');
    line.focus({ preventScroll: true });
    return true;
  };
  return {
    element: details,
    line: (place) => lineOf(lines, place),
    showLine,
    show(place) {
      const row = lineOf(lines, place);
      return row !== null && showLine(row);
    },
  };
}
