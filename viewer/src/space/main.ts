// A mechanism in space on a canvas: faces from the back to the front, seen from any side.

import { type Arrows, COLOR, type Kind } from '../arrows';
import { Followed, LEAST } from '../follow';
import { type Motion, type Vector, cross } from '../motion';
import { type Named, Names } from '../names';
import { isArea } from '../outlines';
import { cylinder } from '../plane/cylinder';
import { type Bounds, Fits, ROOM, type Tip, fitted, tipsOf } from '../plane/fit';
import { Pen, type Point, toward } from '../plane/pen';
import * as signs from '../plane/signs';
import { pointed } from '../pointed';
import { type Options, PALE, type Renderer } from '../renderer';
import { type Told, scalesHeight, tellScales } from '../scales';
import { type Inks, bodyInks, massInk, mixed, pathInk, rodInks } from '../theme';
import type { Joint } from '../types';
import { bodies } from './bodies';
import { type Sight, front } from './front';
import { type Face, add, ball, dot, facing, scaled, tube, unit } from './vectors';
import { type Line, lines } from './winding';

/** How much darker a face is that is turned away. */
const SHADE = 0.4;
const LOOKS = 48;
const PATH = 400;
/** Width of the axes at the lower left, pixels. */
const AXES = 90;
/** Height of these, and the width of a drawing in which the mechanism stands above them, pixels. */
const AXES_HEIGHT = 70;
/** Room on each side of a picture beyond that which is left around all drawings, pixels. */
const BESIDE = 11;
const NARROW = 480;
/** What lies so much deeper than a face in front of it is hidden by it, as part of the size. */
const MARGIN = 0.04;
/** Joints whose second body slides on a guide of the first. */
const SLIDES = ['slider', 'prismatic', 'cylindrical'];
/** What is drawn of a picture in space, with its distance from the eye. */
interface Item { depth: number; draw(): void }

class Space implements Renderer {
  private readonly pen: Pen;
  private readonly names: Names;
  private readonly followed: Followed;
  /** The middle of all that is seen, beside the body that is followed; with it, at the present place. */
  private middle: Vector = [0, 0, 0];
  private now: Vector = [0, 0, 0];
  private size = 1;
  /** The least that size may be, m. */
  private least = 1e-9;
  private readonly floor: number;
  private readonly up: Vector;
  private readonly level: [Vector, Vector];
  private readonly paths: { name: string; at: number[]; points: Vector[] }[];
  /** Places over the motion, and the width and height that they take in the first view. */
  private seen: Vector[] = [];
  private extent: Point = [1, 1];
  private faces: { of: Inks | null; all: Face[][]; pins: Face[][] } = { of: null, all: [], pins: [] };
  private turn: number;
  private tilt: number;
  private zoomed = 1;
  private shift: Point = [0, 0];
  private place = 0;
  /** Whether paths are shown. */
  private shown = false;
  private right!: Vector;
  private above!: Vector;
  private toEye!: Vector;
  private scale = 1;
  private center: Point = [0, 0];
  private told: Told[] = [];
  /** Directions of the first view, and how the mechanism and the arrows that are shown have room in it. */
  private first: [Vector, Vector] = [[1, 0, 0], [0, 0, 1]];
  private readonly fits = new Fits();

  constructor(context: CanvasRenderingContext2D, private readonly motion: Motion, private readonly arrows: Arrows) {
    this.pen = new Pen(context);
    this.names = new Names(motion, [AXES, AXES_HEIGHT]);
    this.up = unit(motion.scene.up);
    const { level, azimuth, elevation } = motion.scene.view!;
    this.level = level;
    [this.turn, this.tilt] = [azimuth, elevation];
    const at = motion.sampled(PATH);
    this.paths = motion.scene.traces.map((trace) => ({ name: trace.name, at, points: at.map((place) => motion.world(trace, place)) }));
    this.followed = new Followed(motion);
    this.measure();
    this.least = LEAST * this.size;
    this.floor = this.seen.reduce((least, at) => Math.min(least, dot(at, this.up)), this.seen.length > 0 ? Infinity : -0.5);
  }

