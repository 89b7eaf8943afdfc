// The mechanism in motion, with all that moves it.

import { Arrows, COLOR, type Kind } from './arrows';
import type { Clock } from './clock';
import { scene as decoded } from './data';
import { button, h, icon } from './dom';
import { leading } from './follow';
import { Motion, falling } from './motion';
import type { Named } from './names';
import { digits, heading, pretty, shownIn } from './numbers';
import { type Pace, WHOLE, pace } from './pace';
import { PAPER } from './paper';
import { Plane } from './plane/plane';
import { FIRST, type Options, type Renderer } from './renderer';
import type { Told } from './scales';
import { inks } from './theme';
import type { CodedScene, Results, Run, Scene, Study } from './types';

const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
/** Seconds in which a motion without time may be shown. */
const SPANS = [32, 16, 8, WHOLE, 2, 1];
/** A motion that takes less is slowed down to what can be followed, s. */
const BLINK = 0.15;
const SEEN = 2;
const NAMES: Record<Kind, string> = { velocities: 'velocities', accelerations: 'accelerations', loads: 'loads', reactions: 'reactions' };
/** Height of the drawing as a part of its width: at least, and at most. */
const FLAT = 0.55;
const TALL = 1;
/** One that is flatter has the whole width of the page. */
const BROAD = 0.3;
/** Names without room that are told, if there are more than one more. */
const TOLD = 4;
const PLAY = 'M4 2.5v11l9-5.5z';
const PAUSE = 'M4 3h3v10H4zM9 3h3v10H9z';

const scenes = new WeakMap<CodedScene, Scene>();

function sceneOf(coded: CodedScene): Scene {
  let known = scenes.get(coded);
  if (!known) scenes.set(coded, (known = decoded(coded)));
  return known;
}

/** Runs that have drawings, with their numbers. */
function drawnRuns({ runs }: Study): { run: Run; index: number }[] {
  return runs.map((run, index) => ({ run, index })).filter(({ run }) => run.results && run.results.scenes.length > 0);
}

/** Whether results are of one position. */
function rests({ kind, independent }: Results): boolean {
  return independent.values.length === 1 || (kind === 'statics' && independent.values.length === 0);
}

/** What there is to choose from. */
function choicesOf(study: Study): string {
  const names = ({ scenes }: Results) => scenes.map(([name, { dimensions }]) => `${name} ${dimensions}`);
  return JSON.stringify([study.table.reasons !== null, names(study), drawnRuns(study).map(({ run, index }) => [index, run.label, names(run.results!)])]);
}

/** The drawings to choose from, in words: modes with their frequencies. */
function titlesOf({ scenes }: Results): string[] {
  const differ = new Set(scenes.map(([, { caption }]) => caption)).size > 1;
  return scenes.map(([name, { caption }]) => `${name.replace(/-/g, ' ')}${differ && caption ? `: ${pretty(caption)}` : ''}`);
}

/** What a reader has chosen on a stage. */
export interface StageKept { options: Options; run: string; drawing: string; dimensions: number; look: number[] }

