// The page: header, contents, the study in view, and the model file.

import { Clock } from './clock';
import { load } from './data';
import { button, h, icon } from './dom';
import { source } from './source';
import { StudyView } from './study';
import { begin, isDark, toggle } from './theme';
import type { Data } from './types';

declare global {
  interface Window {
    /** For tests and for readers with a console: where a joint is, the place of the motion, another place, another study. */
    grashof: {
      place(joint: string): number[] | null;
      time(): number;
      seek(at: number): void;
      study(name: string): boolean;
    };
  }
}

const SUN = 'M8 4.5a3.5 3.5 0 1 1 0 7a3.5 3.5 0 0 1 0-7zM8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M3 13l1-1M12 4l1-1';

class Page {
  private readonly clock = new Clock();
  private readonly main = h('main', { id: 'main' });
  private readonly file: ReturnType<typeof source>;
  private readonly links: HTMLAnchorElement[];
  private view: StudyView | null = null;

  constructor(private readonly data: Data, root: HTMLElement) {
    this.file = source(data.model.source, data.model.path);
    this.links = data.studies.map((study) =>
      h('a', { href: `#${encodeURIComponent(study.study)}` }, h('span', { class: study.stopped || study.expectations.some((e) => !e.met) ? 'name bad' : 'name' }, study.study), study.about !== '' && h('span', { class: 'what' }, study.about)));
    root.append(
      h('a', { href: '#main', class: 'skip', click: (event) => {
        event.preventDefault();
        document.getElementById('study-title')?.focus();
      } }, 'to the study'),
      this.header(),
      h('div', { class: 'body' }, this.contents(), h('div', { class: 'content' }, this.main, this.file.element)));
    this.clock.tell(() => this.view?.tick());
    this.clock.tellState(() => this.view?.stage.state());
    this.listen();
    this.show(decodeURIComponent(location.hash.slice(1))) || this.show(data.studies[0]?.study ?? '');
  }

  /** Shows a study; tells whether there is one of this name. */
  show(name: string, focus = false): boolean {
    const index = this.data.studies.findIndex((study) => study.study === name);
    const study = this.data.studies[index];
    if (!study) return false;
    this.clock.play(false);
    this.clock.at = -Infinity;
    this.view = new StudyView(study, this.clock, (place) => this.file.show(place));
    this.main.replaceChildren(this.view.element);
    this.links.forEach((link, k) => (k === index ? link.setAttribute('aria-current', 'page') : link.removeAttribute('aria-current')));
    const link = this.links[index]!;
    const nav = link.closest('nav');
    const seen = nav && link.offsetTop >= nav.scrollTop && link.offsetTop + link.offsetHeight <= nav.scrollTop + nav.clientHeight;
    if (nav && !seen) nav.scrollTop = link.offsetTop - nav.clientHeight / 2;
    document.title = `${study.study} – ${this.data.model.name}`;
    if (focus) {
      scrollTo(0, 0);
      document.getElementById('study-title')?.focus({ preventScroll: true });
    }
    return true;
  }

  face(): Window['grashof'] {
    return {
      place: (joint) => this.view?.stage.motion?.joint(joint, this.clock.at) ?? null,
      time: () => this.clock.at,
      seek: (at) => this.clock.seek(at),
      study: (name) => this.show(name),
    };
  }

  private header(): HTMLElement {
    const { model, overview, version } = this.data;
    const theme = button(icon(SUN), 'light or dark', () => {
      toggle();
      theme.setAttribute('aria-pressed', String(isDark()));
      this.view?.stage.redraw();
    }, { class: 'line theme', 'aria-pressed': String(isDark()) });
    begin(() => this.view?.stage.redraw());
    const about = model.about?.trimEnd() ?? '';
    const first = /^.*?\.(?=\s|$)|^.*/.exec((about.split(/\n\s*\n/)[0] ?? '').replace(/\s+/g, ' ').trim())![0];
    const rest = about.replace(/\s+/g, ' ') !== first;
    return h('header', { class: 'page' },
      h('div', { class: 'top' }, h('h1', {}, model.name), h('span', { class: 'soft version' }, `Grashof ${version}`), theme),
      first !== '' && h('p', { class: 'lead' }, first),
      overview.length > 0 && h('dl', { class: 'overview' }, ...overview.map(({ label, value }) => h('div', {}, h('dt', {}, label), h('dd', {}, value)))),
      rest && h('details', { class: 'about-model' }, h('summary', {}, 'more about the model'), h('pre', {}, about)));
  }

  private contents(): HTMLElement {
    const list = h('ol', {}, ...this.links.map((link) => h('li', {}, link)));
    return h('nav', { class: 'contents', 'aria-label': 'studies' }, h('h2', {}, 'Studies'), list);
  }

  private listen(): void {
    addEventListener('hashchange', () => this.show(decodeURIComponent(location.hash.slice(1)), true));
    addEventListener('keydown', (event) => {
      const target = event.target as HTMLElement;
      const busy = event.ctrlKey || event.metaKey || event.altKey || target.closest('input, select, textarea, [contenteditable], .rows');
      const pressed = event.key === ' ' && target.closest('button, summary, a');
      if (!busy && !pressed && this.view?.stage.key(event)) event.preventDefault();
    });
    // pictures on paper are light, and all parts are open
    const repaint = () => this.view?.stage.paint();
    let before: string | undefined;
    let closed: HTMLDetailsElement[] = [];
    addEventListener('beforeprint', () => {
      before = document.documentElement.dataset.theme;
      document.documentElement.dataset.theme = 'light';
      closed = [...document.querySelectorAll<HTMLDetailsElement>('.part:not([open])')];
      closed.forEach((part) => (part.open = true));
      repaint();
    });
    addEventListener('afterprint', () => {
      if (before) document.documentElement.dataset.theme = before;
      else delete document.documentElement.dataset.theme;
      closed.forEach((part) => (part.open = false));
      repaint();
    });
  }
}

async function start(): Promise<void> {
  const root = document.getElementById('page')!;
  try {
    const page = new Page(await load(), root);
    window.grashof = page.face();
  } catch (error) {
    root.append(h('p', { class: 'failed', role: 'alert' }, `The data of this page cannot be read: ${error instanceof Error ? error.message : String(error)}. It needs a browser of 2023 or later.`));
  }
}

void start();
