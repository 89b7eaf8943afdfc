// Requests to the program that serves the page.

import type { Data, Study } from '../types';

export interface Finding { error: boolean; text: string; file: string; line: number; column: number }

/** A number of the file that can be moved; all in the unit of the file. */
export interface Movable { place: string; name: string; start: boolean; unit: string; number: number; value: number; low: number; high: number }

export interface StudyState { name: string; about: string; version: number; stale: boolean; busy: boolean; bad: boolean; findings: Finding[] }

/** What the program knows. */
export interface State {
  version: number;
  /** Number of the text of the file. */
  model: number;
  /** Why there is no file. */
  away: string | null;
  /** What is wrong with the file as it is now. */
  broken: Finding[];
  findings: Finding[];
  first: string | null;
  moved: boolean;
  values: Movable[];
  studies: StudyState[];
  /** What is known of the model, and the study in view, where the page has older ones. */
  head?: Data;
  result?: Study;
}

const token = new URLSearchParams(location.search).get('token') ?? '';
const address = (path: string, query = '') => `${path}?${query}token=${encodeURIComponent(token)}`;

async function get<T>(path: string, query = ''): Promise<T> {
  const answer = await fetch(address(path, query), { cache: 'no-store' });
  if (!answer.ok) throw new Error(await answer.text());
  return await answer.json() as T;
}

/** What is newer than a version, with the model and the study in view if these are newer than the page has them; the answer waits until there is something. */
export function state(after: number, model: number, name: string | undefined, has: number): Promise<State> {
  const viewed = name === undefined ? '' : `study=${encodeURIComponent(name)}&has=${has}&`;
  return get<State>('/state', `after=${after}&model=${model}&${viewed}`);
}

export const study = (name: string) => get<{ version: number; study: Study }>('/study', `name=${encodeURIComponent(name)}&`);

/** Tells the program something; the answer is why it refuses, if it does. */
export async function tell(path: '/view' | '/move' | '/back' | '/write', message: object): Promise<string | null> {
  try {
    const answer = await fetch(address(path), { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(message) });
    if (answer.ok) return null;
    return answer.headers.get('Content-Type') === 'application/json' ? String((await answer.json() as { why?: string }).why) : await answer.text();
  } catch {
    return 'the program does not answer';
  }
}
