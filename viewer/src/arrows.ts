// Arrows on a mechanism: velocities, accelerations, loads, reactions.

import { column, fineOf, valueAt } from './curves';
import type { Motion, Vector } from './motion';
import type { Pace } from './pace';
import { FIRST } from './renderer';
import type { ArrowKind, Place, Results, Scene } from './types';

export type Kind = 'velocities' | 'accelerations' | 'loads' | 'reactions';
export const KINDS: Kind[] = ['velocities', 'accelerations', 'loads', 'reactions'];
/** The curve colour of each kind. */
export const COLOR: Record<Kind, number> = { velocities: 2, accelerations: 4, loads: 1, reactions: 0 };

/** The kind of what turns: torques of loads, moments of reactions. */
export type Turning = 'torques' | 'moments';
export const TURNING: Partial<Record<Kind, Turning>> = { loads: 'torques', reactions: 'moments' };

const ofJoint = (kind: ArrowKind) => kind === 'reaction' || kind === 'moment';
const turns = (kind: ArrowKind) => kind === 'torque' || kind === 'moment';

/** Of a torque `along` is its vector, N m, and it turns about it. */
export interface Arrow { kind: Kind; from: Vector; along: Vector; torque: boolean }

/** Radius of the largest torque, pixels. */
export const ROUND = 18;

/** Part of the forces times the size of the mechanism below which a moment is round-off. */
const ROUND_OFF = 1e-9;

/** Times by which the largest force of one kind is beyond that of the other so that they have scales of their own. */
const SPECKS = 10;
/** Places at which the largest arrow is looked for. */
const LOOKS = 90;

/** Joints whose two points need not be at one place. */
const SLIDES = ['slider', 'prismatic', 'cylindrical', 'screw', 'pin-in-slot', 'planar', 'distance'];

export class Arrows {
  private readonly largest = new Map<Kind | Turning, number>();
  private readonly moving: Place[];
  /** Those of the scene, and of joints whose reactions are columns of the table. */
  private readonly forces: Scene['arrows'];

  constructor(private readonly motion: Motion, private readonly results: Results, private readonly pace: Pace) {
    const { joints, traces, arrows, dimensions } = motion.scene;
    const told = ({ name, a, b, on_ground: minus }: Scene['joints'][number]): Scene['arrows'] => {
      if (arrows.some((arrow) => arrow.name === name)) return [];
      const both = { reaction: ['fx', 'fy', 'fz'].slice(0, dimensions), moment: dimensions === 2 ? ['m'] : ['mx', 'my', 'mz'] };
      return (['reaction', 'moment'] as const).flatMap((kind) => {
        const columns = both[kind].map((axis) => `${name}.${axis}`);
        // moments are about the point on the second body, which is not drawn where that is the ground
        if (!columns.every((own) => column(results, own)) || (kind === 'moment' && minus)) return [];
        return [{ name, kind, ...(b.body === 0 ? a : b), columns, minus, values: null, scale: null }];
      });
    };
    this.forces = [...arrows, ...joints.flatMap(told)];
    const seen = new Set<string>();
    const fresh = ({ body, at, apart }: Place & { apart?: boolean }) => {
      const point = this.motion.world({ body, at }, this.motion.from).map((x) => x.toFixed(6)).join() + (apart ? ` ${body}` : '');
      return body !== 0 && !seen.has(point) && seen.add(point);
    };
    // both sides of a slide, which move apart
    const ends = ({ kind, a, b }: Scene['joints'][number]) => (SLIDES.includes(kind) ? [a, b].map((end) => ({ ...end, apart: true })) : [a.body === 0 ? b : a]);
    this.moving = [...joints.flatMap(ends), ...traces].filter(fresh);
  }

  /** Kinds that there are. */
  kinds(): Kind[] {
    // none where a motion ends at a dead point
    const has = (kind: Kind) => this.motion.sampled(LOOKS).some((place) => this.at(kind, place).length > 0);
    const moves = this.motion.scene.frames.at.length > 3;
    return KINDS.filter((kind) => (kind === 'loads' || kind === 'reactions' ? has(kind) : moves && this.pace.real));
  }

