// What draws a mechanism on a canvas.

import type { Arrows, Kind } from './arrows';
import type { Motion } from './motion';
import type { Named } from './names';
import type { Told } from './scales';
import type { Inks } from './theme';

/** Where the slider of the arrows stands at first: there arrows to which the model gives a scale have it. */
export const FIRST = 0.25;

export interface Options {
  paths: 'none' | 'growing' | 'whole';
  names: boolean;
  arrows: Set<Kind>;
  /** Length of the largest arrow as a part of the picture; beside FIRST that of arrows with a scale beside their own. */
  scale: number;
  /** The body that stays in the middle, by its name. */
  follow: string | null;
}

/** Opacity of positions behind the present one. */
export const PALE = 0.35;

export interface Renderer {
  /** Goes with a body, or stays. */
  follow(name: string | null): void;
  /** Draws a place of the motion, in pixels of the page. */
  draw(place: number, options: Options, inks: Inks, width: number, height: number): void;
  /** The names that are drawn. */
  named(): Named[];
  /** What has no name in the present view, as there is no room for it. */
  unnamed(): string[];
  /** What is at a point of the canvas, in words. */
  pointed(at: [number, number]): string | null;
  /** The arrows that tell the scale of others. */
  scales(): Told[];
  /** Wheels with their numbers of teeth, 0 without, and racks with those of their pinions; their outlines, pixels. */
  wheels(): { body: string; teeth: number; outline: [number, number][] }[];
  /** Height of all that is drawn over the motion, as a part of its width. */
  aspect(): number;
  /** The whole mechanism in view again. */
  fit(): void;
  /** Larger or smaller about a point of the canvas. */
  zoom(factor: number, x: number, y: number): void;
  /** Moved by pixels; of a view in space turned, if so asked. */
  drag(dx: number, dy: number, turn: boolean): void;
  /** From where it is looked at, in numbers of its own; with them, from there. */
  outlook(from?: number[]): number[];
}

export type Maker = (context: CanvasRenderingContext2D, motion: Motion, arrows: Arrows) => Renderer;

declare global {
  interface Window {
    /** Draws mechanisms in space; there on pages that have one. */
    grashofSpace?: Maker;
  }
}
