// Light and dark, and the colours of pictures in either.

export interface Inks { paper: string; ink: string; soft: string; faint: string; grid: string; accent: string; rust: string; curves: string[]; light: boolean }

type Rgb = [number, number, number];
const KEY = 'grashof-theme';

function rgb(hex: string): Rgb {
  const value = parseInt(hex.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}

/** A colour between two: 0 is the first. */
export function mixed(a: string, b: string, part: number): string {
  const [from, to] = [rgb(a), rgb(b)];
  return `#${from.map((x, i) => Math.round(x + (to[i]! - x) * part).toString(16).padStart(2, '0')).join('')}`;
}

/** The fill and the edge of a body of a colour, as in the figures of the program; in the dark the fill is darkened in their place. */
export function bodyInks(color: string, { light }: Inks): { fill: string; edge: string } {
  return light ? { fill: color, edge: mixed(color, '#000000', 0.5) } : { fill: mixed(color, '#000000', 0.4), edge: color };
}

/** Of rods without mass. */
const ROD = '#c8c8c4';
export const rodInks = (inks: Inks): { fill: string; edge: string } => bodyInks(ROD, inks);

/** Of point masses. */
export const massInk = ({ ink, paper }: Inks): string => mixed(ink, paper, 0.27);

/** Of paths, as in the figures: none that loads or reactions have. */
const OF_PATHS = [3, 2, 4, 5, 6];
export const PATHS = OF_PATHS.length;
export const pathInk = (k: number, { curves }: Inks): string => curves[OF_PATHS[k % PATHS]!]!;

/** Of the arrows of drives, and of stops, as in the figures. */
export const driveInk = ({ light }: Inks): string => (light ? '#007054' : '#45c8a2');
export const stopInk = ({ light }: Inks): string => (light ? '#b01428' : '#ff7482');

/** The colours that hold now. */
export function inks(): Inks {
  const style = getComputedStyle(document.documentElement);
  const read = (name: string) => style.getPropertyValue(`--${name}`).trim();
  return {
    paper: read('paper'), ink: read('ink'), soft: read('soft'), faint: read('faint'), grid: read('grid'), accent: read('accent'), rust: read('rust'),
    curves: [0, 1, 2, 3, 4, 5, 6].map((k) => read(`curve-${k}`)),
    light: read('scheme') !== 'dark',
  };
}

/** What the reader has chosen, if anything. */
function chosen(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

/** Whether the page is dark. */
export function isDark(): boolean {
  const root = document.documentElement.dataset.theme;
  return root ? root === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
}

/** Takes over what was chosen before, and tells of changes. */
export function begin(changed: () => void): void {
  const before = chosen();
  if (before) document.documentElement.dataset.theme = before;
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed);
}

/** Changes between light and dark. */
export function toggle(): void {
  const next = isDark() ? 'light' : 'dark';
  document.documentElement.dataset.theme = next;
  try {
    localStorage.setItem(KEY, next);
  } catch {
    // a page from a file may keep nothing
  }
}