/** The stage of a study. */
export class Stage {
  readonly element: HTMLElement;
  motion: Motion | null = null;
  private readonly canvas = h('canvas', { tabindex: 0, role: 'img' });
  private readonly context = this.canvas.getContext('2d')!;
  private readonly slider = h('input', { type: 'range', min: 0, max: 10_000, step: 1, value: 0, 'aria-label': 'place of the motion', class: 'scrub' });
  private readonly time = h('output', { class: 'time', 'aria-live': 'polite' });
  /** What is said where time would be, if there is none. */
  private readonly timeless = h('span', { class: 'timeless' });
  private readonly playing = button(icon(PLAY), 'play', () => this.clock.play(), { class: 'play' });
  private readonly speed = h('select', { 'aria-label': 'speed', change: () => (this.clock.speed = this.speeds[this.speed.selectedIndex]?.[1] ?? 1) });
  /** How fast it may play, in words, and what the clock makes of it. */
  private speeds: [string, number][] = [];
  private readonly shown = h('div', { class: 'shown', role: 'group', 'aria-label': 'what is shown' });
  private readonly note = h('p', { class: 'note' });
  /** Which names have no room. */
  private readonly unnamed = h('p', { class: 'note unnamed' });
  /** The name of what a reader points at, and where that is. */
  private readonly tip = h('div', { class: 'tip', hidden: true, 'aria-hidden': 'true' });
  private at: [number, number] | null = null;
  private readonly drawings = h('select', { 'aria-label': 'drawing' });
  private renderer: Renderer | null = null;
  private pace: Pace | null = null;
  private results: Results;
  private options: Options = { paths: 'growing', names: true, arrows: new Set(), scale: FIRST, follow: null };
  /** Whether a reader may have chosen what is shown. */
  private begun = false;
  private size: [number, number] = [0, 0];
  private onPaper = false;
  /** Height of the highest drawing so far, as a part of its width. */
  private highest = 0;
  private waiting = false;
  private run = '';
  private drawing = '';

  /** With what a reader has chosen on an earlier stage of the study, whose clock then goes on. */
  constructor(private study: Study, private readonly clock: Clock, private readonly chosen: (run: number) => void, private kept?: StageKept) {
    this.results = study;
    if (kept) [this.options, this.begun] = [kept.options, true];
    this.element = h('section', { class: 'stage card', 'aria-label': 'the mechanism in motion' },
      this.choices(), h('div', { class: 'canvas' }, this.canvas, this.tip), this.transport(), this.shown, this.unnamed, this.note);
    this.listen();
    new ResizeObserver(() => this.fit()).observe(this.canvas.parentElement!);
  }

  /** What a reader has chosen; none if nothing is drawn. */
  keep(): StageKept | undefined {
    const { options, run, drawing, motion, renderer } = this;
    return motion && renderer ? { options, run, drawing, dimensions: motion.scene.dimensions, look: renderer.outlook() } : this.kept;
  }

  /** Takes the study computed anew, of which the drawing in view is shown as it was; false if there are other runs or drawings. */
  update(study: Study): boolean {
    const [before, next] = [choicesOf(this.study), choicesOf(study)];
    if (before !== next || !this.motion) return false;
    const run = drawnRuns(study).find(({ run: { label } }) => label === this.run);
    this.study = study;
    this.kept = this.keep();
    this.entitle(run?.run.results ?? study);
    this.load(run?.run.results ?? study, Math.max(0, this.drawings.selectedIndex), true);
    return true;
  }

  /** How it is seen, in numbers of what draws it. */
  look(): number[] {
    return this.renderer?.outlook() ?? [];
  }

  /** The names in the drawing. */
  names(): Named[] {
    return this.options.names ? (this.renderer?.named() ?? []) : [];
  }

  /** The arrows that tell the scale of others. */
  scales(): Told[] {
    return this.renderer?.scales() ?? [];
  }

  /** The wheels that mesh, and racks, in the drawing. */
  wheels(): ReturnType<Renderer['wheels']> {
    return this.renderer?.wheels() ?? [];
  }

