// A mechanism in the plane on a canvas.

import { type Arrows, COLOR, type Kind } from '../arrows';
import { Followed, LEAST } from '../follow';
import type { Motion } from '../motion';
import { type Named, Names } from '../names';
import { isArea } from '../outlines';
import { pointed } from '../pointed';
import { type Options, PALE, type Renderer } from '../renderer';
import { type Told, scalesHeight, tellScales } from '../scales';
import { ROD, type Stages, stagesOf } from '../telescope';
import { type Inks, PATHS, bodyInks, massInk, mixed, pathInk, rodInks } from '../theme';
import type { Gear, Joint, Link, Place, Shape, Trace, Wheel } from '../types';
import { cylinder } from './cylinder';
import { type Bounds, Fits, type Fitted, type Tip, fitted, tipsOf } from './fit';
import { LEVEL, Pen, type Point, hull, off, toward } from './pen';
import * as signs from './signs';

/** Width of a bar whose true one the model does not give, in pixels. */
const BAR = 15;
/** Least height or width of what is seen, as a part of the other. */
const FLATTEST = 0.2;
/** Least radius of a point mass, which is no pin, pixels. */
const MASS = 7.5;
/** Room below the mechanism for the scale and for the largest symbol of a joint, pixels. */
const BELOW = 38;
/** About where the scale of lengths ends. */
const BAR_ROOM = 200;
/** Behind a wheel the guide would not be seen. */
const isGuidedByGround = ({ kind, a }: Joint) => kind === 'slider' && a.body === 0;
/** Frames of which the bounds are taken, and points of a path. */
const LOOKS = 72;
const PATH = 400;
/** Teeth that are closer are not drawn, pixels. */
const CLOSE = 4;
/** Dashes of the first five paths, the next five, and so on. */
const DASHES = [[], [8, 4], [2, 4], [10, 3, 2, 3]];

type Toothed = Extract<Shape, { kind: 'gear' }>;

/** Large plates lie under small ones and under bars; a disc is as large as the square around it. */
function depth(shape: Shape): number {
  switch (shape.kind) {
    case 'mass': return Number.MAX_VALUE;
    case 'disc': case 'gear': case 'sphere': return -Math.sqrt(8) * Math.abs(shape.radius);
    case 'box': return -Math.hypot(shape.size[0] ?? 0, shape.size[1] ?? 0);
    case 'hull': case 'polygon': {
      const span = (i: number) => Math.max(...shape.points.map((p) => p[i]!)) - Math.min(...shape.points.map((p) => p[i]!));
      const size = Math.hypot(span(0), span(1));
      // points on one line are a bar
      return shape.kind === 'polygon' || hull(shape.points.map(([x, y]) => [x! / size, y! / size])).length > 2 ? -size : 0;
    }
    default: return 0;
  }
}

export class Plane implements Renderer {
  private readonly pen: Pen;
  private readonly followed: Followed;
  private bounds: Bounds;
  /** The least size of what is seen, m. */
  private least = 1e-9;
  private readonly stages: Stages;
  private readonly paths: { trace: Trace; at: number[]; points: Point[] }[];
  private scale = 0;
  private zoomed = 1;
  private shift: Point = [0, 0];
  private middle: Point = [0, 0];
  private readonly fits = new Fits();
  private place = 0;
  /** Whether paths are shown. */
  private shown = false;
  private readonly names: Names;
  private inks!: Inks;
  private told: Told[] = [];

  constructor(context: CanvasRenderingContext2D, private readonly motion: Motion, private readonly arrows: Arrows) {
    this.pen = new Pen(context);
    this.names = new Names(motion);
    this.followed = new Followed(motion);
    this.stages = stagesOf(motion.scene);
    this.bounds = this.measure();
    const { low, high } = this.bounds;
    this.least = LEAST * Math.max(high[0] - low[0], high[1] - low[1]);
    const at = motion.sampled(PATH);
    this.paths = motion.scene.traces.map((trace) => ({ trace, at, points: at.map((place) => motion.world(trace, place).slice(0, 2) as Point) }));
  }

  follow(name: string | null): void {
    if (!this.followed.take(name)) return;
    this.bounds = this.measure();
    this.fits.clear();
    this.fit();
  }

  aspect(): number {
    const { low, high } = this.bounds;
    return (high[1] - low[1]) / (high[0] - low[0] || 1);
  }