  follow(name: string | null): void {
    if (!this.followed.take(name)) return;
    this.faces.of = null;
    this.fit();
    this.measure();
  }

  aspect(): number {
    return this.extent[1] / this.extent[0];
  }

  fit(): void {
    const { azimuth, elevation } = this.motion.scene.view!;
    [this.turn, this.tilt, this.zoomed, this.shift] = [azimuth, elevation, 1, [0, 0]];
    this.names.forget();
  }

  zoom(factor: number, x: number, y: number): void {
    const before = this.zoomed;
    this.zoomed = Math.min(Math.max(this.zoomed * factor, 0.2), 100);
    const k = this.zoomed / before;
    const [cx, cy] = this.center;
    this.shift = [x - cx - k * (x - cx - this.shift[0]), y - cy - k * (y - cy - this.shift[1])];
  }

  drag(dx: number, dy: number, turn: boolean): void {
    if (turn) {
      this.turn -= dx * 0.008;
      this.tilt = Math.min(Math.max(this.tilt + dy * 0.008, -1.5), 1.5);
    } else this.shift = [this.shift[0] + dx, this.shift[1] + dy];
  }

  outlook(from?: number[]): number[] {
    const [zoomed, x, y, turn, tilt] = from ?? [];
    if (zoomed !== undefined) [this.zoomed, this.shift, this.turn, this.tilt] = [zoomed, [x ?? 0, y ?? 0], turn ?? this.turn, tilt ?? this.tilt];
    return [this.zoomed, ...this.shift, this.turn, this.tilt];
  }

  named(): Named[] {
    return this.names.drawn;
  }

  unnamed(): string[] {
    return this.names.left;
  }

  pointed(at: Point): string | null {
    const { motion, place } = this;
    const stand = { direction: (body: number, along: Vector) => motion.direction(body, along, place), world: (body: number, own: Vector) => motion.world({ body, at: own }, place) };
    const sight = this.sight();
    const paths = this.shown ? this.paths.map(({ name, points }) => ({ name, points: points.map((p) => this.pixel(p)) })) : [];
    return pointed(motion, place, sight.pixel, paths, at, front(this.faces.all, stand, sight, at, MARGIN * this.size));
  }

  scales(): Told[] {
    return this.told;
  }

  wheels(): [] {
    return [];
  }