  /** Draws when the browser next does. */
  redraw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.paint();
    });
  }

  /** Draws now. */
  paint(): void {
    const [width, height] = this.size;
    if (!this.renderer || width === 0) return;
    const ratio = this.ratio();
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.renderer.draw(this.clock.at, this.options, inks(), width, height);
    this.tellUnnamed();
    this.tellPointed();
  }

  /** Says which names have no room. */
  private tellUnnamed(): void {
    const names = this.options.names ? this.renderer!.unnamed() : [];
    const more = names.length > TOLD + 1 ? ` and ${names.length - TOLD} others` : '';
    const told = more ? names.slice(0, TOLD) : names;
    const text = names.length > 0 ? `no room for the ${names.length > 1 ? 'names' : 'name'} of ${told.join(', ')}${more}: point at a part to read its name, or zoom in` : '';
    if (this.unnamed.textContent !== text) this.unnamed.textContent = text;
  }

  /** Names what a reader points at. */
  private tellPointed(): void {
    const { at, tip } = this;
    const text = at && this.renderer ? this.renderer.pointed(at) : null;
    tip.hidden = text === null;
    if (!at || text === null) return;
    if (tip.textContent !== text) tip.textContent = text;
    tip.style.left = `${Math.max(0, Math.min(at[0] + 14, this.size[0] - tip.offsetWidth))}px`;
    tip.style.top = `${at[1] + 18 + tip.offsetHeight > this.size[1] ? at[1] - 10 - tip.offsetHeight : at[1] + 18}px`;
  }

  /** Follows the clock. */
  tick(): void {
    const { at, from, to, playing } = this.clock;
    this.slider.value = String(Math.round(((at - from) / (to - from || 1)) * 10_000));
    const text = this.place(at);
    this.slider.setAttribute('aria-valuetext', text);
    // spoken when it stands, or a reader of the screen would never be silent
    this.time.setAttribute('aria-live', playing ? 'off' : 'polite');
    this.time.textContent = text;
    this.redraw();
  }

  state(): void {
    this.playing.replaceChildren(icon(this.clock.playing ? PAUSE : PLAY));
    for (const name of ['aria-label', 'title']) this.playing.setAttribute(name, this.clock.playing ? 'pause' : 'play');
    this.tick();
  }

  /** Keys of the whole page. */
  key(event: KeyboardEvent): boolean {
    const steps: Record<string, () => void> = {
      ' ': () => this.clock.play(),
      ArrowRight: () => this.clock.step(event.shiftKey ? 20 : 200),
      ArrowLeft: () => this.clock.step(event.shiftKey ? -20 : -200),
      Home: () => this.clock.seek(this.clock.from),
      End: () => this.clock.seek(this.clock.to),
    };
    const step = this.motion && this.clock.from !== this.clock.to ? steps[event.key] : undefined;
    step?.();
    return Boolean(step);
  }

  /** The place as text: `theta 90°, 0.0625 s`. */
  private place(at: number): string {
    const { independent } = this.results;
    const { unit, size } = shownIn(independent);
    const own = `${independent.name || 'swing'} ${digits(at / size, 5)} ${pretty(unit)}`.trim();
    if (!this.pace?.real || independent.unit === 's') return own;
    const { motion, pace } = this;
    const [begin, end] = [motion?.begin ?? at, motion?.end ?? at].map((x) => pace.seconds(x)) as [number, number];
    const seconds = pace.seconds(at);
    // round-off of the instants of rows beside zero
    return `${own}, ${digits(Math.abs(seconds) < 1e-9 * Math.abs(end - begin) ? 0 : seconds, 4)} s`;
  }

  /** Gives the drawings to choose from their titles. */
  private entitle(results: Results): void {
    const options = [...this.drawings.options];
    titlesOf(results).forEach((title, k) => options[k] && (options[k].textContent = title));
  }

  /** Runs of a sweep, drawings of a study. */
  private choices(): HTMLElement {
    const { study } = this;
    const box = h('div', { class: 'choices' });
    const { drawings } = this;
    drawings.addEventListener('change', () => this.load(this.results, drawings.selectedIndex));
    const fill = (next: Results) => {
      drawings.replaceChildren(...next.scenes.map(([name]) => h('option', { value: name })));
      this.entitle(next);
      drawings.hidden = next.scenes.length < 2;
      drawings.selectedIndex = Math.max(0, next.scenes.findIndex(([name]) => name === this.kept?.drawing));
      this.load(next, Math.max(0, drawings.selectedIndex));
    };
    const runs = drawnRuns(study);
    if (study.table.reasons) {
      const select = h('select', { 'aria-label': 'run', change: () => choose(select.selectedIndex) }, ...runs.map(({ run }) => h('option', {}, pretty(run.label))));
      const choose = (k: number) => {
        const found = drawnRuns(this.study)[k];
        if (!found) return;
        this.run = found.run.label;
        fill(found.run.results!);
        this.chosen(found.index);
      };
      const before = Math.max(0, runs.findIndex(({ run }) => run.label === this.kept?.run));
      box.append(h('label', {}, 'run ', select));
      queueMicrotask(() => {
        select.selectedIndex = before;
        choose(before);
      });
    } else queueMicrotask(() => fill(study));
    box.append(drawings);
    return box;
  }

  private transport(): HTMLElement {
    const loop = button(icon('M3 8a5 5 0 0 1 8.5-3.5L13 6M13 2.5V6H9.5M13 8a5 5 0 0 1-8.5 3.5L3 10M3 13.5V10h3.5'), 'again and again', () => {
      this.clock.loop = !this.clock.loop;
      loop.setAttribute('aria-pressed', String(this.clock.loop));
    }, { 'aria-pressed': String(this.clock.loop), class: 'line' });
    this.slider.addEventListener('input', () => {
      const { from, to } = this.clock;
      const part = Number(this.slider.value) / 10_000;
      this.clock.play(false);
      this.clock.seek(from + (to - from) * part);
    });
    return h('div', { class: 'transport' }, this.playing, this.slider, h('div', { class: 'where' }, this.time, this.timeless), this.speed, loop,
      button(icon('M2 6V2h4M10 2h4v4M14 10v4h-4M6 14H2v-4'), 'whole mechanism', () => {
        this.renderer?.fit();
        this.redraw();
      }, { class: 'line' }));
  }

  /** Takes a drawing of results. */
  private load(results: Results, index: number, again = false): void {
    const coded = results.scenes[index]?.[1];
    this.results = results;
    this.drawing = results.scenes[index]?.[0] ?? '';
    if (!this.kept || !coded) this.clock.play(false);
    this.element.hidden = !coded;
    if (!coded) return;
    const scene = sceneOf(coded);
    const motion = new Motion(scene, falling(results.independent.values, scene.frames.at));
    this.motion = motion;
    const still = motion.to <= motion.from || rests(results);
    if (still) motion.behind = Array.from(scene.frames.shown, (k) => scene.frames.at[k]!).filter((at) => at !== motion.begin);
    this.pace = pace(results, motion.begin, motion.end, scene.arrows.filter(({ kind }) => kind !== 'reaction' && kind !== 'moment').map(({ name }) => name));
    const arrows = new Arrows(motion, results, this.pace);
    const space = motion.scene.dimensions === 3;
    this.renderer = space ? (window.grashofSpace?.(this.context, motion, arrows) ?? null) : new Plane(this.context, motion, arrows);
    if (!this.begun) this.options.follow = leading(motion);
    this.renderer?.follow(this.options.follow);
    if (this.kept?.dimensions === motion.scene.dimensions) this.renderer?.outlook(this.kept.look);
    this.kept = undefined;
    this.shape();
    this.element.classList.toggle('still', still);
    this.canvas.setAttribute('aria-label', `drawing of the mechanism: ${motion.scene.bodies.length - 1} bodies; ${space ? 'drag turns, shift and drag moves' : 'drag moves'}, the wheel with Ctrl zooms`);
    const kinds = arrows.kinds();
    this.options.arrows = new Set([...this.options.arrows].filter((kind) => kinds.includes(kind)));
    if (!this.begun) arrows.asked().filter((kind) => kinds.includes(kind)).forEach((kind) => this.options.arrows.add(kind));
    const shown = this.begun ? null : motion.scene.at;
    this.begun = true;
    this.showOptions(kinds, arrows);
    const { error } = motion.scene.frames;
    this.note.textContent = error > 0 && !still ? `drawn to within ${digits(error, 2)} m of the computed motion` : '';
    const { seconds, place } = this.pace;
    this.offer(again);
    if (!again) this.pick(seconds(motion.end) - seconds(motion.begin));
    this.clock.range(motion.begin, still ? motion.begin : motion.end, seconds, place);
    if (shown !== null) this.clock.seek(shown);
    this.state();
  }

  /** Makes the drawing as high as the mechanism asks for; of several runs or modes as high as the highest so far, so that it stays. */
  private shape(): void {
    const box = this.canvas.parentElement!;
    this.highest = Math.max(this.highest, Math.min(this.renderer?.aspect() ?? FLAT, TALL));
    const broad = this.highest < BROAD;
    this.element.classList.toggle('broad', broad);
    box.style.setProperty('--aspect', String(broad ? this.highest : Math.max(this.highest, FLAT)));
    box.style.setProperty('--paper', `${this.heightOnPaper()}px`);
  }

  /** Height of the drawing on paper, px, with room for scales and names. */
  private heightOnPaper(): number {
    const { width, room, height: [least, most] } = PAPER;
    return Math.round(Math.min(Math.max(this.highest * width + room, least), most));
  }

  /** Speeds to choose from: parts of that of the motion, or how long positions are shown that have no time; the one that was chosen stays. */
  private offer(again: boolean): void {
    const { real } = this.pace!;
    const before = this.speed.selectedIndex;
    this.speeds = real ? SPEEDS.map((s) => [`${s}×`, s]) : SPANS.map((span) => [`shown in ${span} s`, WHOLE / span]);
    this.speed.replaceChildren(...this.speeds.map(([text]) => h('option', {}, text)));
    this.speed.title = real ? 'parts of the speed of the motion' : 'how long the page takes to show all of them';
    this.tellTimeless();
    if (again) this.speed.selectedIndex = Math.min(before, this.speeds.length - 1);
  }

  /** Says of positions without time that they have none. */
  private tellTimeless(): void {
    const { independent } = this.results;
    const shape = independent.values.length === 0;
    this.timeless.hidden = this.pace!.real;
    this.timeless.textContent = shape ? 'shape, no time' : 'positions, no time';
    this.timeless.title = shape
      ? 'What plays is the shape of a vibration from one side to the other, enlarged, not a motion in time.'
      : `The results have no time: what plays are their positions over ${independent.name}, evenly, not a motion in time. A study whose columns have \`time\` plays as fast as it runs.`;
  }

  /** The speed at first: that of the motion, unless it is over at once. */
  private pick(duration: number): void {
    const fit = this.pace!.real && duration < BLINK ? SPEEDS.findLastIndex((s) => duration / s >= SEEN) : this.speeds.findIndex(([, speed]) => speed === 1);
    this.speed.selectedIndex = Math.max(fit, 0);
    this.clock.speed = this.speeds[this.speed.selectedIndex]![1];
  }

  private showOptions(kinds: Kind[], arrows: Arrows): void {
    const { options } = this;
    const check = (name: string, on: boolean, change: (on: boolean) => void, color?: number) => {
      const box = h('input', { type: 'checkbox', ...(on ? { checked: true } : {}), change: () => {
        change(box.checked);
        this.redraw();
      } });
      return h('label', {}, box, color !== undefined && h('span', { class: `dot curve-${color}` }), name);
    };
    const paths = h('select', { 'aria-label': 'paths', change: () => {
      options.paths = (['growing', 'whole', 'none'] as const)[paths.selectedIndex] ?? 'none';
      this.redraw();
    } }, ...['paths grow', 'whole paths', 'no paths'].map((name) => h('option', {}, name)));
    paths.selectedIndex = ['growing', 'whole', 'none'].indexOf(options.paths);
    const bodies = this.motion!.scene.bodies.slice(1).map(({ name }) => name);
    const follow = h('select', { 'aria-label': 'followed body', change: () => {
      options.follow = bodies[follow.selectedIndex - 1] ?? null;
      this.renderer?.follow(options.follow);
      this.shape();
      this.redraw();
    } }, h('option', {}, 'follow nothing'), ...bodies.map((name) => h('option', {}, `follow ${name}`)));
    follow.selectedIndex = bodies.indexOf(options.follow ?? '') + 1;
    // what the arrows mean, where the model says it
    const told = h('output', { class: 'told' });
    const tell = () => {
      const scales = kinds.flatMap((kind) => {
        const own = arrows.scale(kind);
        return own === null ? [] : [`${NAMES[kind]} ${digits((own * FIRST) / options.scale, 3)} N/m`];
      });
      told.textContent = scales.join(', ');
    };
    const scale = h('input', { type: 'range', min: 2, max: 100, value: options.scale * 100, 'aria-label': 'length of the arrows', class: 'scale', input: () => {
      options.scale = Number(scale.value) / 100;
      tell();
      this.redraw();
    } });
    this.shown.replaceChildren(
      ...(this.motion!.scene.traces.length > 0 ? [paths] : []),
      ...(this.motion!.to > this.motion!.from ? [follow] : []),
      check('names', options.names, (on) => (options.names = on)),
      ...kinds.map((kind) => check(NAMES[kind], options.arrows.has(kind), (on) => (on ? options.arrows.add(kind) : options.arrows.delete(kind)), COLOR[kind])),
      ...(kinds.length > 0 ? [h('label', {}, heading('length', ''), scale), told] : []));
    tell();
  }

  /** Points of the canvas to a px of the page. */
  private ratio(): number {
    return this.onPaper ? PAPER.ratio : window.devicePixelRatio || 1;
  }

  /** Paints for paper, in the size of its place there, or for the screen again. */
  paper(on: boolean): void {
    this.onPaper = on;
    this.fit();
    this.paint();
  }

  private fit(): void {
    const box = this.canvas.parentElement!;
    const [width, height] = this.onPaper ? [PAPER.width, this.heightOnPaper()] : [box.clientWidth, box.clientHeight];
    const points = [width, height].map((length) => Math.round(length * this.ratio())) as [number, number];
    if (width === this.size[0] && height === this.size[1] && points[0] === this.canvas.width && points[1] === this.canvas.height) return;
    this.size = [width, height];
    [this.canvas.width, this.canvas.height] = points;
    this.paint();
  }

  private listen(): void {
    const { canvas } = this;
    canvas.addEventListener('wheel', (event) => {
      // without the key the page scrolls
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      const box = canvas.getBoundingClientRect();
      this.renderer?.zoom(Math.exp(-event.deltaY * 0.0015), event.clientX - box.left, event.clientY - box.top);
      this.redraw();
    }, { passive: false });
    const points = (event: PointerEvent | null) => {
      this.at = event && [event.offsetX, event.offsetY];
      this.tellPointed();
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      points(event);
    });
    canvas.addEventListener('pointerleave', (event) => event.pointerType === 'mouse' && points(null));
    canvas.addEventListener('pointermove', (event) => {
      points(event.buttons === 0 ? event : null);
      if (!canvas.hasPointerCapture(event.pointerId)) return;
      this.renderer?.drag(event.movementX, event.movementY, !event.shiftKey && event.buttons === 1);
      this.redraw();
    });
    canvas.addEventListener('dblclick', () => {
      this.renderer?.fit();
      this.redraw();
    });
    canvas.addEventListener('keydown', (event) => {
      if (event.key !== '+' && event.key !== '-') return;
      this.renderer?.zoom(event.key === '+' ? 1.2 : 1 / 1.2, this.size[0] / 2, this.size[1] / 2);
      this.redraw();
    });
  }
}
