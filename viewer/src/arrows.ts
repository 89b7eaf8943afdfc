// Arrows on a mechanism: velocities, accelerations, loads, reactions.

import { column, fineOf, valueAt } from './curves';
import type { Motion, Vector } from './motion';
import type { Pace } from './pace';
import { FIRST } from './renderer';
import type { Place, Results, Scene } from './types';

export type Kind = 'velocities' | 'accelerations' | 'loads' | 'reactions';
export const KINDS: Kind[] = ['velocities', 'accelerations', 'loads', 'reactions'];
/** The curve colour of each kind. */
export const COLOR: Record<Kind, number> = { velocities: 2, accelerations: 4, loads: 1, reactions: 0 };

/** Of a torque `along` is its vector, N m, and it turns about it. */
export interface Arrow { kind: Kind; from: Vector; along: Vector; torque: boolean }

/** Radius of the largest torque, pixels. */
export const ROUND = 18;

/** Places at which the largest arrow is looked for. */
const LOOKS = 90;

export class Arrows {
  private readonly largest = new Map<Kind | 'torques', number>();
  private readonly moving: Place[];
  /** Those of the scene, and of joints whose reactions are columns of the table. */
  private readonly forces: Scene['arrows'];

  constructor(private readonly motion: Motion, private readonly results: Results, private readonly pace: Pace) {
    const { joints, traces, arrows, dimensions } = motion.scene;
    const told = ({ name, a, b, on_ground: minus }: Scene['joints'][number]): Scene['arrows'] => {
      const columns = ['fx', 'fy', 'fz'].slice(0, dimensions).map((axis) => `${name}.${axis}`);
      if (!columns.every((own) => column(results, own)) || arrows.some((arrow) => arrow.name === name)) return [];
      return [{ name, kind: 'reaction', ...(b.body === 0 ? a : b), columns, minus, values: null, scale: null }];
    };
    this.forces = [...arrows, ...joints.flatMap(told)];
    const seen = new Set<string>();
    const fresh = ({ body, at }: Place) => {
      const point = this.motion.world({ body, at }, this.motion.from).map((x) => x.toFixed(6)).join();
      return body !== 0 && !seen.has(point) && seen.add(point);
    };
    this.moving = [...joints.flatMap(({ a, b }) => (a.body === 0 || b.body === 0 ? (a.body === 0 ? [b] : [a]) : [a])), ...traces].filter(fresh);
  }

  /** Kinds that there are. */
  kinds(): Kind[] {
    const has = (kind: Kind) => this.at(kind, this.motion.from).length > 0;
    const moves = this.motion.scene.frames.at.length > 3;
    return KINDS.filter((kind) => (kind === 'loads' || kind === 'reactions' ? has(kind) : moves && this.pace.real));
  }

  /** Arrows of a kind at a place, in their own unit. */
  at(kind: Kind, place: number): Arrow[] {
    if (kind === 'velocities' || kind === 'accelerations') return this.moving.map((point) => ({ kind, from: this.motion.world(point, place), along: this.rate(point, place, kind), torque: false }));
    return this.forces.flatMap((arrow) => {
      if ((arrow.kind === 'reaction') !== (kind === 'reactions')) return [];
      const along = this.force(arrow, place);
      return along ? [{ kind, from: this.motion.world(arrow, place), along, torque: arrow.kind === 'torque' }] : [];
    });
  }

  /** Kinds that the model asks to be shown. */
  asked(): Kind[] {
    const { arrows } = this.motion.scene;
    return (['loads', 'reactions'] as const).filter((kind) => arrows.some((arrow) => (arrow.kind === 'reaction') === (kind === 'reactions')));
  }

  /** Force per length that the model gives a kind, N/m. */
  scale(kind: Kind): number | null {
    if (kind !== 'loads' && kind !== 'reactions') return null;
    const of = this.motion.scene.arrows.find((arrow) => arrow.scale !== null && (arrow.kind === 'reaction') === (kind === 'reactions'));
    return of?.scale ?? null;
  }