  draw(place: number, options: Options, inks: Inks, width: number, height: number): void {
    this.place = place;
    this.shown = options.paths !== 'none';
    this.now = add(this.middle, this.followed.base(place));
    const { pen, motion } = this;
    const pixels = (kind: Kind) => this.arrows.pixels(kind, options.scale, Math.min(width, height), this.scale);
    const look = (foot: number) => {
      this.look();
      this.fitted(options.arrows, [width, height], foot);
    };
    look(0);
    const scales = scalesHeight(pen, this.arrows, options.arrows, pixels, AXES, [width, height]);
    look(width < NARROW ? Math.max(scales, AXES_HEIGHT) : scales);
    pen.on.clearRect(0, 0, width, height);
    this.ground(inks);
    const { all, pins } = this.shapes(inks);
    const seen = motion.scene.joints.filter(signs.seen);
    const before = seen.filter((joint) => this.isCovered(joint, all));
    seen.filter((joint) => !before.includes(joint)).forEach((joint) => this.bearing(joint, inks));
    const bodies = () => {
      const items: Item[] = [];
      all.forEach((faces, body) => faces.forEach((face) => this.face(items, face, body)));
      return items;
    };
    const paint = (items: Item[]) => items.sort((a, b) => a.depth - b.depth).forEach((item) => item.draw());
    for (const behind of motion.behind) {
      this.place = behind;
      pen.faintlyAll(PALE, () => paint(bodies()));
    }
    this.place = place;
    const items = bodies();
    motion.scene.joints.forEach((joint, k) => pins[k]!.forEach((face) => this.face(items, face, joint.a.body)));
    for (const link of motion.scene.links) {
      const { kind, a, b } = link;
      const [p, q] = motion.ends(link, place);
      if (kind === 'rod') {
        this.rod(items, p, q, inks);
        continue;
      }
      const draw = () => (signs.turns(kind) ? signs.turning(pen, kind, [this.pixel(p), this.pixel(q)], [this.turned(a.body), this.turned(b.body)], inks) : signs.link(pen, kind, this.pixel(p), this.pixel(q), cylinder(link, motion, place), inks));
      items.push({ depth: this.depth(scaled(add(p, q), 0.5)), draw });
    }
    for (const gear of motion.scene.gears) lines(gear, motion, place).forEach((line) => this.line(items, line, inks));
    paint(items);
    // over the bodies, as in the figures of the program
    before.forEach((joint) => this.bearing(joint, inks));
    for (const joint of seen) this.marks(joint, inks);
    for (const joint of motion.scene.joints.filter(({ damped }) => damped)) this.dashpot(joint, inks);
    if (options.paths !== 'none') this.drawPaths(options.paths === 'growing', inks);
    for (const kind of options.arrows) this.drawArrows(kind, pixels(kind), inks);
    if (options.names) this.names.draw(pen, place, (at, then) => this.pixel(at, add(this.middle, this.followed.base(then))), [...this.outlook(), this.scale], [width, height], inks, options.paths !== 'none');
    this.axes(height, inks);
    this.told = tellScales(pen, this.arrows, options.arrows, pixels, AXES, [width, height], inks);
  }

  /** Whether the own body of a hinge on the ground would hide its bearing. */
  private isCovered({ kind, a, b }: Joint, all: Face[][]): boolean {
    const { motion, place } = this;
    const body = a.body === 0 ? b.body : b.body === 0 ? a.body : 0;
    if (body === 0 || SLIDES.includes(kind) || !motion.scene.bodies[body]!.shapes.some(isArea)) return false;
    const stand = { direction: (_: number, along: Vector) => motion.direction(body, along, place), world: (_: number, at: Vector) => motion.world({ body, at }, place) };
    return front([all[body]!.filter(({ clear }) => !clear)], stand, this.sight(), this.pixel(motion.world(a, place)), 0) !== null;
  }

  /** From where the faces are seen. */
  private sight(): Sight {
    return { right: this.right, above: this.above, toEye: this.toEye, scale: this.scale, pixel: (seen) => this.pixel(seen), depth: (seen) => this.depth(seen) };
  }

  /** The ground below what it holds. */
  private bearing({ kind, a, b, axis, stroke, beyond }: Joint, inks: Inks): void {
    const at = this.motion.world(a, this.place);
    if (SLIDES.includes(kind) && a.body === 0) {
      const along = unit(this.motion.direction(0, axis, this.place));
      const [from, to] = (stroke ?? [0, 0]).map((s, k) => this.pixel(add(at, along, s + (2 * k - 1) * ((beyond?.[k] ?? 0) + 0.035 * this.size)))) as [Point, Point];
      if (toward(from, to).length > 4) signs.slideway(this.pen, from, to, null, 0, inks);
    } else if (!SLIDES.includes(kind) && (a.body === 0 || b.body === 0)) signs.bearing(this.pen, this.pixel(at), inks);
  }

