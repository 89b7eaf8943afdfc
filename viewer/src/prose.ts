// Longer texts of a model: prose that is wrapped, and drawings made of characters, which are not.

import { type Child, h } from './dom';
import { coded } from './numbers';

/** Whether a paragraph is drawn rather than written: its lines have gaps or begin far in, or are made of signs. */
function isDrawing(paragraph: string): boolean {
  const lines = paragraph.split('\n').filter((line) => line.trim() !== '');
  const drawn = lines.filter((line) => /\S {3,}\S|^ {6,}|[|\\/_+=-]{3,}|^\s*[|\\/]/.test(line));
  return lines.length > 0 && 2 * drawn.length >= lines.length;
}

/** Paragraphs, of which drawings that follow one another are one. */
function paragraphs(text: string): { text: string; drawn: boolean }[] {
  const out: { text: string; drawn: boolean }[] = [];
  for (const part of text.replace(/^\s*\n|\s+$/g, '').split(/\n[^\S\n]*\n/)) {
    const drawn = isDrawing(part);
    const last = out[out.length - 1];
    if (drawn && last?.drawn) last.text += `\n\n${part}`;
    else out.push({ text: part, drawn });
  }
  return out;
}

/** Lines that must stay lines also where there is little room. */
const LISTED = /^\s*(?:[-*•]|\d+[.)])\s|\S {2,}\S/m;

/** A text as it is to be read. */
export function prose(text: string): Child[] {
  return paragraphs(text).map(({ text: part, drawn }) => (drawn ? h('pre', { tabindex: 0, role: 'group', 'aria-label': 'drawing' }, part) : h('p', { class: LISTED.test(part) ? 'prose listed' : 'prose' }, ...coded(part))));
}
