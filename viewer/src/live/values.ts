// Sliders for the numbers of the file: parameters, and the values of the start.

import { button, h, icon } from '../dom';
import { pretty } from '../numbers';
import { type Movable, tell } from './link';

/** Steps of a slider over its range. */
const STEPS = 200;
/** Milliseconds after which a value is sent although the study in view is not done yet. */
const PATIENCE = 300;
const BACK = 'M3.5 6.5h6a3.5 3.5 0 0 1 0 7H6M3.5 6.5l3-3M3.5 6.5l3 3';

/** A number with the digits that its range is worth. */
function rounded(x: number, range: number): number {
  if (!(range > 0)) return x;
  const places = Math.min(Math.max(Math.ceil(-Math.log10(range / STEPS)) + 1, 0), 15);
  return Number(x.toFixed(places));
}

class Row {
  readonly element: HTMLElement;
  /** Where the reader has moved it, until the program says so too. */
  private sent: number | null = null;
  private readonly slider: HTMLInputElement;
  private readonly field: HTMLInputElement;

  constructor(private of: Movable, private readonly move: (place: string, value: number) => void, told: (why: string) => void) {
    const label = of.unit === '' ? of.name : `${of.name} in ${of.unit}`;
    this.slider = h('input', { type: 'range', step: 'any', 'aria-label': label, input: () => {
      this.choose(rounded(Number(this.slider.value), Number(this.slider.max) - Number(this.slider.min)));
    } });
    this.slider.addEventListener('keydown', (event) => this.key(event));
    this.field = h('input', { type: 'text', inputmode: 'decimal', 'aria-label': `${label}, as a number`, change: () => {
      const value = Number(this.field.value.replace(',', '.').replace('−', '-'));
      if (this.field.value.trim() !== '' && Number.isFinite(value)) this.choose(value);
      else this.field.value = String(this.of.value);
    } });
    const write = button('write', `write ${of.name} to the file`, () => {
      void tell('/write', { place: of.place, value: this.sent ?? this.of.value }).then((why) => told(why === null ? '' : `${of.name} is not written: ${why}.`));
    }, { class: 'write' });
    const back = button(icon(BACK), `take ${of.name} back`, () => {
      this.sent = null;
      void tell('/back', { place: of.place });
    }, { class: 'line' });
    this.element = h('li', { 'data-place': of.place },
      h('span', { class: 'name', title: of.place }, of.name),
      h('span', { class: 'tools' }, write, back),
      h('span', { class: 'number' }, this.field, h('span', { class: 'unit' }, pretty(of.unit))),
      this.slider);
    this.show(of);
  }

  /** Takes what the program says. */
  show(of: Movable): void {
    if (this.sent === of.value) this.sent = null;
    this.of = of;
    const value = this.sent ?? of.value;
    // what the reader holds stays where it is held
    const held = document.activeElement === this.slider && this.sent !== null;
    this.slider.min = String(Math.min(of.low, held ? Infinity : value));
    this.slider.max = String(Math.max(of.high, held ? -Infinity : value));
    if (!held) this.slider.value = String(value);
    if (document.activeElement !== this.field) this.field.value = String(value);
    this.element.classList.toggle('moved', value !== of.number);
    this.slider.style.setProperty('--home', String((of.number - Number(this.slider.min)) / (Number(this.slider.max) - Number(this.slider.min) || 1)));
  }

  private choose(value: number): void {
    this.sent = value;
    this.field.value = String(value);
    this.slider.value = String(value);
    this.element.classList.toggle('moved', value !== this.of.number);
    this.move(this.of.place, value);
  }

  private key(event: KeyboardEvent): void {
    const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const [low, high] = [Number(this.slider.min), Number(this.slider.max)];
    this.choose(rounded(Math.min(Math.max(Number(this.slider.value) + (way * (high - low)) / STEPS, low), high), high - low));
  }
}

/** The panel of all values. */
export class Values {
  readonly element: HTMLElement;
  private readonly lists = [h('ul'), h('ul')] as const;
  private readonly parts: HTMLElement[];
  private readonly all = button('take all back', 'take all values back', () => void tell('/back', {}), { class: 'text' });
  private readonly note = h('p', { class: 'note bad', role: 'status' });
  private rows = new Map<string, Row>();
  private order = '';
  private waiting: { place: string; value: number } | null = null;
  private timer = 0;
  private busy = false;

  constructor() {
    this.parts = ['Parameters', 'Start'].map((name, k) => h('details', { open: true, class: 'values-part' }, h('summary', {}, name), this.lists[k]!));
    this.element = h('section', { class: 'movable', 'aria-label': 'values of the file' }, h('div', { class: 'head' }, h('h2', {}, 'Values'), this.all), this.note, h('div', { class: 'scrolled' }, ...this.parts));
  }

  /** Takes the values that the file has, and whether the study in view is up to date. */
  show(values: Movable[], moved: boolean, busy: boolean): void {
    const order = values.map((value) => `${value.place} ${value.unit}`).join('\n');
    if (order !== this.order) this.fill(values);
    this.order = order;
    values.forEach((value) => this.rows.get(value.place)?.show(value));
    this.all.disabled = !moved;
    this.element.hidden = values.length === 0;
    this.busy = busy;
    if (!busy) this.send();
  }

  private fill(values: Movable[]): void {
    const told = (why: string) => (this.note.textContent = why);
    this.rows = new Map(values.map((value) => [value.place, new Row(value, (place, to) => this.move(place, to), told)]));
    [false, true].forEach((start, k) => {
      const own = values.filter((value) => value.start === start).map((value) => this.rows.get(value.place)!.element);
      this.lists[k]!.replaceChildren(...own);
      this.parts[k]!.hidden = own.length === 0;
    });
  }

  /** Sends the newest value when the program is ready for it, or after a while, when what it computes is out of date. */
  private move(place: string, value: number): void {
    if (this.waiting && this.waiting.place !== place) this.send();
    this.note.textContent = '';
    this.waiting = { place, value };
    if (!this.busy) this.send();
    else if (this.timer === 0) this.timer = window.setTimeout(() => this.send(), PATIENCE);
  }

  private send(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    const { waiting } = this;
    if (!waiting) return;
    this.waiting = null;
    this.busy = true;
    void tell('/move', waiting);
  }
}
