// The live page: it follows the program that serves it.

import { h } from '../dom';
import { Page } from '../page';
import { type State, type StudyState, state, study, tell } from './link';
import { Notices, isOld } from './notices';
import { Values } from './values';

/** Milliseconds until a program that does not answer is asked again. */
const AGAIN = 700;

class Live {
  private page: Page | null = null;
  private readonly status = h('span', { class: 'status', role: 'status' }, 'connecting');
  private readonly values = new Values();
  private readonly notices = new Notices((line) => this.page?.showLine(line));
  private known: State | null = null;
  /** Numbers of what is shown: of the model, and of each study. */
  private model = 0;
  private readonly shown = new Map<string, number>();
  private fetching = new Set<string>();

  constructor(private readonly root: HTMLElement) {}

  async follow(): Promise<never> {
    for (;;) {
      try {
        const name = this.page?.inView;
        await this.take(await state(this.known?.version ?? 0, this.model, name, this.shown.get(name ?? '') ?? 0));
      } catch (error) {
        this.say('off', error instanceof TypeError ? 'not connected' : String(error instanceof Error ? error.message : error));
        this.known = this.known && { ...this.known, version: 0 };
        await new Promise((resolve) => setTimeout(resolve, AGAIN));
      }
    }
  }

  private async take(next: State): Promise<void> {
    this.known = next;
    // first what a reader waits for
    const { result } = next;
    if (result && this.page) {
      this.shown.set(result.study, next.studies.find((s) => s.name === result.study)?.version ?? 0);
      this.page.put(result);
    }
    if (next.head) {
      const data = { ...next.head, studies: [] };
      this.notices.file = data.model.path;
      if (this.page) this.page.setModel(data);
      else this.begin(next, data);
      this.model = next.model;
    }
    if (!this.page) return;
    this.page.setEntries(next.studies.map((s) => ({ name: s.name, about: s.about, bad: s.bad, state: s.busy ? 'busy' : s.stale ? 'stale' : '' })));
    await this.refresh();
  }

  private begin(next: State, data: Parameters<Page['setModel']>[0]): void {
    this.root.replaceChildren();
    const entries = next.studies.map(({ name, about, bad }) => ({ name, about, bad }));
    const more = { status: this.status, notices: this.notices.element, values: this.values.element, viewed: (name: string) => this.viewed(name) };
    if (location.hash === '' && next.first !== null) history.replaceState(null, '', `#${encodeURIComponent(next.first)}`);
    this.page = new Page(data, entries, this.root, more);
    window.grashof = this.page.face();
  }

  private viewed(name: string): void {
    void tell('/view', { study: name });
    // the page is not there yet while it is made
    queueMicrotask(() => void this.refresh().catch(() => undefined));
  }

  /** Shows what is known, and gets the study in view if there is a newer one. */
  private async refresh(): Promise<void> {
    const { page, known } = this;
    if (!page || !known) return;
    const inView = known.studies.find((s) => s.name === page.inView);
    this.notices.tell(known, inView);
    this.values.show(known.values, known.moved, Boolean(inView?.stale) && !inView?.bad);
    this.tellStatus(known, inView);
    if (!inView || inView.version === 0 || inView.version === this.shown.get(inView.name) || this.fetching.has(inView.name)) return;
    this.fetching.add(inView.name);
    try {
      const got = await study(inView.name);
      this.shown.set(inView.name, got.version);
      page.put(got.study);
    } finally {
      this.fetching.delete(inView.name);
    }
  }

  private tellStatus(known: State, inView: StudyState | undefined): void {
    document.documentElement.classList.toggle('old', isOld(known, inView));
    if (known.away !== null) this.say('bad', 'the file is away');
    else if (known.broken.length > 0) this.say('bad', 'the file has errors');
    else if (inView?.stale) this.say('busy', 'computing');
    else if (isOld(known, inView)) this.say('bad', 'the file has errors');
    else if (known.studies.some((s) => s.stale)) this.say('busy', 'up to date, others follow');
    else this.say('good', known.moved ? 'live, with moved values' : 'live');
  }

  private say(kind: string, text: string): void {
    this.status.className = `status ${kind}`;
    if (this.status.textContent !== text) this.status.textContent = text;
  }
}

void new Live(document.getElementById('page')!).follow();