  /** The stops of a joint, and what drives it. */
  private marks({ kind, a, b, axis, stops, beyond, far, swing, driven, sense }: Joint, inks: Inks): void {
    const along = unit(this.motion.direction(a.body, axis, this.place));
    const seen = (v: Vector): Point => [dot(v, this.right), -dot(v, this.above)];
    const slide = SLIDES.includes(kind) ? toward([0, 0], seen(along)).along : null;
    const at = this.motion.world(a, this.place);
    const reach = (beyond ?? [0, 0]).map((x) => x * Math.hypot(...seen(along)) * this.scale) as Point;
    if (slide) signs.stops(this.pen, stops.map((s) => (s === null ? null : this.pixel(add(at, along, s)))), slide, reach, 0, inks);
    const turned = (own: number[]): signs.Turned => {
      const there = this.motion.direction(a.body, own, this.place);
      return [seen(there), seen(cross(along, there))];
    };
    if (far) signs.ends(this.pen, this.pixel(at), far.map((own) => own && turned(own)), swing ?? null, inks);
    const [u, v] = facing(along, this.toEye, 0.75);
    if (driven) signs.drive(this.pen, this.pixel(slide ? this.motion.world(b, this.place) : at), kind === 'screw' ? null : slide, [seen(u), seen(v)], sense ?? 0, inks);
  }

  /** The damping of a joint. */
  private dashpot({ kind, a, b, axis, back }: Joint, inks: Inks): void {
    const at = this.motion.world(b, this.place);
    const along = this.motion.direction(a.body, axis, this.place);
    const flat: Point = [dot(along, this.right), -dot(along, this.above)];
    const slide = ['slider', 'prismatic'].includes(kind) ? toward([0, 0], flat).along : null;
    signs.dashpot(this.pen, this.pixel(at), slide, (back ?? 0) * Math.hypot(...flat) * this.scale, a.body === 0, inks);
  }

  /** Direction of the x axis of a body in the picture, rad. */
  private turned(body: number): number {
    const x = this.motion.direction(body, [1, 0, 0], this.place);
    return Math.atan2(dot(x, this.above), dot(x, this.right));
  }

  /** Directions of the picture from those of the eye. */
  private look(): void {
    const [x, y] = this.level;
    const level = add(scaled(x, Math.cos(this.turn)), y, Math.sin(this.turn));
    this.right = add(scaled(x, -Math.sin(this.turn)), y, Math.cos(this.turn));
    this.toEye = unit(add(scaled(level, Math.cos(this.tilt)), this.up, Math.sin(this.tilt)));
    this.above = cross(this.toEye, this.right);
  }

  /** How the mechanism and the arrows that are shown have room over the whole motion in the first view, with `foot` pixels below them. */
  private fitted(arrows: Set<Kind>, [width, height]: Point, foot: number): void {
    // the scales of arrows have room of their own below the mechanism
    const size: Point = [width - 2 * BESIDE, height - BESIDE - Math.max(BESIDE, foot - ROOM)];
    const short = Math.min(width, height);
    const [w, h] = this.extent;
    const bounds: Bounds = { low: [-w / 2, -h / 2], high: [w / 2, h / 2] };
    const { scale, middle } = this.fits.of([...arrows, ...size, short].join(), () => fitted(bounds, tipsOf(this.arrows, arrows, short, (kind) => this.tips(kind)), size));
    this.scale = scale * this.zoomed;
    this.center = [middle[0] + BESIDE, middle[1] + BESIDE];
  }

  /** Forces and rates over the motion, in their own unit, with the places at which they are drawn, as they are seen in the first view. */
  private tips(kind: Kind): Tip[] {
    const flat = (v: Vector): Point => [dot(v, this.first[0]), dot(v, this.first[1])];
    return this.motion.sampled(LOOKS).flatMap((place) => {
      const middle = add(this.middle, this.followed.base(place));
      return this.arrows.at(kind, place).filter(({ torque }) => !torque).map(({ from, along }): Tip => ({ at: flat(add(from, middle, -1)), reach: flat(along) }));
    });
  }

  /** Where a point is seen, with its middle as it is at the present place of the motion. */
  private pixel(at: Vector, middle = this.now): Point {
    const from = add(at, middle, -1);
    return [
      this.center[0] + this.shift[0] + dot(from, this.right) * this.scale,
      this.center[1] + this.shift[1] - dot(from, this.above) * this.scale,
    ];
  }

