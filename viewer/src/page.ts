// The page: header, contents, the study in view, and the model file.

import { Clock } from './clock';
import { button, h, icon } from './dom';
import type { Named } from './names';
import type { Renderer } from './renderer';
import type { Told } from './scales';
import { coded } from './numbers';
import { prose } from './prose';
import { type Source, source } from './source';
import { faults } from './facts';
import { StudyView } from './study';
import { begin, isDark, toggle } from './theme';
import type { Data, Failed, Fault, Study } from './types';

declare global {
  interface Window {
    /** For tests and for readers with a console: where a joint is, the place of the motion, how it is seen, the names in the drawing, another place, another study. */
    grashof: {
      place(joint: string): number[] | null;
      time(): number;
      look(): number[];
      names(): Named[];
      scales(): Told[];
      wheels(): ReturnType<Renderer['wheels']>;
      seek(at: number): void;
      study(name: string): boolean;
    };
  }
}

const SUN = 'M8 4.5a3.5 3.5 0 1 1 0 7a3.5 3.5 0 0 1 0-7zM8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M3 13l1-1M12 4l1-1';

/** Pixels of the height of the contents at least, and below them. */
const LEAST = 200;
const EDGE = 16;
/** Milliseconds until the text of a file that has changed is made anew. */
const LATER = 250;

/** A study in the contents. */
export interface Entry { name: string; about: string; bad: boolean; state?: string; faults?: Fault[] }

/** What a page has beside that of a report. */
export interface More {
  /** In the header, above the study, and below the contents. */
  status?: HTMLElement;
  notices?: HTMLElement;
  values?: HTMLElement;
  /** Is told which study is in view. */
  viewed?(name: string): void;
}

/** What the header of a page says. */
function headOf({ model, overview, version }: Data): string {
  return JSON.stringify([model.name, model.about, overview, version]);
}

export function entryOf(study: Study | Failed): Entry {
  if ('faults' in study) return { name: study.study, about: study.about, bad: true, faults: study.faults };
  return { name: study.study, about: study.about, bad: study.stopped !== null || study.expectations.some((e) => !e.met) };
}

export class Page {
  private readonly clock = new Clock();
  private readonly main = h('main', { id: 'main' });
  private readonly list = h('ol');
  private readonly side = h('div', { class: 'side' });
  private readonly nav = h('nav', { class: 'contents', 'aria-label': 'studies' });
  /** In narrow windows instead of the list. */
  private readonly chooser = h('select', { class: 'compact', 'aria-label': 'study', change: () => this.choose() });
  private header: HTMLElement;
  private file: Source;
  private links: HTMLAnchorElement[] = [];
  private view: StudyView | null = null;
  private name = '';
  /** Whether the file has another text than is shown. */
  private stale = false;
  private later = 0;
  /** Whether a reader has moved the contents since a study was shown. */
  private browsed = false;

  constructor(private data: Data, private entries: Entry[], root: HTMLElement, private readonly more: More = {}) {
    this.file = source(data.model.source, data.model.path);
    this.header = this.top();
    this.nav.append(h('h2', {}, 'Studies'), this.chooser, this.list);
    this.side.append(this.nav, ...(more.values ? [more.values] : []));
    this.contents();
    root.append(
      h('a', { href: '#main', class: 'skip', click: (event) => {
        event.preventDefault();
        document.getElementById('study-title')?.focus();
      } }, 'to the study'),
      this.header,
      h('div', { class: 'body' },
        this.side,
        h('div', { class: 'content' }, more.notices, this.main, this.file.element)));
    this.clock.tell(() => this.view?.tick());
    this.clock.tellState(() => this.view?.stage.state());
    this.listen();
    this.show(decodeURIComponent(location.hash.slice(1))) || this.show(entries[0]?.name ?? '');
  }

  /** The study in view. */
  get inView(): string {
    return this.name;
  }

  /** Shows a study; tells whether there is one of this name. */
  show(name: string, focus = false): boolean {
    const entry = this.entries.find((known) => known.name === name);
    if (!entry) return false;
    this.clock.play(false);
    this.clock.at = -Infinity;
    this.name = name;
    const study = this.data.studies.find((known) => known.study === name);
    this.view = study ? this.viewOf(study) : null;
    this.main.replaceChildren(this.view?.element ?? this.waiting(entry));
    this.mark();
    this.browsed = false;
    this.showEntry();
    document.title = `${name} – ${this.data.model.name}`;
    this.more.viewed?.(name);
    if (focus) this.begin();
    return true;
  }

  /** Goes to the beginning of the study in view, of which a reader sees the title. */
  private begin(focus = true): void {
    const title = document.getElementById('study-title');
    scrollTo(0, 0);
    if (title && title.getBoundingClientRect().bottom > innerHeight / 2) title.closest('header')!.scrollIntoView();
    if (focus) title?.focus({ preventScroll: true });
  }

