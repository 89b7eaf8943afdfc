// Drawing on a canvas in pixels of the page.

export type Point = [number, number];

export class Pen {
  /** Where what is drawn faintly is drawn first. */
  private layer: HTMLCanvasElement | null = null;

  constructor(public on: CanvasRenderingContext2D) {}

  /** A line through points, closed if it is to be. */
  path(points: Point[], closed = false): this {
    this.on.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? this.on.moveTo(x, y) : this.on.lineTo(x, y)));
    if (closed) this.on.closePath();
    return this;
  }

  circle([x, y]: Point, radius: number): this {
    this.on.beginPath();
    this.on.arc(x, y, Math.max(radius, 0), 0, 2 * Math.PI);
    return this;
  }

  fill(color: string): this {
    this.on.fillStyle = color;
    this.on.fill();
    return this;
  }

  stroke(color: string, width: number, dash: number[] = []): this {
    Object.assign(this.on, { strokeStyle: color, lineWidth: width, lineJoin: 'round', lineCap: 'round' });
    this.on.setLineDash(dash);
    this.on.stroke();
    return this;
  }

  /** Draws so that what lies below shows through. */
  faintly(opacity: number, draw: () => void): void {
    const before = this.on.globalAlpha;
    this.on.globalAlpha = before * opacity;
    draw();
    this.on.globalAlpha = before;
  }

  /** The same of a picture as a whole: of what lies over each other in it only the uppermost is seen. */
  faintlyAll(opacity: number, draw: () => void): void {
    const { on } = this;
    const { width, height } = on.canvas;
    this.layer ??= document.createElement('canvas');
    Object.assign(this.layer, { width, height });
    const over = this.layer.getContext('2d');
    if (!over || width === 0 || height === 0) return;
    over.setTransform(on.getTransform());
    this.on = over;
    draw();
    this.on = on;
    on.save();
    on.setTransform(1, 0, 0, 1, 0, 0);
    on.globalAlpha *= opacity;
    on.drawImage(this.layer, 0, 0);
    on.restore();
  }

  /** Text with room around its letters. */
  text(text: string, [x, y]: Point, color: string, halo: string, size = 12): void {
    const { on } = this;
    on.font = `${size}px system-ui, sans-serif`;
    on.setLineDash([]);
    Object.assign(on, { strokeStyle: halo, lineWidth: 4, lineJoin: 'round', fillStyle: color });
    on.strokeText(text, x, y);
    on.fillText(text, x, y);
  }

  /** Width of a text, pixels. */
  width(text: string, size = 12): number {
    this.on.font = `${size}px system-ui, sans-serif`;
    return this.on.measureText(text).width;
  }

  /** A torque about a place: an arrow that turns from the first to the second of two directions, of a radius. */
  turn(at: Point, across: [Point, Point], sense: number, radius: number, color: string): void {
    if (sense === 0 || radius < 2) return;
    const arc = turning(at, across, sense, radius);
    // a head of 8 pixels where there is room for it
    const head = Math.min(Math.ceil(54 / radius), 10);
    this.path(arc.slice(0, -head)).stroke(color, 2);
    this.arrow(arc[arc.length - 1 - head]!, arc[arc.length - 1]!, color);
  }

  /** An arrow with a slender head. */
  arrow(from: Point, to: Point, color: string, width = 2): void {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (!(length > 1)) return;
    const [ux, uy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    const head = Math.min(10, length * 0.6);
    const base: Point = [to[0] - ux * head, to[1] - uy * head];
    this.path([from, base]).stroke(color, width);
    this.path([to, [base[0] - uy * head * 0.36, base[1] + ux * head * 0.36], [base[0] + uy * head * 0.36, base[1] - ux * head * 0.36]], true).fill(color);
  }
}

/** To the right and upwards. */
export const LEVEL: [Point, Point] = [[1, 0], [0, -1]];

/** The points of the arc of a torque about a place: seven tenths of a turn, from the first to the second direction if it is positive. */
function turning(at: Point, [u, v]: [Point, Point], sense: number, radius: number): Point[] {
  return Array.from({ length: 31 }, (_, k): Point => {
    const angle = 0.4 * 2 * Math.PI + Math.sign(sense) * 0.7 * 2 * Math.PI * (k / 30);
    const [cos, sin] = [radius * Math.cos(angle), radius * Math.sin(angle)];
    return [at[0] + cos * u[0] + sin * v[0], at[1] + cos * u[1] + sin * v[1]];
  });
}

/** The point at some pixels along and across from another. */
export function off([x, y]: Point, [ux, uy]: Point, along: number, across: number): Point {
  return [x + ux * along - uy * across, y + uy * along + ux * across];
}

/** Unit direction from one point to another, and the distance. */
export function toward(a: Point, b: Point): { along: Point; length: number } {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  return { along: length > 1e-9 ? [(b[0] - a[0]) / length, (b[1] - a[1]) / length] : [1, 0], length };
}

/** The convex hull of points, around in one sense (Andrew 1979). */
export function hull(points: Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  if (sorted.length < 3) return sorted;
  const half = (all: Point[]) => {
    const out: Point[] = [];
    for (const p of all) {
      while (out.length > 1) {
        const [a, b] = [out[out.length - 2]!, out[out.length - 1]!];
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 1e-9) break;
        out.pop();
      }
      out.push(p);
    }
    out.pop();
    return out;
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