  fit(): void {
    [this.zoomed, this.shift] = [1, [0, 0]];
    this.names.forget();
  }

  zoom(factor: number, x: number, y: number): void {
    const before = this.zoomed;
    this.zoomed = Math.min(Math.max(this.zoomed * factor, 0.2), 200);
    const k = this.zoomed / before;
    this.shift = [x - this.middle[0] - k * (x - this.middle[0] - this.shift[0]), y - this.middle[1] - k * (y - this.middle[1] - this.shift[1])];
  }

  drag(dx: number, dy: number): void {
    this.shift = [this.shift[0] + dx, this.shift[1] + dy];
  }

  outlook(from?: number[]): number[] {
    const [zoomed, x, y] = from ?? [];
    if (zoomed !== undefined) [this.zoomed, this.shift] = [zoomed, [x ?? 0, y ?? 0]];
    return [this.zoomed, ...this.shift];
  }

  named(): Named[] {
    return this.names.drawn;
  }

  unnamed(): string[] {
    return this.names.left;
  }

  pointed(at: Point): string | null {
    return pointed(this.motion, this.place, ([x, y]) => this.pixel(x, y), this.shown ? this.paths.map(({ trace, points }) => ({ name: trace.name, points: points.map(([x, y]) => this.pixel(x, y)) })) : [], at);
  }

  scales(): Told[] {
    return this.told;
  }

  wheels(): { body: string; teeth: number; outline: Point[] }[] {
    const { bodies, gears } = this.motion.scene;
    const toothed = (body: number) => bodies[body]!.shapes.flatMap((shape) => (shape.kind === 'gear' ? [shape] : []));
    const wheels = bodies.flatMap(({ name }, body) => toothed(body).map((wheel) => ({ body: name, teeth: wheel.teeth, outline: this.outline(body, wheel) })));
    const racks = gears.filter(({ kind }) => kind === 'rack').flatMap(({ a, b }) => {
      const [shape, { name }] = [bodies[b.body]!.shapes[0], bodies[b.body]!];
      return shape?.kind === 'polygon' ? toothed(a.body).map(({ teeth }) => ({ body: name, teeth, outline: shape.points.map((at) => this.point({ body: b.body, at })) })) : [];
    });
    return [...wheels, ...racks];
  }

  draw(place: number, options: Options, inks: Inks, width: number, height: number): void {
    this.place = place;
    this.inks = inks;
    this.shown = options.paths !== 'none';
    const { pen } = this;
    const short = Math.min(width, height);
    const pixels = (kind: Kind) => this.arrows.pixels(kind, options.scale, short, this.scale);
    const fit = (below: number) => {
      const { scale, middle } = this.fitted(options.arrows, [width, height - below], short);
      [this.scale, this.middle] = [scale * this.zoomed, middle];
    };
    fit(BELOW);
    const scales = scalesHeight(pen, this.arrows, options.arrows, pixels, BAR_ROOM, [width, height]);
    if (scales > BELOW) fit(scales);
    pen.on.clearRect(0, 0, width, height);
    const { scene } = this.motion;
    // boxes lie under the bodies that slide, slots on those that they are cut into
    this.guides(scene.joints.filter((joint) => !isGuidedByGround(joint)));
    // what is large lies below
    const shapes = scene.bodies.flatMap((body, index) => body.shapes.map((shape) => ({ depth: depth(shape) || this.stages.within[index]! * Number.MIN_VALUE, draw: () => this.shape(index, shape) })));
    const rods = scene.links.filter(({ kind }) => kind === 'rod').map((rod) => ({ depth: 0, draw: () => this.rod(rod) }));
    const bodies = [...shapes, ...rods].sort((a, b) => a.depth - b.depth);
    for (const behind of this.motion.behind) {
      this.place = behind;
      pen.faintlyAll(PALE, () => bodies.forEach((one) => one.draw()));
    }
    this.place = place;
    // guides on the ground and bearings stand in front of all that has an outline, and behind bars
    const standing = () => {
      this.guides(scene.joints.filter(isGuidedByGround));
      this.bearings();
    };
    [...bodies, { depth: -Number.MIN_VALUE, draw: standing }].sort((a, b) => a.depth - b.depth).forEach((one) => one.draw());
    scene.joints.forEach((joint) => this.slot(joint));
    scene.gears.forEach((gear) => this.wound(gear));
    scene.links.filter(({ kind }) => kind !== 'rod').forEach((link) => this.link(link));
    // over the bodies, as in the figures of the program, and under the pins
    if (options.paths !== 'none') this.drawPaths(options.paths === 'growing');
    scene.joints.forEach((joint) => this.sign(joint));
    // over the pins of other joints
    scene.joints.forEach((joint) => this.marks(joint));
    scene.joints.forEach((joint) => this.dashpot(joint));
    for (const { kind, a, b } of scene.links) if (kind === 'rod') for (const end of [a, b]) signs.pin(pen, 'revolute', this.point(end), false, inks);
    for (const kind of options.arrows) this.drawArrows(kind, pixels(kind));
    if (options.names) this.names.draw(pen, place, ([x, y], at) => this.pixel(x, y, at), [this.scale, ...this.shift], [width, height], inks, options.paths !== 'none');
    this.told = tellScales(pen, this.arrows, options.arrows, pixels, this.bar(height), [width, height], inks);
  }