  /** The contents end with the window, also where they begin below the header. */
  private fit(): void {
    this.side.style.maxHeight = `${Math.max(LEAST, innerHeight - Math.max(0, this.side.getBoundingClientRect().top) - EDGE)}px`;
  }

  /** Brings the study in view into view in the contents, too, unless a reader looks for another one there. */
  private showEntry(): void {
    this.fit();
    if (this.browsed) return;
    const link = this.links[this.entries.findIndex((entry) => entry.name === this.name)];
    if (link) this.reveal(link);
  }

  /** Brings an entry of the contents into view, below their heading. */
  private reveal(link: HTMLElement): void {
    const { nav } = this;
    const [box, own] = [nav.getBoundingClientRect(), link.getBoundingClientRect()];
    const head = nav.firstElementChild!.getBoundingClientRect().height;
    if (own.top < box.top + head || own.bottom > box.bottom) nav.scrollTop += own.top - box.top - head - Math.max(0, (box.height - head - own.height) / 2);
  }

  /** Shows the study of the compact list, which keeps the focus. */
  private choose(): void {
    const { name } = this.entries[this.chooser.selectedIndex] ?? { name: this.name };
    location.hash = encodeURIComponent(name);
  }

  /** Takes a study that was computed anew; what a reader has chosen in it stays. */
  put(study: Study): void {
    const index = this.data.studies.findIndex((known) => known.study === study.study);
    if (index < 0) this.data.studies.push(study);
    else this.data.studies[index] = study;
    if (study.study !== this.name) return;
    if (!this.view) {
      this.show(study.study);
      return;
    }
    if (this.view.update(study)) return;
    const focused = this.main.contains(document.activeElement) ? document.activeElement?.getAttribute('aria-label') : null;
    const [before, scrolled] = [this.view.element, scrollY];
    this.view = this.viewOf(study, this.view);
    // figures get their height when they are drawn: until then the page must not become shorter
    this.main.style.minHeight = `${this.main.offsetHeight}px`;
    before.replaceWith(this.view.element);
    this.view.scroll();
    if (focused) this.main.querySelector<HTMLElement>(`[aria-label="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
    scrollTo(scrollX, scrolled);
    requestAnimationFrame(() => requestAnimationFrame(() => (this.main.style.minHeight = '')));
  }

  /** Takes studies of the file, in its order. */
  setEntries(entries: Entry[]): void {
    const same = JSON.stringify(entries) === JSON.stringify(this.entries);
    this.entries = entries;
    if (same && this.view) return;
    this.data.studies = this.data.studies.filter((study) => entries.some((entry) => entry.name === study.study));
    this.contents();
    this.mark();
    const entry = entries.find((known) => known.name === this.name);
    if (!entry) this.show(entries[0]?.name ?? '');
    else if (!this.view) this.main.replaceChildren(this.waiting(entry));
  }

  /** Takes what is known of a model whose file has changed. */
  setModel(data: Data): void {
    const [before, head] = [this.data.model, headOf(this.data)];
    this.data = { ...data, studies: this.data.studies };
    document.title = `${this.name} – ${data.model.name}`;
    if (headOf(this.data) !== head) {
      const header = this.top();
      this.header.replaceWith(header);
      this.header = header;
    }
    // the text of a long file takes time, which what is in view has first
    clearTimeout(this.later);
    if (before.source === data.model.source && before.path === data.model.path) return;
    this.stale = true;
    if (this.file.element.open) this.later = window.setTimeout(() => this.current(), LATER);
    else this.file.element.addEventListener('toggle', () => this.current(), { once: true });
  }

  /** The text of the file as it is now. */
  private current(): Source {
    clearTimeout(this.later);
    if (!this.stale) return this.file;
    this.stale = false;
    const file = source(this.data.model.source, this.data.model.path);
    file.element.open = this.file.element.open;
    this.file.element.replaceWith(file.element);
    this.file = file;
    return file;
  }

  /** Brings a line of the file, from 1, into view. */
  showLine(line: number): boolean {
    return this.current().showLine(line - 1);
  }

  face(): Window['grashof'] {
    return {
      place: (joint) => this.view?.stage.motion?.joint(joint, this.clock.at) ?? null,
      time: () => this.clock.at,
      look: () => this.view?.stage.look() ?? [],
      names: () => this.view?.stage.names() ?? [],
      scales: () => this.view?.stage.scales() ?? [],
      wheels: () => this.view?.stage.wheels() ?? [],
      seek: (at) => this.clock.seek(at),
      study: (name) => this.show(name),
    };
  }

  private viewOf(study: Study, before?: StudyView): StudyView {
    return new StudyView(study, this.clock, (place) => this.current().show(place), before?.keep());
  }

  private waiting(entry: Entry): HTMLElement {
    return h('article', { class: 'study', 'aria-labelledby': 'study-title' },
      h('header', { class: 'title' },
        h('h2', { id: 'study-title', tabindex: -1 }, entry.name),
        entry.faults && entry.about !== '' && h('p', { class: 'about' }, ...coded(entry.about)),
        h('p', { class: 'about' }, entry.bad ? 'There is no result of this study.' : 'is being computed')),
      entry.faults && entry.faults.length > 0 && h('div', { class: 'facts card' }, faults(entry.faults, (place) => this.current().show(place))));
  }

  private mark(): void {
    this.chooser.selectedIndex = this.entries.findIndex((entry) => entry.name === this.name);
    this.links.forEach((link, k) => (this.entries[k]?.name === this.name ? link.setAttribute('aria-current', 'page') : link.removeAttribute('aria-current')));
  }

  private top(): HTMLElement {
    const { model, overview, version } = this.data;
    const theme = button(icon(SUN), 'light or dark', () => {
      toggle();
      theme.setAttribute('aria-pressed', String(isDark()));
      this.view?.stage.redraw();
    }, { class: 'line theme', 'aria-pressed': String(isDark()) });
    const about = model.about?.trimEnd() ?? '';
    // a line that ends with a colon leads to a sketch, and says little without it
    const paragraphs = about.split(/\n\s*\n/).filter((part) => /^\S/.test(part)).map((part) => part.replace(/\s+/g, ' ').trim());
    const first = /^.*?\.(?=\s|$)|^.*/.exec(paragraphs.find((part) => !part.endsWith(':')) ?? paragraphs[0] ?? '')![0];
    // a mechanism of which no mass is told has none to show
    const told = overview.filter(({ label, value }) => label !== 'mass' || parseFloat(value) !== 0);
    const rest = about.replace(/\s+/g, ' ') !== first;
    return h('header', { class: 'page' },
      h('div', { class: 'top' }, h('h1', {}, model.name), h('span', { class: 'soft version' }, `Grashof ${version}`), this.more.status, theme),
      first !== '' && h('p', { class: 'lead' }, ...coded(first)),
      told.length > 0 && h('dl', { class: 'overview' }, ...told.map(({ label, value }) => h('div', {}, h('dt', {}, label), h('dd', {}, value)))),
      rest && h('details', { class: 'about-model' }, h('summary', {}, 'more about the model'), h('div', { class: 'prose-box' }, ...prose(about))));
  }

  private contents(): void {
    this.links = this.entries.map(({ name, about, bad, state }) =>
      h('a', { href: `#${encodeURIComponent(name)}` }, h('span', { class: `name ${bad ? 'bad' : ''} ${state ?? ''}`.trim() }, name), about !== '' && h('span', { class: 'what' }, ...coded(about))));
    this.chooser.replaceChildren(...this.entries.map(({ name, bad }) => h('option', {}, bad ? `${name} !` : name)));
    this.list.replaceChildren(...this.links.map((link) => h('li', {}, link)));
  }

  private listen(): void {
    begin(() => this.view?.stage.redraw());
    for (const event of ['wheel', 'touchmove', 'pointerdown', 'keydown']) this.nav.addEventListener(event, () => (this.browsed = true), { passive: true });
    const sized = new ResizeObserver(() => this.showEntry());
    for (const part of [this.nav, this.list]) sized.observe(part);
    for (const event of ['scroll', 'resize']) addEventListener(event, () => this.fit(), { passive: true });
    addEventListener('hashchange', () => {
      const compact = document.activeElement === this.chooser;
      if (this.show(decodeURIComponent(location.hash.slice(1)), !compact) && compact) this.begin(false);
    });
    addEventListener('keydown', (event) => {
      const target = event.target as HTMLElement;
      const busy = event.ctrlKey || event.metaKey || event.altKey || target.closest('input, select, textarea, [contenteditable], .rows');
      const pressed = event.key === ' ' && target.closest('button, summary, a');
      if (!busy && !pressed && this.view?.stage.key(event)) event.preventDefault();
    });
    // pictures on paper are light, and all parts are open
    let before: string | undefined;
    let closed: HTMLDetailsElement[] = [];
    addEventListener('beforeprint', () => {
      before = document.documentElement.dataset.theme;
      document.documentElement.dataset.theme = 'light';
      closed = [...document.querySelectorAll<HTMLDetailsElement>('.part:not([open])')];
      closed.forEach((part) => (part.open = true));
      this.view?.paper(true);
    });
    addEventListener('afterprint', () => {
      if (before) document.documentElement.dataset.theme = before;
      else delete document.documentElement.dataset.theme;
      closed.forEach((part) => (part.open = false));
      this.view?.paper(false);
    });
  }
}