  /** Arrows of a kind at a place, in their own unit. */
  at(kind: Kind, place: number): Arrow[] {
    if (kind === 'velocities' || kind === 'accelerations') return this.moving.map((point) => ({ kind, from: this.motion.world(point, place), along: this.rate(point, place, kind), torque: false }));
    return this.forces.flatMap((arrow) => {
      if (ofJoint(arrow.kind) !== (kind === 'reactions')) return [];
      const along = this.force(arrow, place);
      return along ? [{ kind, from: this.motion.world(arrow, place), along, torque: turns(arrow.kind) }] : [];
    });
  }

  /** Kinds that the model asks to be shown. */
  asked(): Kind[] {
    const { arrows } = this.motion.scene;
    return (['loads', 'reactions'] as const).filter((kind) => arrows.some((arrow) => ofJoint(arrow.kind) === (kind === 'reactions')));
  }

  /** Force per length that the model gives a kind, N/m. */
  scale(kind: Kind): number | null {
    if (kind !== 'loads' && kind !== 'reactions') return null;
    const of = this.motion.scene.arrows.find((arrow) => arrow.scale !== null && ofJoint(arrow.kind) === (kind === 'reactions'));
    return of?.scale ?? null;
  }

  /** The unit of a kind, and its size in SI: of forces those that the model asks for. */
  unit(kind: Kind | Turning): { unit: string; size: number } {
    if (kind === 'velocities' || kind === 'accelerations') return { unit: kind === 'velocities' ? 'm/s' : 'm/s^2', size: 1 };
    const { force, torque } = this.motion.scene;
    const turning = kind === 'torques' || kind === 'moments';
    return (turning ? torque : force) ?? { unit: turning ? 'N m' : 'N', size: 1 };
  }

  /** Whether there are gears, racks or ropes, whose forces act along coordinates, so that no bearing feels them. */
  geared(): boolean {
    return this.motion.scene.gears.length > 0;
  }

  /** Pixels to one unit of a kind, with the slider at `part`, in a picture of some width and so many pixels to the metre. */
  pixels(kind: Kind, part: number, room: number, metre: number): number {
    const scale = this.scale(kind);
    if (scale !== null) return ((part / FIRST) * metre) / scale;
    const own = this.most(kind);
    // one scale for loads and reactions, unless the arrows of one would be specks
    const both = kind === 'loads' || kind === 'reactions' ? Math.max(this.most('loads'), this.most('reactions')) : own;
    const most = own * SPECKS >= both ? both : own;
    return most > 0 ? (part * room) / most : 0;
  }

  /** Radius of a torque of a kind, pixels. */
  radius(kind: Kind, torque: number): number {
    const turning = TURNING[kind];
    const most = turning ? this.most(turning) : 0;
    return most > 0 ? ROUND * Math.min(Math.abs(torque) / most, 1) : 0;
  }

  /** The length of the largest one over the motion; of what turns, N m. */
  most(kind: Kind | Turning): number {
    const known = this.largest.get(kind);
    if (known !== undefined) return known;
    const turning = kind === 'torques' || kind === 'moments';
    const own = turning ? (kind === 'torques' ? 'loads' : 'reactions') : kind;
    const lengths = this.motion.sampled(LOOKS).flatMap((place) => this.at(own, place).map(({ along, torque }) => (torque === turning ? Math.hypot(...along) : 0)));
    let most = Math.max(0, ...lengths.filter(Number.isFinite));
    // a moment may be the difference of forces times their arms
    if (kind === 'moments' && most <= ROUND_OFF * this.most('reactions') * this.reach()) most = 0;
    this.largest.set(kind, most);
    return most;
  }

  /** How far joints are from the first one at the beginning, m. */
  private reach(): number {
    const places = this.motion.scene.joints.map(({ a }) => [...this.motion.world(a, this.motion.from)]);
    return Math.max(0, ...places.map((p) => Math.hypot(...p.map((x, i) => x - places[0]![i]!))));
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
    const first = dimensions === 2 && turns(arrow.kind) ? 2 : 0;
    const own = first === 2 ? 1 : dimensions;
    const read = (i: number): number => {
      if (i < first || i >= first + own) return 0;
      const told = arrow.columns[i - first] !== undefined ? column(this.results, arrow.columns[i - first]!) : undefined;
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
