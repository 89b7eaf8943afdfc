// The data of a page: results of studies as the program writes them. All numbers are SI; null where there is none.

export type Num = number | null;

export interface Data {
  version: string;
  model: { name: string; path: string; source: string; about: string | null };
  overview: { label: string; value: string }[];
  studies: Study[];
}

/** Why a study has no results. */
export interface Fault { message: string; place: string; help: string }
/** A study without results. */
export interface Failed { study: string; about: string; faults: Fault[] }

export interface Column {
  name: string;
  quantity: string;
  unit: string;
  shown_in: { unit: string; size: number } | null;
  values: Num[];
}

export interface Scalar {
  name: string;
  quantity: string;
  unit: string;
  shown_in: { unit: string; size: number } | null;
  value: Num;
  by: 'file' | 'kind' | 'study';
}

export interface Extremum { value: Num; at: Num; piece: number }
export interface Finding { code: string; message: string; path: string }
/** Ends of an axis, where they are given. */
export type Ends = [Num, Num];
export interface PlotAxis { si: string; unit: [string, number] | null; range: Ends }

export interface Plot {
  name: string;
  show: string[];
  over: string | null;
  unit: [string, number] | null;
  of_runs: boolean;
  /** Whether its axes are coordinates of one place. */
  path: boolean;
  range: Ends;
  /** The vertical axis of one quantity, and a second one on the right. */
  y: PlotAxis | null;
  right: { show: string[]; axis: PlotAxis } | null;
  /** Curves that do not come from the study. */
  beside: { label: string; of: string; x: Num[]; y: Num[]; measured: boolean }[];
}

/** What was left out of a table: by how many rows each row that is there stands behind the one before, and behind which of them a smooth piece ends. */
export interface RowsShown { steps: number[]; of: number; selected: number | null; within: number; breaks: number[]; bends: Record<string, number[]> }

export interface Solution {
  parameter: Scalar;
  of: string;
  found: Num;
  target: Num;
  bracket: [Num, Num];
  runs: number;
  findings: Finding[];
}

export interface LinearSystem {
  coordinates: string[];
  states: string[];
  inputs: string[];
  outputs: string[];
  values: Num[][];
  matrices: [string, Num[][]][];
}

export interface March {
  schemes: string;
  tolerance: Num;
  energy_drift: Num;
  energy_scale: Num;
  drivers: Num;
  loads: Num;
  dampers: Num;
  stops: Num;
  impacts: Num;
  widest_gap: Num;
  velocity: Num;
  counts: Record<string, number>;
}

export interface Certificate {
  evaluations: number;
  switches: number;
  constraint: Num;
  power_balance: Num;
  resolved: { width: number; open: number; evaluations: number } | null;
  march: March | null;
}

export interface Results {
  model: string;
  study: string;
  kind: string;
  /** Variants of the model that it was run with. */
  variants: string[];
  place: string;
  stopped: string | null;
  undefined: { message: string; place: string; help: string } | null;
  parameters: Scalar[];
  independent: Column;
  table: { columns: Column[]; switches: number[]; selected_from: number | null; reasons: string[] | null };
  curves: Column[];
  scalars: Scalar[];
  extremes: [string, { min: Extremum; max: Extremum } | null][];
  lists: { name: string; unit: string; shown_in?: Column['shown_in']; values: Num[] }[];
  /** Of each mode its coordinates in words, the largest first. */
  shapes: string[][];
  linear: LinearSystem | null;
  events: { name: string; at: Num }[];
  expectations: { text: string; found: Num; wanted: Num; tolerance: Num; met: boolean; message: string; place: string }[];
  findings: Finding[];
  certificate: Certificate;
  solution: Solution | null;
  scenes: [string, CodedScene][];
  plots: Plot[];
  statistics: Statistics[];
  /** How the parameters of a sweep get their values, in the order of the first columns of its table. */
  swept?: { by: 'grid' | 'points' | 'drawn'; written_in: Column['shown_in'] }[];
  rows: RowsShown;
}

/** How a number is distributed over the runs of a sweep whose values are drawn; percentiles 5, 25, 50, 75, 95. */
export interface Statistics {
  name: string;
  unit: string;
  shown_in: Column['shown_in'];
  runs: number;
  mean: Num;
  deviation: Num;
  range: [Num, Num];
  percentiles: Num[];
  parts: { parameter: string; slope: Num; share: Num }[];
}

export interface Run { label: string; results: Results | null; solution: Solution | null }
export interface Study extends Results { about: string; runs: Run[] }

