// What is wrong with the file, above the last good picture.

import { h } from '../dom';
import type { Finding, State, StudyState } from './link';

/** The place in a finding's text, which leads to the line. */
const PLACE = /^(\s*--> )(.*:\d+:\d+)$/m;

/** Whether what is shown is of an earlier file. */
export function isOld({ away, broken }: State, inView: StudyState | undefined): boolean {
  return away !== null || broken.length > 0 || Boolean(inView?.bad && inView.findings.some((finding) => finding.error));
}

export class Notices {
  readonly element = h('div', { class: 'notices', 'aria-live': 'polite' });
  private shown = '';
  /** The file that is shown. */
  file = '';

  /** `show` brings a line of the file into view. */
  constructor(private readonly show: (line: number) => void) {}

  /** Shows what there is to say, of the file and of the study in view. */
  tell(state: State, inView: StudyState | undefined): void {
    const { away, broken, findings } = state;
    const of = broken.length > 0 ? broken : [...(inView?.findings ?? []), ...findings];
    const all = of.filter((finding, i) => of.findIndex((other) => other.text === finding.text) === i);
    const key = JSON.stringify([away, all, isOld(state, inView)]);
    if (key === this.shown) return;
    this.shown = key;
    const lead = away !== null ? `The file cannot be read: ${away}. What it was is shown until it is back.`
      : isOld(state, inView) ? 'The file has errors. What is shown is of an earlier one.' : '';
    const errors = away !== null || all.some((finding) => finding.error);
    this.element.className = `notices card ${errors ? 'bad' : 'warned'}`;
    this.element.hidden = lead === '' && all.length === 0;
    this.element.replaceChildren(...(lead === '' ? [] : [h('p', { class: 'lead' }, lead)]), ...all.map((finding) => this.finding(finding)));
  }

  /** The text of a finding; a click on its place leads to the line. */
  private finding(finding: Finding): HTMLElement {
    const match = PLACE.exec(finding.text);
    // what the command line or another file says has no line here
    if (!match || finding.line === 0 || finding.file !== this.file) return h('pre', {}, finding.text);
    const [before, place] = [finding.text.slice(0, match.index) + match[1]!, match[2]!];
    const link = h('button', { type: 'button', class: 'place', title: 'show in the model file', click: () => this.show(finding.line) }, place);
    return h('pre', {}, before, link, finding.text.slice(match.index + match[0].length));
  }
}
