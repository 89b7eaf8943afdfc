// The page on paper.

import { assert } from './read.mjs';

export async function a_study_prints_on_a4(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn', colorScheme: 'dark' });
  const pdf = await tab.pdf({ preferCSSPageSize: true });
  const text = pdf.toString('latin1');
  assert.ok(text.startsWith('%PDF'));
  const [, width, height] = /\/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]/.exec(text);
  assert.ok(Math.abs(width - 595) < 2 && Math.abs(height - 842) < 2, `${width} by ${height}`);
  const pages = text.match(/\/Type \/Page\b/g).length;
  assert.ok(pages >= 2 && pages <= 8, `${pages} pages`);
  await tab.emulateMedia({ media: 'print' });
  assert.equal(await tab.locator('nav').isVisible(), false);
  assert.equal(await tab.locator('[data-plot=torque] svg.chart').isVisible(), true);
}