  /** How the mechanism and the arrows that are shown have room over the whole motion; the slider of their length moves nothing else. */
  private fitted(arrows: Set<Kind>, size: Point, short: number): Fitted {
    return this.fits.of([...arrows, ...size, short].join(), () => fitted(this.bounds, tipsOf(this.arrows, arrows, short, (kind) => this.tips(kind)), size));
  }

  /** Forces and rates over the motion, in their own unit, with the places at which they are drawn. */
  private tips(kind: Kind): Tip[] {
    return this.motion.sampled(LOOKS).flatMap((place) => {
      const [x, y] = this.followed.base(place);
      return this.arrows.at(kind, place).filter(({ torque }) => !torque).map(({ from, along }): Tip => ({ at: [from[0] - x, from[1] - y], reach: [along[0], along[1]] }));
    });
  }

  /** A wheel with its teeth. */
  private wheel(body: number, wheel: Toothed): void {
    const { fill, edge } = this.colors(body);
    const radius = Math.abs(wheel.radius) * this.scale;
    const points = (2 * Math.PI * radius) / wheel.teeth > CLOSE ? this.outline(body, wheel) : [];
    const around = wheel.rim === undefined ? null : wheel.rim * this.scale;
    signs.gear(this.pen, this.point({ body, at: wheel.center }), radius, points, this.along(body, [1, 0]), around, this.paler(fill, 0.7), edge);
  }

  private outline(body: number, { outline }: Toothed): Point[] {
    return outline.map((at) => this.point({ body, at }));
  }

  /** Belts around wheels, ropes that leave their drums, pitch circles and lines of what has no teeth. */
  private wound({ kind, a, b }: Gear): void {
    const [ra, rb] = [a.radius, b.radius].map((radius) => Math.abs(radius) * this.scale) as [number, number];
    const bare = ({ body }: Wheel) => !this.motion.scene.bodies[body]!.shapes.some((shape) => shape.kind === 'gear');
    const wheels = kind === 'teeth' ? [a, b] : kind === 'rack' ? [a] : [];
    for (const wheel of wheels.filter(bare)) signs.pitch(this.pen, this.point(wheel), Math.abs(wheel.radius) * this.scale, wheel.radius < 0, this.inks);
    if (kind === 'rack' && bare(a)) {
      const [center, from, along] = [this.point(a), this.point(b), this.along(b.body, b.axis?.length ? b.axis : [1, 0])];
      const at = (center[0] - from[0]) * along[0] + (center[1] - from[1]) * along[1];
      signs.pitchLine(this.pen, off(from, along, at - 2 * ra, 0), off(from, along, at + 2 * ra, 0), this.inks);
    }
    if (kind === 'belt') signs.belt(this.pen, this.point(a), ra, this.point(b), rb, this.inks);
    if (kind === 'rope') signs.rope(this.pen, this.point(a), ra, this.point(b), this.along(b.body, b.axis?.length ? b.axis : [1, 0]), this.inks);
  }

  /** A rod without mass: a bar. */
  private rod({ a, b }: Link): void {
    const { fill, edge } = rodInks(this.inks);
    this.rounded([this.point(a), this.point(b)], BAR, fill, edge);
  }