  /** The unit of a kind, and its size in SI: of forces those that the model asks for. */
  unit(kind: Kind | 'torques'): { unit: string; size: number } {
    if (kind === 'velocities' || kind === 'accelerations') return { unit: kind === 'velocities' ? 'm/s' : 'm/s^2', size: 1 };
    const { force, torque } = this.motion.scene;
    return (kind === 'torques' ? torque : force) ?? { unit: kind === 'torques' ? 'N m' : 'N', size: 1 };
  }

  /** Pixels to one unit of a kind, with the slider at `part`, in a picture of some width and so many pixels to the metre. */
  pixels(kind: Kind, part: number, room: number, metre: number): number {
    const scale = this.scale(kind);
    if (scale !== null) return ((part / FIRST) * metre) / scale;
    const most = this.most(kind);
    return most > 0 ? (part * room) / most : 0;
  }

  /** Radius of a torque of the loads, pixels. */
  radius(torque: number): number {
    const most = this.most('torques');
    return most > 0 ? ROUND * Math.min(Math.abs(torque) / most, 1) : 0;
  }

  /** The length of the largest one over the motion; of the torques among the loads, N m. */
  most(kind: Kind | 'torques'): number {
    const known = this.largest.get(kind);
    if (known !== undefined) return known;
    const [own, turns] = kind === 'torques' ? ['loads' as const, true] : [kind, false];
    const lengths = this.motion.sampled(LOOKS).flatMap((place) => this.at(own, place).map(({ along, torque }) => (torque === turns ? Math.hypot(...along) : 0)));
    const most = Math.max(0, ...lengths.filter(Number.isFinite));
    this.largest.set(kind, most);
    return most;
  }

  /** Rates of a place by differences over a part of the way between frames. */
  private rate(point: Place, place: number, kind: Kind): Vector {
    const { motion, pace } = this;
    const step = (pace.seconds(motion.end) - pace.seconds(motion.begin)) / Math.max(motion.scene.frames.at.length - 1, 1);
    const h = kind === 'velocities' ? 0.3 * step : step;
    const t = Math.min(Math.max(pace.seconds(place), pace.seconds(motion.begin) + h), pace.seconds(motion.end) - h);
    const [a, b, c] = [t - h, t, t + h].map((seconds) => [...motion.world(point, pace.place(seconds))] as Vector) as [Vector, Vector, Vector];
    const component = kind === 'velocities' ? (i: 0 | 1 | 2) => (c[i] - a[i]) / (2 * h) : (i: 0 | 1 | 2) => (c[i] - 2 * b[i] + a[i]) / (h * h);
    return [component(0), component(1), component(2)];
  }

  /** World components of a force at a place; none if nothing tells them. */
  private force(arrow: Scene['arrows'][number], place: number): Vector | null {
    const { dimensions, frames } = this.motion.scene;
    // a torque in the plane has its third component alone
    const own = arrow.values ? arrow.values.length / frames.at.length : dimensions;
    const first = own === 1 ? 2 : 0;
    const read = (i: number): number => {
      if (i < first || i >= first + own) return 0;
      const told = arrow.columns[i] !== undefined ? column(this.results, arrow.columns[i]!) : undefined;
      if (told && told.values.length > 1) return (arrow.minus ? -1 : 1) * valueAt(fineOf(this.results), told.values, place);
      if (!arrow.values || arrow.values.length === 0) return NaN;
      let k = 0;
      while (k + 2 < frames.at.length && frames.at[k + 1]! <= place) k++;
      const part = frames.at.length > 1 ? (place - frames.at[k]!) / (frames.at[k + 1]! - frames.at[k]!) : 0;
      const low = arrow.values[k * own + i - first]!;
      return low + (part > 0 ? part * ((arrow.values[(k + 1) * own + i - first] ?? low) - low) : 0);
    };
    const along: Vector = [read(0), read(1), read(2)];
    return along.every(Number.isFinite) ? along : null;
  }
}