  private depth(at: Vector): number {
    return dot(add(at, this.now, -1), this.toEye);
  }

  /** The middle of all that is drawn over the motion, and how large that is. */
  private measure(): void {
    const [low, high]: [Vector, Vector] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    this.seen = this.motion.sampled(LOOKS).flatMap((place) => [...this.followed.seen(place)]).filter((at) => at.every(Number.isFinite));
    for (const at of this.seen) for (const i of [0, 1, 2] as const) [low[i], high[i]] = [Math.min(low[i], at[i]), Math.max(high[i], at[i])];
    if (this.seen.length === 0) return;
    this.middle = scaled(add(low, high), 0.5);
    this.size = Math.max(Math.hypot(...add(high, low, -1)), this.least);
    this.centre();
  }

  /** The middle and the size of the first view. */
  private centre(): void {
    this.look();
    this.first = [this.right, this.above];
    this.fits.clear();
    const range = (along: Vector): Point => this.seen.reduce<Point>(([low, high], at) => [Math.min(low, dot(at, along)), Math.max(high, dot(at, along))], [Infinity, -Infinity]);
    const [across, upwards] = [range(this.right), range(this.above)];
    const least = 0.05 * this.size;
    this.extent = [Math.max(across[1] - across[0], least), Math.max(upwards[1] - upwards[0], least)];
    const from = (along: Vector, [low, high]: Point) => (low + high) / 2 - dot(this.middle, along);
    this.middle = add(add(this.middle, this.right, from(this.right, across)), this.above, from(this.above, upwards));
  }

  /** Faces of bodies and joints in the colours of the page; made once for each. */
  private shapes(inks: Inks): { all: Face[][]; pins: Face[][] } {
    if (this.faces.of?.paper !== inks.paper) {
      const { scene } = this.motion;
      const colors = (body: number) => ({ body: bodyInks(scene.bodies[body]!.color, inks).fill, mass: massInk(inks) });
      const all = bodies(scene, this.size, colors);
      const pins = scene.joints.map((joint) => this.pin(joint, inks));
      scene.joints.forEach((joint) => all[joint.b.body]!.push(...this.slideBox(joint, inks), ...this.otherArm(joint, inks)));
      this.faces = { of: inks, all, pins };
    }
    return this.faces;
  }

  /** What shows a joint: a short round pin along its axis, a knob without one. */
  private pin({ kind, a, axis, stroke, driven, telescopes }: Joint, inks: Inks): Face[] {
    if (telescopes || kind === 'distance' || kind === 'free' || kind === 'fixed') return [];
    const at: Vector = [a.at[0] ?? 0, a.at[1] ?? 0, a.at[2] ?? 0];
    const color = driven ? inks.accent : mixed(inks.ink, inks.paper, 0.35);
    const r = 0.017 * this.size;
    if (kind === 'spherical' || axis.length < 3) return ball(at, 1.35 * r, color);
    const along = unit([axis[0]!, axis[1]!, axis[2]!]);
    if (kind === 'universal') return this.arm(at, along, color);
    // a thread: rings on a core
    if (kind === 'screw') return [...tube(add(at, along, -3 * r), add(at, along, 3 * r), 0.75 * r, 0.75 * r, 12, color),
      ...[-2.2, -1.1, 0, 1.1, 2.2].flatMap((k) => tube(add(at, along, (k - 0.25) * r), add(at, along, (k + 0.25) * r), 1.3 * r, 1.3 * r, 12, color))];
    // a piece of the plane
    if (kind === 'planar') return tube(add(at, along, -0.1 * r), add(at, along, 0.1 * r), 4 * r, 4 * r, 4, color);
    if (!SLIDES.includes(kind) && kind !== 'cylindrical') return tube(add(at, along, -1.9 * r), add(at, along, 1.9 * r), r, r, 12, color);
    // a guide in the colour of the body that it belongs to
    const [low, high] = stroke ?? [0, 0];
    const own = a.body === 0 ? mixed(inks.paper, inks.faint, 0.7) : bodyInks(this.motion.scene.bodies[a.body]!.color, inks).edge;
    return tube(add(at, along, low - 2 * r), add(at, along, high + 2 * r), 0.35 * r, 0.35 * r, 10, own);
  }

