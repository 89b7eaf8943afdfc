// A figure as files.

import { save } from '../dom';
import { heading } from '../numbers';
import { mixed } from '../theme';
import { COLORS, type Figure, draw, layout, style } from './chart';

const LIGHT: Record<string, string> = { grid: '#e8e8e8', line: '#555', soft: '#333', faint: '#999' };

/** The colours of the page for many curves on white. */
const SCALE = ['#002060', '#0a62a8', '#188470', '#a98600', '#de762c'];

/** Colours instead of the variables of the page. */
function plain(text: string): string {
  return text
    .replace(/color-mix\(in srgb, var\(--scale-(\d)\), var\(--scale-\d\) ([\d.]+)%\)/g, (_, low: string, part: string) => mixed(SCALE[Number(low)]!, SCALE[Number(low) + 1]!, Number(part) / 100))
    .replace(/var\(--curve-(\d)\)/g, (_, index: string) => COLORS[Number(index)]!)
    .replace(/var\(--(\w+)\)/g, (_, name: string) => LIGHT[name] ?? '#333');
}

/** Saves a figure as it is drawn, with its legend. */
export function saveSvg(name: string, title: string, figure: Figure, view: { log: boolean; x: [number, number] | null; y: [number, number] | null }): void {
  const wide = { ...view, width: 900 };
  const svg = draw(figure, wide, layout(figure, wide), title);
  const height = Number(svg.getAttribute('height'));
  const shown = figure.curves.filter((curve) => curve.shown);
  const rows = shown.length > 1 ? Math.ceil(shown.length / 3) : 0;
  const lines = rows === 0 ? [] : shown.map((curve, k) => {
    const [x, y] = [60 + (k % 3) * 280, height + 12 + 20 * Math.floor(k / 3)];
    const text = curve.label.replace(/&/g, '&amp;').replace(/</g, '&lt;');
    const { stroke, 'stroke-dasharray': dash } = style(curve, figure);
    return `<path d="${curve.dots ? `M${x + 4} ${y}h0m10 0h0m10 0h0` : `M${x} ${y}h28`}" stroke="${stroke}" stroke-dasharray="${dash}" stroke-width="${curve.dots ? 5 : 2}" stroke-linecap="${curve.dots ? 'round' : 'butt'}"/><text x="${x + 36}" y="${y + 4}" font-size="12" fill="#333">${text}</text>`;
  });
  const total = height + 20 * rows + 8;
  svg.setAttribute('viewBox', `0 0 900 ${total}`);
  svg.setAttribute('height', String(total));
  svg.setAttribute('font-family', 'sans-serif');
  const text = new XMLSerializer().serializeToString(svg).replace('</svg>', `${lines.join('')}</svg>`);
  save(`${name}.svg`, plain(text.replace('>', '><rect width="100%" height="100%" fill="#fff"/>')), 'image/svg+xml');
}

function field(text: string): string {
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

/** Saves the points of the curves that are shown: x and y of each, in the units that are shown. */
export function saveCsv(name: string, figure: Figure): void {
  const shown = figure.curves.filter((curve) => curve.shown);
  const shared = shown.every((curve) => curve.x === shown[0]!.x);
  const x = (curve: string) => field(heading(shared ? figure.x.label : `${figure.x.label}, ${curve}`, figure.x.unit));
  const head = shown.flatMap((curve, k) => (shared && k > 0 ? [] : [x(curve.label)]).concat(field(heading(curve.label, curve.unit))));
  const length = Math.max(0, ...shown.map((curve) => curve.y.length));
  const number = (v: number | undefined) => (v === undefined || Number.isNaN(v) ? '' : String(Number(v.toPrecision(8))));
  const rows = Array.from({ length }, (_, i) =>
    shown.flatMap((curve, k) => (shared && k > 0 ? [] : [number(curve.x[i])]).concat(number(curve.y[i]))).join(','));
  save(`${name}.csv`, [head.join(','), ...rows].join('\n') + '\n', 'text/csv');
}
