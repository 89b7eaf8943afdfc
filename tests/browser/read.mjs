// What tests share.

import { readFileSync } from 'node:fs';
import assert from 'node:assert/strict';

export { assert };

/** The columns of a CSV file by name. */
export function csv(file) {
  const [head, ...rows] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return Object.fromEntries(head.map((name, k) => [name, rows.map((row) => (row[k] === '' ? NaN : Number(row[k])))]));
}

/** Whether two numbers are one to a tolerance. */
export function near(found, wanted, tolerance, what = '') {
  assert.ok(Math.abs(found - wanted) <= tolerance, `${what}: ${found}, not ${wanted} within ${tolerance}`);
}

export const time = (tab) => tab.evaluate(() => grashof.time());
export const seek = (tab, at) => tab.evaluate((to) => grashof.seek(to), at);

/** Waits until something holds in the page, whose policy lets no text be run as `waitForFunction` would. */
export async function until(tab, holds, argument) {
  for (let i = 0; i < 1000; i++) {
    if (await tab.evaluate(holds, argument)) return;
    await tab.waitForTimeout(20);
  }
  throw new Error(`never: ${holds}`);
}