  /** One of the two arms of the cross in a universal joint. */
  private arm(at: Vector, along: Vector, color: string): Face[] {
    const r = 0.017 * this.size;
    return tube(add(at, along, -2.2 * r), add(at, along, 2.2 * r), 0.6 * r, 0.6 * r, 12, color);
  }

  /** The arm that the second body holds. */
  private otherArm({ kind, b, second, driven }: Joint, inks: Inks): Face[] {
    if (kind !== 'universal' || second?.length !== 3) return [];
    const color = driven ? inks.accent : mixed(inks.ink, inks.paper, 0.35);
    return this.arm([b.at[0] ?? 0, b.at[1] ?? 0, b.at[2] ?? 0], unit([second[0]!, second[1]!, second[2]!]), color);
  }

  /** The box of a slide on its guide; round if it turns about that as well. */
  private slideBox({ kind, a, b, axis, driven }: Joint, inks: Inks): Face[] {
    const turns = kind === 'cylindrical';
    if (!(turns || SLIDES.includes(kind)) || axis.length < 3) return [];
    // neither turns its body across the axis
    const world = this.motion.direction(a.body, axis, this.motion.from);
    const own = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]] as Vector[]).map((e) => dot(this.motion.direction(b.body, e, this.motion.from), world)) as Vector;
    const at: Vector = [b.at[0] ?? 0, b.at[1] ?? 0, b.at[2] ?? 0];
    const r = 0.017 * this.size;
    return tube(add(at, own, -1.5 * r), add(at, own, 1.5 * r), 1.2 * r, 1.2 * r, turns ? 14 : 4, driven ? inks.accent : mixed(inks.ink, inks.paper, 0.5));
  }

  /** A rod without mass. */
  private rod(items: Item[], from: Vector, to: Vector, inks: Inks): void {
    const { fill, edge } = rodInks(inks);
    const [width, pieces] = [Math.max(0.022 * this.size * this.scale, 3), 8];
    const at = (k: number) => add(from, add(to, from, -1), k / pieces);
    for (let k = 0; k < pieces; k++) {
      const ends = [at(k), at(k + 1)].map((p) => this.pixel(p));
      items.push({ depth: this.depth(at(k + 0.5)), draw: () => this.pen.path(ends).stroke(edge, width).path(ends).stroke(fill, width - 2) });
    }
  }

  /** A face that is seen, in light from the eye and from above. */
  private face(items: Item[], { points, normal, color, edged, clear }: Face, body: number): void {
    const out = this.motion.direction(body, normal, this.place);
    if (dot(out, this.toEye) <= 0) return;
    const world = points.map((at) => this.motion.world({ body, at }, this.place));
    const middle = scaled(world.reduce((sum, p) => add(sum, p), [0, 0, 0] as Vector), 1 / world.length);
    const bright = 0.5 * dot(out, this.toEye) + 0.5 * Math.max(0, dot(out, this.up));
    const lit = clear ? color : mixed(color, '#000000', SHADE * (1 - bright));
    items.push({
      depth: this.depth(middle),
      // a hair's breadth of the face's own colour closes the gap between neighbours
      draw: () => clear ? this.pane(world, lit, edged) : this.pen.path(world.map((p) => this.pixel(p)), true).fill(lit).stroke(edged ? mixed(lit, '#000000', 0.18) : lit, edged ? 0.8 : 0.6),
    });
  }

  /** A line, piece by piece, a little in front of the wheel on which it lies. */
  private line(items: Item[], { points, thin }: Line, inks: Inks): void {
    points.slice(1).forEach((point, k) => {
      const from = points[k]!;
      const draw = () => this.pen.path([this.pixel(from), this.pixel(point)]).stroke(inks.soft, thin ? 1.1 : 2.6);
      items.push({ depth: this.depth(scaled(add(from, point), 0.5)) + 0.01 * this.size, draw });
    });
  }

  /** A face that is seen through, with a clear rim if it is edged. */
  private pane(world: Vector[], lit: string, edged: boolean): void {
    const { pen } = this;
    pen.faintly(0.42, () => pen.path(world.map((p) => this.pixel(p)), true).fill(lit));
    if (edged) pen.stroke(mixed(lit, '#000000', 0.3), 1.6);
  }

  /** A grid below the mechanism. */
  private ground(inks: Inks): void {
    const [x, y] = this.level;
    const reach = 0.75 * this.size;
    const power = 10 ** Math.floor(Math.log10(reach / 3));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= reach / 6) ?? power;
    const [cx, cy] = [dot(this.now, x), dot(this.now, y)];
    const at = (u: number, v: number) => this.pixel(add(add(scaled(x, u), y, v), this.up, this.floor - 0.02 * this.size));
    for (let k = Math.ceil((cx - reach) / step); k * step <= cx + reach; k++) this.pen.path([at(k * step, cy - reach), at(k * step, cy + reach)]).stroke(inks.grid, 1);
    for (let k = Math.ceil((cy - reach) / step); k * step <= cy + reach; k++) this.pen.path([at(cx - reach, k * step), at(cx + reach, k * step)]).stroke(inks.grid, 1);
  }

  private drawPaths(growing: boolean, inks: Inks): void {
    this.paths.forEach(({ at, points }, k) => {
      const color = pathInk(k, inks);
      points.slice(1).forEach((point, i) => {
        const done = !growing || (this.motion.falls ? at[i]! >= this.place : at[i + 1]! <= this.place);
        const ink = done ? color : mixed(inks.paper, color, 0.3);
        this.pen.path([this.pixel(points[i]!), this.pixel(point)]).stroke(ink, done ? 2 : 1.2);
      });
    });
  }

  private drawArrows(kind: Kind, pixels: number, inks: Inks): void {
    const color = inks.curves[COLOR[kind]]!;
    for (const { from, along, torque } of this.arrows.at(kind, this.place)) {
      if (torque) this.torque(kind, from, along, color);
      else this.pen.arrow(this.pixel(from), this.pixel(add(from, along, pixels / this.scale)), color, 2.2);
    }
  }

  /** A torque about its axis, which has its middle on the side near to the eye. */
  private torque(kind: Kind, from: Vector, along: Vector, color: string): void {
    const size = Math.hypot(...along);
    if (!(size > 0)) return;
    const [u, v] = facing(unit(along), this.toEye, 0.75 * 2 * Math.PI).map((e): Point => [dot(e, this.right), -dot(e, this.above)]) as [Point, Point];
    this.pen.turn(this.pixel(from), [u, v], 1, this.arrows.radius(kind, size), color);
  }

  /** The axes of the world at the lower left. */
  private axes(height: number, inks: Inks): void {
    const origin: Point = [38, height - 34];
    const names = ['x', 'y', 'z'];
    const ends = names.map((name, i) => {
      const e: Vector = [Number(i === 0), Number(i === 1), Number(i === 2)];
      return { name, depth: dot(e, this.toEye), to: [origin[0] + 24 * dot(e, this.right), origin[1] - 24 * dot(e, this.above)] as Point };
    });
    for (const { name, to } of ends.sort((a, b) => a.depth - b.depth)) {
      const { along } = toward(origin, to);
      this.pen.arrow(origin, to, inks.soft, 1.4);
      this.pen.text(name, [to[0] + along[0] * 8 - 3, to[1] + along[1] * 8 + 4], inks.soft, inks.paper, 11);
    }
  }
}

window.grashofSpace = (context, motion, arrows) => new Space(context, motion, arrows);
