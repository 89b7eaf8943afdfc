// Reading the data of the page.

import type { CodedScene, Data, Differences, Failed, Scene, Study } from './types';

/** The data behind the page: base64 of gzip of JSON. */
export async function load(): Promise<Omit<Data, 'studies'> & { studies: (Study | Failed)[] }> {
  const text = document.getElementById('data')?.textContent ?? '';
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return JSON.parse(await new Response(stream).text());
}

/** Numbers frame after frame from their differences. */
export function summed({ unit, order, values }: Differences): Float64Array {
  const width = unit.length;
  const out = new Float64Array(values.length);
  if (width === 0) return out;
  const count = values.length / width;
  const whole = new Float64Array(count);
  for (let k = 0; k < width; k++) {
    for (let i = 0; i < count; i++) whole[i] = values[k * count + i]!;
    for (let n = 0; n < order; n++) for (let i = 1; i < count; i++) whole[i]! += whole[i - 1]!;
    for (let i = 0; i < count; i++) out[i * width + k] = whole[i]! * unit[k]!;
  }
  return out;
}

/** A scene with its frames as numbers. */
export function scene(coded: CodedScene): Scene {
  const frames = { ...coded.frames, at: summed(coded.frames.at), poses: summed(coded.frames.poses) };
  const arrows = coded.arrows.map((arrow) => ({ ...arrow, values: arrow.values && summed(arrow.values) }));
  return { ...coded, frames, arrows };
}
