// Small arrow heads along curves that turn back in x, which show the way they are run through: by the rule of the program's figures
// (src/output/heads.rs), at half their size.

export type Point = [number, number];

/** Length and width of a head, pixels. */
const SIZE = 8.5;
const WIDTH = 6;
/** A curve that falls behind by less in x does not turn back, pixels. */
const BACK = 2;
/** Pixels of a curve to a head. */
const EACH = 150;
/** Heads of a curve, and of all curves of a panel, at most; but one for each. */
const MOST = 6;
const TOGETHER = 24;
/** A curve that is so many panels long fills it, and no head is seen. */
const FULL = 20;

const distance = (a: Point, b: Point) => Math.hypot(b[0] - a[0], b[1] - a[1]);

/** The length of a line. */
function length(line: Point[]): number {
  let sum = 0;
  for (let i = 1; i < line.length; i++) sum += distance(line[i - 1]!, line[i]!);
  return sum;
}

/** Whether x runs both ways. */
function turnsBack(pieces: Point[][]): boolean {
  let [low, high, forth, back] = [Infinity, -Infinity, false, false];
  for (const piece of pieces) {
    for (const [x] of piece) {
      [low, high] = [Math.min(low, x), Math.max(high, x)];
      forth ||= x - low > BACK;
      back ||= high - x > BACK;
    }
  }
  return forth && back;
}

/** Where a line has run `along`. */
function at(line: Point[], along: number): Point | null {
  if (along < 0) return null;
  for (let i = 1; i < line.length; i++) {
    const [a, b] = [line[i - 1]!, line[i]!];
    const size = distance(a, b);
    if (along <= size && size > 0) return [a[0] + (along / size) * (b[0] - a[0]), a[1] + (along / size) * (b[1] - a[1])];
    along -= size;
  }
  return null;
}

/** The head in the middle of which a line has run `along`; none where it ends there or makes a sharp turn. */
function head(line: Point[], along: number): Point[] | null {
  const [back, middle, front] = [at(line, along - SIZE / 2), at(line, along), at(line, along + SIZE / 2)];
  if (!back || !middle || !front) return null;
  const chord = distance(back, front);
  if (chord < 0.7 * SIZE) return null;
  const [ux, uy] = [(front[0] - back[0]) / chord, (front[1] - back[1]) / chord];
  const corner = (forth: number, across: number): Point => [middle[0] + forth * ux - across * uy, middle[1] + forth * uy + across * ux];
  return [corner(SIZE / 2, 0), corner(-SIZE / 2, WIDTH / 2), corner(-SIZE / 2, -WIDTH / 2)];
}

/** The heads, as triangles whose tip comes first, of a curve that consists of pieces, one of `count` in a panel of a width; none if it does not turn back. */
export function heads(pieces: Point[][], width: number, count: number): Point[][] {
  if (!turnsBack(pieces)) return [];
  const lengths = pieces.map(length);
  const whole = lengths.reduce((sum, size) => sum + size, 0);
  if (whole < 4 * SIZE || lengths.some((size) => size > FULL * width)) return [];
  const most = Math.min(Math.max(Math.floor(TOGETHER / count), 1), MOST);
  const number = Math.min(Math.max(Math.round(whole / EACH), 1), most);
  return Array.from({ length: number }, (_, k) => {
    let along = ((k + 0.5) / number) * whole;
    const own = lengths.findIndex((size) => (along -= size) <= 0);
    return own < 0 ? null : head(pieces[own]!, along + lengths[own]!);
  }).filter((found) => found !== null);
}