  /** A spring or damper, with the ground at its ends where no joint has its bearing. */
  private link(link: Link): void {
    const { kind, a, b } = link;
    const [from, to] = this.motion.ends(link, this.place).map(([x, y]) => this.pixel(x, y)) as [Point, Point];
    if (signs.turns(kind)) {
      signs.turning(this.pen, kind, [from, to], [a, b].map(({ body }) => this.motion.angle(body, this.place)) as Point, this.inks);
      return;
    }
    const bearings = this.motion.scene.joints.filter((joint) => signs.seen(joint) && (joint.a.body === 0 || joint.b.body === 0)).map((joint) => this.point(signs.slides(joint) ? joint.b : joint.a));
    for (const [end, other, body] of [[from, to, a.body], [to, from, b.body]] as const) {
      if (body === 0 && !bearings.some((at) => Math.hypot(at[0] - end[0], at[1] - end[1]) < 1)) signs.anchor(this.pen, end, toward(other, end).along, this.inks);
    }
    signs.link(this.pen, kind, from, to, cylinder(link, this.motion, this.place), this.inks);
  }

  /** Where a point is seen at a place of the motion, the present one. */
  private pixel(x: number, y: number, place = this.place): Point {
    const { low, high } = this.bounds;
    const [baseX, baseY] = this.followed.base(place);
    return [
      this.middle[0] + this.shift[0] + (x - baseX - (low[0] + high[0]) / 2) * this.scale,
      this.middle[1] + this.shift[1] - (y - baseY - (low[1] + high[1]) / 2) * this.scale,
    ];
  }

  private point(at: Place): Point {
    const [x, y] = this.motion.world(at, this.place);
    return this.pixel(x, y);
  }

  private along(body: number, direction: number[]): Point {
    const [x, y] = this.motion.direction(body, direction, this.place);
    return [x, -y];
  }

  /** Bounds of all that is drawn over the whole motion; of the ground the joints alone. */
  private measure(): Bounds {
    const [low, high]: [Point, Point] = [[Infinity, Infinity], [-Infinity, -Infinity]];
    for (const place of this.motion.sampled(LOOKS)) {
      for (const at of this.followed.seen(place)) {
        for (const i of [0, 1] as const) {
          if (!Number.isFinite(at[i])) continue;
          low[i] = Math.min(low[i], at[i]);
          high[i] = Math.max(high[i], at[i]);
        }
      }
    }
    if (low[0] > high[0]) return { low: [-1, -1], high: [1, 1] };
    const size = Math.max(high[0] - low[0], high[1] - low[1], this.least);
    for (const i of [0, 1] as const) {
      const lacking = (size > this.least ? FLATTEST : 1) * size - (high[i] - low[i]);
      if (lacking > 0) [low[i], high[i]] = [low[i] - lacking / 2, high[i] + lacking / 2];
    }
    return { low, high };
  }

  private drawPaths(growing: boolean): void {
    const { pen, inks } = this;
    this.paths.forEach(({ trace, at, points }, k) => {
      const [color, dash] = [pathInk(k, inks), DASHES[Math.floor(k / PATHS) % DASHES.length]!];
      const all = points.map(([x, y]) => this.pixel(x, y));
      pen.path(all).stroke(growing ? mixed(inks.paper, color, 0.45) : color, growing ? 1.2 : 1.6, dash);
      if (!growing) return;
      const until = at.findIndex((place) => place > this.place);
      const split = until < 0 ? all.length : until;
      const passed = this.motion.falls ? all.slice(split).reverse() : all.slice(0, split);
      pen.path([...passed, this.point(trace)]).stroke(color, 1.6, dash);
    });
  }

  private colors(body: number): { fill: string; edge: string } {
    return bodyInks(this.motion.scene.bodies[body]!.color, this.inks);
  }

  /** What is large is paler, as in the figures. */
  private paler(fill: string, part: number): string {
    return mixed(this.inks.paper, fill, part);
  }

