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

export async function the_mechanism_has_the_width_of_the_paper(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await tab.setViewportSize({ width: 688, height: 1017 });
  await tab.evaluate(() => document.querySelectorAll('.part').forEach((part) => (part.open = true)));
  await tab.emulateMedia({ media: 'print' });
  await tab.waitForTimeout(150);
  const [stage, summary, plots, table] = await tab.evaluate(() => ['.stage', '.summary', '.plots', '.rows[aria-label=Extremes]'].map((part) => document.querySelector(part).getBoundingClientRect().toJSON()));
  assert.ok(stage.width > 680 && summary.top >= stage.bottom - 1, 'the mechanism does not have the width of the paper');
  assert.ok(plots.top >= summary.bottom - 1 && table.top >= plots.bottom - 1, 'long tables are not behind the figures');
}

export async function letters_on_paper_have_the_size_of_text(open) {
  const { tab } = await open('stewart_platform', { study: 'ride' });
  await tab.evaluate(() => dispatchEvent(new Event('beforeprint')));
  await tab.setViewportSize({ width: 688, height: 1017 });
  await tab.emulateMedia({ media: 'print' });
  await tab.waitForTimeout(150);
  const drawn = () => tab.evaluate(() => {
    const charts = [...document.querySelectorAll('svg.chart')].map((chart) => chart.getBoundingClientRect().width / chart.viewBox.baseVal.width);
    const canvas = document.querySelector('.canvas canvas');
    return { charts, canvas: [canvas.width, canvas.height], place: [canvas.parentElement.clientWidth, canvas.parentElement.clientHeight] };
  });
  const { charts, canvas, place } = await drawn();
  assert.ok(charts.length >= 3 && charts.every((scale) => Math.abs(scale - 1) < 0.03), `charts are scaled by ${charts}`);
  canvas.forEach((points, k) => assert.ok(Math.abs(points / place[k] - 3) < 0.05, `${canvas} points on ${place} px`));
  await tab.emulateMedia({ media: 'screen' });
  await tab.setViewportSize({ width: 1280, height: 900 });
  await tab.evaluate(() => dispatchEvent(new Event('afterprint')));
  await tab.waitForTimeout(150);
  const screen = await drawn();
  assert.ok(screen.charts.every((scale) => Math.abs(scale - 1) < 0.03), `behind it by ${screen.charts}`);
  assert.deepEqual(screen.canvas, screen.place);
}

export async function nothing_is_cut_off_on_a4(open) {
  for (const [model, study] of [['crank_rocker', 'lengths'], ['stewart_platform', 'ride'], ['winch', 'fall']]) {
    const { tab } = await open(model, { study });
    // the width of A4 within its margins, 182 mm
    await tab.setViewportSize({ width: 688, height: 1017 });
    await tab.emulateMedia({ media: 'print' });
    await tab.waitForTimeout(150);
    const wide = await tab.evaluate(() => [...document.querySelectorAll('.study *')].filter((one) => {
      const box = one.getBoundingClientRect();
      return box.width > 0 && (box.right > innerWidth + 1 || box.left < -1) && !one.closest('svg, .rows');
    }).map((one) => one.outerHTML.slice(0, 80)));
    assert.deepEqual(wide, [], model);
    for (const chart of await tab.locator('svg.chart').all()) {
      const box = await chart.boundingBox();
      assert.ok(box === null || (box.x >= 0 && box.x + box.width <= 689), `${model}: a figure ends at ${box?.x + box?.width}`);
    }
    const pages = (await tab.pdf({ preferCSSPageSize: true })).toString('latin1').match(/\/Type \/Page\b/g).length;
    assert.ok(pages <= 8, `${model}: ${pages} pages`);
  }
}