/** Numbers of equal frames as differences of some order, rounded to units. */
export interface Differences { unit: number[]; order: number; values: number[] }

export interface Place { body: number; at: number[] }

export type Shape =
  | { kind: 'bar'; from: number[]; to: number[]; width: Num }
  /** In space with the corners of its faces, counter-clockwise from outside, where it is no bundle of legs. */
  | { kind: 'hull'; points: number[][]; faces?: number[][] }
  | { kind: 'polygon'; points: number[][] }
  | { kind: 'disc'; center: number[]; radius: number; axis: number[] | null; thickness: Num }
  /** In the plane: the radius of the pitch circle, less than 0 with inner teeth, their outline in the body, and of a ring the radius of its rim. */
  | { kind: 'gear'; center: number[]; radius: number; teeth: number; first: number; outline: number[][]; rim?: number }
  | { kind: 'box'; center: number[]; size: number[] }
  | { kind: 'cylinder'; from: number[]; to: number[]; radius: number }
  | { kind: 'sphere'; center: number[]; radius: number }
  | { kind: 'mass'; at: number[]; mass: number; radius: number };

export interface Joint {
  name: string;
  kind: string;
  a: Place;
  b: Place;
  /** Whether the columns of its force are those on the ground. */
  on_ground: boolean;
  axis: number[];
  /** Of a universal joint its axis in the second body. */
  second?: number[];
  stroke: [number, number] | null;
  /** Of a slide the places of its stops along the axis from a. */
  stops: [Num, Num];
  /** Of a slide with stops how far the body that slides reaches from its point, back and ahead along the axis, if it does. */
  beyond?: [number, number];
  /** Of a damped slide how far back. */
  back?: number;
  /** Of a hinge in the plane the directions of its stops in the first body, rad, if it has any, and the angle between both. */
  ends?: [Num, Num];
  swing?: Num;
  /** Of a hinge in space the unit directions of its stops in the first body, across the axis, if it has any. */
  far?: [number[] | null, number[] | null];
  /** Whether its bearing stands above it. */
  above?: boolean;
  /** Of a slide: whether its guide is on the upper side of the way. */
  upper?: boolean;
  /** Whether a slot is drawn with what it is cut into. */
  framed?: boolean;
  /** Of a slide: whether areas of both bodies hide it. */
  hidden?: boolean;
  /** Of what is driven the sense in which it moves at first: 0 is none. */
  sense?: number;
  cut: boolean;
  driven: boolean;
  damped: boolean;
  /** Of a slide: whether it is of a rod in its cylinder, which needs no guide. */
  telescopes?: boolean;
}

export type LinkKind = 'spring' | 'damper' | 'spring-damper' | 'rod' | 'actuator' | 'torsion' | 'shaft' | 'clutch' | 'brake';
/** An actuator has so many tubes, each as long as `tube`, m. */
export interface Link { name: string; kind: LinkKind; a: Place; b: Place; rest: Num; stages?: number; tube?: number; along?: number[] }
export interface Wheel { body: number; at: number[]; radius: number; axis?: number[] }
export type GearKind = 'teeth' | 'rack' | 'belt' | 'rope';
export interface Gear { name: string; kind: GearKind; a: Wheel; b: Wheel }
export interface Trace { name: string; body: number; at: number[] }
export type ArrowKind = 'load' | 'reaction' | 'torque' | 'moment';

interface Parts<A> {
  dimensions: 2 | 3;
  length: Column['shown_in'];
  /** Those of forces and torques. */
  force: Column['shown_in'];
  torque: Column['shown_in'];
  up: [number, number, number];
  /** The run of a sweep, or frequency and damping of a mode; may be empty. */
  caption: string;
  /** In space from where it is seen: azimuth and elevation, rad, from the first of two level axes. */
  view: { level: [[number, number, number], [number, number, number]]; azimuth: number; elevation: number } | null;
  /** The place of the motion that the study asks to be shown. */
  at: Num;
  bodies: { name: string; shapes: Shape[]; color: string }[];
  joints: Joint[];
  links: Link[];
  gears: Gear[];
  arrows: { name: string; kind: ArrowKind; body: number; at: number[]; columns: string[]; minus: boolean; values: A; scale: Num }[];
  traces: Trace[];
}

export interface CodedScene extends Parts<Differences | null> {
  frames: { at: Differences; poses: Differences; shown: number[]; error: number; closed: boolean };
}

export interface Scene extends Parts<Float64Array | null> {
  frames: { at: Float64Array; poses: Float64Array; shown: number[]; error: number; closed: boolean };
}