  private shape(body: number, shape: Shape): void {
    const { pen } = this;
    const { fill, edge } = this.colors(body);
    const points = (list: number[][]) => list.map((at) => this.point({ body, at }));
    switch (shape.kind) {
      case 'bar':
      case 'cylinder': {
        const width = shape.kind === 'bar' ? shape.width : 2 * shape.radius;
        this.rounded(points([shape.from, shape.to]), Math.max((width ?? 0) * this.scale, this.bare(body)), fill, edge);
        break;
      }
      case 'hull': {
        const outline = hull(points(shape.points));
        if (outline.length > 0) this.rounded(outline, outline.length > 2 ? BAR : this.bare(body), outline.length > 2 ? this.paler(fill, 0.7) : fill, edge);
        break;
      }
      case 'polygon':
        pen.path(points(shape.points), true).fill(this.paler(fill, 0.85)).stroke(edge, 1.5);
        break;
      case 'box': {
        const [w, h] = [(shape.size[0] ?? 0) / 2, (shape.size[1] ?? 0) / 2];
        const [x, y] = [shape.center[0] ?? 0, shape.center[1] ?? 0];
        pen.path(points([[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]]), true).fill(this.paler(fill, 0.85)).stroke(edge, 1.5);
        break;
      }
      case 'gear':
        this.wheel(body, shape);
        break;
      case 'mass':
        pen.circle(this.point({ body, at: shape.at }), Math.max(shape.radius * this.scale, MASS)).fill(massInk(this.inks)).stroke(this.inks.ink, 1.2);
        break;
      default: {
        const center = this.point({ body, at: shape.center });
        const radius = Math.max(shape.radius * this.scale, 3);
        pen.circle(center, radius).fill(this.paler(fill, 0.7)).stroke(edge, 1.5);
        // a disc that turns is seen to turn
        pen.path([center, off(center, this.along(body, [1, 0]), radius, 0)]).stroke(edge, 1);
      }
    }
  }

  /** Width of a bar whose true one the model does not give, pixels: cylinders are seen around what slides in them. */
  private bare(body: number): number {
    return BAR * ROD ** this.stages.around[body]!;
  }

  /** A body with round corners about its points: a thick line in the colour of the edge, and a thinner one over it. */
  private rounded(points: Point[], width: number, fill: string, edge: string): void {
    this.pen.path(points, true).stroke(edge, width);
    const inner = this.pen.path(points, true);
    if (points.length > 2) inner.fill(fill);
    inner.stroke(fill, width - 3);
  }

  /** The ends of the way of a slide. */
  private ends({ kind, a, axis, stroke, beyond = [0, 0] }: Joint): [Point, Point] {
    const at = this.point(a);
    const along = this.along(a.body, axis);
    const [low, high] = stroke ?? [0, 0];
    // a slot ends around its pin, a way with the box
    const more = kind === 'pin-in-slot' ? 7 : 24;
    return [off(at, along, (low - beyond[0]) * this.scale - more, 0), off(at, along, (high + beyond[1]) * this.scale + more, 0)];
  }

  private way(joint: Joint): void {
    const { a, kind, telescopes, upper } = joint;
    if (!telescopes && signs.slides(joint) && kind !== 'pin-in-slot') signs.slideway(this.pen, ...this.ends(joint), a.body === 0 ? null : this.colors(a.body), this.clear(joint), this.inks, upper);
  }

  /** The ways of slides, and the boxes on them. */
  private guides(joints: Joint[]): void {
    joints.forEach((joint) => this.way(joint));
    joints.forEach((joint) => this.box(joint));
  }

  /** Those of hinges on the ground, and of rods without mass. */
  private bearings(): void {
    const { joints, links } = this.motion.scene;
    const hinges = joints.filter((joint) => signs.seen(joint) && !signs.slides(joint));
    for (const { a, b, above } of [...hinges, ...links.filter(({ kind }) => kind === 'rod').map((rod) => ({ ...rod, above: false }))]) for (const end of [a, b]) if (end.body === 0) signs.bearing(this.pen, this.point(end), this.inks, above);
  }

  /** How far the outlines of the body that slides reach from the way to the side of its guide, pixels. */
  private clear({ a, b, axis, upper }: Joint): number {
    const [u, v] = this.along(a.body, axis);
    const lower: Point = signs.isBackwards([u, v]) !== (upper ?? false) ? [v, -u] : [-v, u];
    const from = this.point(b);
    const reach = (at: number[]) => {
      const [x, y] = this.point({ body: b.body, at });
      return lower[0] * (x - from[0]) + lower[1] * (y - from[1]);
    };
    return Math.max(0, ...this.motion.scene.bodies[b.body]!.shapes.flatMap((shape) => {
      if (shape.kind === 'polygon') return shape.points.map(reach);
      return shape.kind === 'disc' || shape.kind === 'gear' || shape.kind === 'sphere' ? [reach(shape.center) + shape.radius * this.scale] : [];
    }));
  }

  private slot(joint: Joint): void {
    if (joint.kind !== 'pin-in-slot') return;
    if (joint.framed && joint.a.body !== 0) signs.slotFrame(this.pen, ...this.ends(joint), this.colors(joint.a.body));
    signs.slot(this.pen, ...this.ends(joint), joint.a.body === 0 ? null : this.colors(joint.a.body).edge, this.inks);
  }

  private box(joint: Joint): void {
    if (joint.kind === 'pin-in-slot' || !signs.slides(joint)) return;
    const [at, along] = [this.point(joint.b), this.along(joint.a.body, joint.axis)];
    if (joint.b.body === 0) signs.foot(this.pen, at, along, this.inks);
    // a body with a shape beside its guide is seen to slide on it
    if (!this.motion.scene.bodies[joint.b.body]!.shapes.some(isArea) || this.clear(joint) === 0) signs.box(this.pen, at, along, this.inks);
  }

  private dashpot(joint: Joint): void {
    if (joint.damped) signs.dashpot(this.pen, this.point(joint.b), signs.slides(joint) ? this.along(joint.a.body, joint.axis) : null, (joint.back ?? 0) * this.scale, joint.a.body === 0, this.inks);
  }

  /** The stops of a joint, and what drives it. */
  private marks(joint: Joint): void {
    if (!signs.seen(joint)) return;
    const { a, b, axis, stops, beyond, ends, swing, driven, sense } = joint;
    const [along, turned] = [this.along(a.body, axis), this.motion.angle(a.body, this.place)];
    const slide = signs.slides(joint) ? along : null;
    const reach = (beyond ?? [0, 0]).map((x) => x * this.scale) as Point;
    if (slide) signs.stops(this.pen, stops.map((s) => (s === null ? null : off(this.point(a), along, s * this.scale, 0))), along, reach, this.clear(joint), this.inks);
    else if (ends) signs.ends(this.pen, this.point(a), ends.map((angle) => (angle === null ? null : signs.turnedBy(turned + angle))), swing ?? null, this.inks);
    if (driven) signs.drive(this.pen, this.point(slide ? b : a), slide, [[0, 1], [1, 0]], sense ?? 0, this.inks);
  }

  private sign(joint: Joint): void {
    if (!signs.seen(joint)) return;
    const { kind, a, b, axis, driven, hidden } = joint;
    if (hidden) signs.hidden(this.pen, this.point(b), this.along(a.body, axis), this.inks);
    signs.pin(this.pen, kind, this.point(a.body === 0 && !signs.slides(joint) ? a : b), driven, this.inks);
  }

  private drawArrows(kind: Kind, pixels: number): void {
    const color = this.inks.curves[COLOR[kind]]!;
    for (const { from, along, torque } of this.arrows.at(kind, this.place)) {
      const at = this.pixel(from[0], from[1]);
      if (torque) this.pen.turn(at, LEVEL, along[2], this.arrows.radius(kind, along[2]), color);
      else this.pen.arrow(at, [at[0] + along[0] * pixels, at[1] - along[1] * pixels], color, 2.2);
    }
  }

  /** A bar of round length at the lower left, in the unit that the model asks for, else in m or mm; where it ends. */
  private bar(height: number): number {
    const asked = this.motion.scene.length;
    const size = asked?.size ?? 1;
    const longest = 110 / (this.scale * size);
    const power = 10 ** Math.floor(Math.log10(longest));
    const length = [5, 2, 1].map((m) => m * power).find((l) => l <= longest * (1 + 1e-9)) ?? power;
    const [x, y] = [16, height - 14];
    const end = x + length * size * this.scale;
    this.pen.path([[x, y - 4], [x, y], [end, y], [end, y - 4]]).stroke(this.inks.faint, 1.4);
    const [shown, unit] = asked ? [length, asked.unit] : length < 0.0099 ? [length * 1e3, 'mm'] : [length, 'm'];
    const text = `${Number(shown.toPrecision(3))} ${unit}`;
    this.pen.text(text, [end + 8, y + 2], this.inks.soft, this.inks.paper, 11);
    return end + 8 + this.pen.width(text, 11) + 22;
  }
}
