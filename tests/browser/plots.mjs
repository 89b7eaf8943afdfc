// Figures: what they show, the cursor, zoom, the logarithmic axis, files.

import { readFileSync } from 'node:fs';
import { assert, csv, near, seek, time } from './read.mjs';

const plot = (tab, name) => tab.locator(`[data-plot="${name}"]`);
const value = async (tab, name, k = 0) => Number((await plot(tab, name).locator('.value').nth(k).innerText()).split(' ')[0].replace('−', '-'));

export async function the_figures_of_the_file_are_there(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const names = await tab.locator('[data-plot]').evaluateAll((all) => all.map((one) => one.dataset.plot));
  assert.deepEqual(names, ['angles', 'det_J', 'rates', 'accelerations', 'tip', 'centre', 'centre_motion', 'inertia', 'reactions', 'load', 'torque', 'power', 'shaking']);
  assert.equal(await plot(tab, 'centre_motion').locator('clipPath').count(), 2, 'a panel for each unit');
}

export async function all_figures_show_the_time(open) {
  const { tab, directory } = await open('crank_rocker', { study: 'one-turn' });
  const { theta, phi2 } = csv(`${directory}/one-turn.csv`);
  for (const i of [100, 1003, 2222]) {
    await seek(tab, theta[i]);
    near(await value(tab, 'angles'), (phi2[i] * 180) / Math.PI, 2e-3, 'phi2');
    const marks = await tab.locator('.now').evaluateAll((all) => all.map((line) => Number(line.dataset.at)));
    assert.equal(marks.length, 12, 'all but the path of the centre of mass');
    marks.forEach((at) => near(at, (theta[i] * 180) / Math.PI, 1e-9, 'mark'));
  }
}

export async function a_click_in_a_figure_sets_the_time(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await plot(tab, 'torque').scrollIntoViewIfNeeded();
  const box = await plot(tab, 'torque').locator('.plot-stage').boundingBox();
  await tab.mouse.move(box.x + box.width * 0.6, box.y + 80);
  const under = await value(tab, 'torque');
  await tab.mouse.down();
  await tab.mouse.up();
  const at = await time(tab);
  assert.ok(at > 2.5 && at < 4.5, `at ${at}`);
  await tab.mouse.move(5, 5);
  near(await value(tab, 'torque'), under, 1e-6, 'value at the cursor and at the time');
}

export async function dragging_zooms_and_a_double_click_ends_it(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const stage = plot(tab, 'rates').locator('.plot-stage');
  const labels = () => stage.locator('text').allTextContents();
  const before = await labels();
  await stage.scrollIntoViewIfNeeded();
  const box = await stage.boundingBox();
  await tab.mouse.move(box.x + box.width * 0.4, box.y + 60);
  await tab.mouse.down();
  await tab.mouse.move(box.x + box.width * 0.5, box.y + 60, { steps: 4 });
  await tab.mouse.up();
  const near = await labels();
  assert.notDeepEqual(near, before);
  await tab.mouse.dblclick(box.x + box.width * 0.5, box.y + 60);
  assert.deepEqual(await labels(), before);
}

export async function keys_move_the_cursor_of_a_figure(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await seek(tab, 1);
  await plot(tab, 'angles').locator('.plot-stage').focus();
  const before = await value(tab, 'angles', 1);
  for (let k = 0; k < 5; k++) await tab.keyboard.press('ArrowRight');
  assert.notEqual(await value(tab, 'angles', 1), before);
  assert.equal(await time(tab), 1, 'the motion stays');
  await tab.keyboard.press('Enter');
  assert.ok((await time(tab)) > 1.2);
}

export async function dotted_lines_are_explained(open) {
  const { tab } = await open('excavator', { study: 'dig' });
  assert.match(await plot(tab, 'forces').locator('.dotted').innerText(), /switches/);
  // where other columns switch, and not what is plotted
  const other = await open('crank_rocker', { study: 'one-turn' });
  assert.equal(await plot(other.tab, 'angles').locator('.dotted').count(), 0);
  const swept = await open('crank_rocker', { study: 'fluctuation' });
  assert.equal(await swept.tab.locator('.plot .dotted').count(), 0);
}

export async function a_logarithmic_axis_and_a_column_of_ones_own(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const log = plot(tab, 'reactions').getByText('log', { exact: true });
  await log.click();
  assert.equal(await log.getAttribute('aria-pressed'), 'true');
  assert.ok((await plot(tab, 'reactions').locator('path').count()) > 0);
  await tab.getByLabel('column to draw').selectOption('c:tip_acc');
  await tab.getByLabel('drawn over').selectOption('phi3');
  await tab.getByText('Add figure').click();
  const own = plot(tab, 'tip_acc over phi3');
  assert.equal(await own.locator('.legend button').count(), 1);
  await own.getByLabel(/remove/).click();
  assert.equal(await own.count(), 0);
}

export async function a_logarithmic_axis_tells_what_it_leaves_out(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const figure = plot(tab, 'angles');
  const log = figure.getByText('log', { exact: true });
  assert.equal(await figure.locator('.note').isVisible(), false);
  await log.click();
  assert.match(await figure.locator('.note').innerText(), /^\d+ values ≤ 0 are not shown/);
  // phi3 is negative there
  await seek(tab, 1.5);
  assert.ok((await value(tab, 'angles', 1)) < 0);
  const [top, bottom] = await figure.locator('clipPath rect').evaluate((box) => [box.y.baseVal.value, box.y.baseVal.value + box.height.baseVal.value]);
  const marks = await figure.locator('.overlay circle').evaluateAll((all) => all.map((mark) => mark.cy.baseVal.value));
  assert.equal(marks.length, 1);
  assert.ok(marks.every((y) => y >= top && y <= bottom), marks.join());
  await log.click();
  assert.equal(await figure.locator('.note').isVisible(), false);
}

export async function legends_show_all_their_curves(open) {
  for (const width of [390, 1280]) {
    const { tab } = await open('crank_rocker', { study: 'fluctuation', width });
    const legend = plot(tab, 'speed').locator('.legend');
    const [all, seen] = await legend.evaluate((box) => [box.scrollHeight, box.clientHeight]);
    assert.ok(all <= seen + 1, `${all} of ${seen} in ${width}`);
    // the run that is looked at is drawn strong
    const strong = () => legend.locator('button').evaluateAll((entries) => entries.map((entry) => entry.classList.contains('strong')).indexOf(true));
    assert.equal(await strong(), 0);
    await tab.locator('[aria-label=run]').selectOption({ index: 5 });
    assert.equal(await strong(), 5);
    await plot(tab, 'speed').scrollIntoViewIfNeeded();
    await tab.waitForTimeout(100);
    const widths = await plot(tab, 'speed').locator('svg.chart g[clip-path] path').evaluateAll((lines) => lines.map((line) => Number(line.getAttribute('stroke-width'))));
    assert.equal(widths.indexOf(Math.max(...widths)), 5);
  }
}

export async function numbers_of_runs_are_drawn(open) {
  const { tab, directory } = await open('crank_rocker', { study: 'fluctuation' });
  const { delta } = csv(`${directory}/fluctuation.csv`);
  await plot(tab, 'delta').locator('.plot-stage').focus();
  const cells = await tab.locator('.table', { hasText: 'Runs' }).locator('tbody tr:not([aria-hidden])').count();
  assert.equal(cells, delta.length);
  assert.equal(await plot(tab, 'speed').locator('.legend button').count(), 14);
}

export async function files_of_a_figure_have_its_curves(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const saved = async (kind) => {
    const [download] = await Promise.all([tab.waitForEvent('download'), plot(tab, 'angles').getByText(kind, { exact: true }).click()]);
    assert.equal(download.suggestedFilename(), `one-turn-angles.${kind.toLowerCase()}`);
    return readFileSync(await download.path(), 'utf8');
  };
  const svg = await saved('SVG');
  assert.match(svg, /^<svg xmlns="http:\/\/www.w3.org\/2000\/svg"/);
  assert.ok(!svg.includes('var(') && svg.includes('>phi3<') && svg.includes('stroke="#0072b2"'));
  const lines = (await saved('CSV')).trim().split('\n');
  assert.equal(lines[0], 'theta [deg],phi2 [deg],phi3 [deg]');
  assert.ok(lines.length > 1000, `${lines.length} lines`);
  assert.match(lines[1], /^0,33\.35352/);
}

export async function a_second_axis_has_its_own_unit(open) {
  const { tab, directory } = await open('winch');
  const { time: seconds, speed } = csv(`${directory}/fall.csv`);
  const figure = plot(tab, 'height');
  const texts = await figure.locator('svg.chart text').allTextContents();
  assert.ok(texts.includes('speed [mm/s]'), texts.join());
  assert.match(await figure.locator('.legend').innerText(), /speed \(right\)/);
  await seek(tab, seconds[60]);
  near(await value(tab, 'height', 1), 1e3 * speed[60], 1e-2, 'speed in mm/s');
  // over its own axis it fills the panel as the other curve does
  const heights = await figure.locator('svg.chart g[clip-path] path').evaluateAll((all) => all.map((one) => one.getBBox().height));
  assert.ok(heights.every((height) => height > 60), heights.join());
}

export async function measured_data_are_points(open) {
  const { tab } = await open('winch');
  const figure = plot(tab, 'height');
  const lines = await figure.locator('svg.chart g[clip-path] path').evaluateAll((all) => all.map((one) => one.getAttribute('d')));
  const dotted = lines.filter((d) => d.includes('h0'));
  assert.deepEqual([lines.length, dotted.length, dotted[0].match(/h0/g).length], [3, 1, 4]);
  assert.match(await figure.locator('.legend').innerText(), /seen/);
}

export async function no_two_curves_are_alike(open) {
  for (const [study, name, count] of [['fluctuation', 'speed', 14], ['lengths', 'phi2', 7]]) {
    const { tab } = await open('crank_rocker', { study });
    const lines = await plot(tab, name).locator('svg.chart g[clip-path] path').evaluateAll((all) => all.map((one) => `${one.getAttribute('stroke')} ${one.getAttribute('stroke-dasharray')}`));
    assert.deepEqual([lines.length, new Set(lines).size], [count, count], study);
    const legend = await plot(tab, name).locator('.legend path').evaluateAll((all) => all.map((one) => `${one.getAttribute('stroke')} ${one.getAttribute('stroke-dasharray')}`));
    assert.deepEqual(legend, lines);
  }
}

/** Colours of a curve as three numbers, of what a browser or an SVG file writes. */
function rgb(text) {
  if (text.startsWith('#')) return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
  const numbers = text.match(/[\d.]+/g).slice(0, 3).map(Number);
  return text.startsWith('color(') ? numbers.map((part) => 255 * part) : numbers;
}

export async function curves_look_as_in_the_figures_of_the_program(open) {
  for (const [study, name, count] of [['lengths', 'angle', 10], ['path', 'both', 2]]) {
    const { tab, directory } = await open('swing', { study });
    const svg = readFileSync(`${directory}/${study}-${name}.svg`, 'utf8');
    // entries of its legend: a line, or dots in a row, and a text
    const entries = [...svg.matchAll(/<(?:polyline points="[\d.]+,([\d.]+) [\d.]+,\1" fill="none" stroke="(?=#\w+" stroke-width="3")|circle cx="[\d.]+" cy="[\d.]+" r="5" fill=")(#\w+)"(?: stroke-width="3")?(?: stroke-dasharray="([\d. ]+)")?[^>]*>\n<text[^>]*>([^<]+)</g)];
    const wanted = new Map(entries.map(([, , color, dash, label]) => [label, { color: rgb(color), dash: dash?.split(' ').map((part) => Number(part) / 2).join(' ') ?? 'none' }]));
    assert.equal(wanted.size, count, [...wanted.keys()].join());
    const found = await plot(tab, name).locator('.legend button').evaluateAll((all) => all.map((entry) => {
      const line = entry.querySelector('path');
      return { label: entry.querySelector('span').textContent, color: getComputedStyle(line).stroke, dash: line.getAttribute('stroke-dasharray') };
    }));
    assert.equal(found.length, count);
    for (const { label, color, dash } of found) {
      const like = wanted.get(label);
      assert.ok(like, `${label} is not in the figure`);
      rgb(color).forEach((part, k) => near(part, like.color[k], 1.01, `${label}: ${color}`));
      assert.equal(dash, like.dash, label);
    }
    // a file that the page writes has them, too
    const [download] = await Promise.all([tab.waitForEvent('download'), plot(tab, name).getByText('SVG', { exact: true }).click()]);
    const saved = [...readFileSync(await download.path(), 'utf8').matchAll(/<path d="M[^"]*" stroke="(#\w+)" stroke-dasharray="([^"]+)"[^>]*><text[^>]*>([^<]+)</g)];
    assert.equal(saved.length, count);
    for (const [, color, dash, label] of saved) {
      rgb(color).forEach((part, k) => near(part, wanted.get(label).color[k], 1.01, `${label} in the file`));
      assert.equal(dash, wanted.get(label).dash, label);
    }
  }
}

export async function curves_that_turn_back_show_their_direction(open) {
  const { tab, directory } = await open('swing', { study: 'path' });
  const onPage = (name) => plot(tab, name).locator('svg.chart g[clip-path] polygon').evaluateAll((all) => all.map((one) => one.getAttribute('points')));
  const inFile = (name) => [...readFileSync(`${directory}/path-${name}.svg`, 'utf8').matchAll(/<polygon points="([^"]+)" fill="#0072b2"/g)].map(([, points]) => points);
  for (const heads of [await onPage('height'), inFile('height')]) {
    const corners = heads.map((points) => points.split(' ').map((pair) => pair.split(',').map(Number)));
    assert.ok(corners.length >= 2 && corners.length <= 6, heads.join('; '));
    // it falls from the right to the left, and comes back
    const ways = corners.map(([tip, a, b]) => Math.sign(tip[0] - (a[0] + b[0]) / 2));
    assert.deepEqual([ways[0], ways[ways.length - 1]], [-1, 1]);
    // unobtrusive
    for (const [tip, a, b] of corners) assert.ok(Math.hypot(tip[0] - (a[0] + b[0]) / 2, tip[1] - (a[1] + b[1]) / 2) < 20);
  }
  assert.deepEqual([await onPage('both'), inFile('both')], [[], []], 'over time there is nothing to tell');
}

export async function axes_of_flat_paths_have_several_numbers(open) {
  const { tab } = await open('jansen_leg', { study: 'step' });
  const upright = await plot(tab, 'path').locator('svg.chart text[text-anchor=end]').allTextContents();
  assert.ok(upright.length >= 3, upright.join());
}

export async function legends_tell_values_in_the_units_of_axes(open) {
  const { tab, directory } = await open('crank_rocker', { study: 'one-turn' });
  const { theta, 'O.f': force } = csv(`${directory}/one-turn.csv`);
  await seek(tab, theta[30]);
  const figure = plot(tab, 'reactions');
  await figure.scrollIntoViewIfNeeded();
  const first = async (of) => (await of.locator('.value').first().innerText()).replace('−', '-').split(/ (.*)/);
  const [newtons, unit] = await first(figure);
  assert.ok((await figure.locator('svg.chart text').allTextContents()).includes('force [kN]'));
  assert.equal(unit, 'kN');
  near(Number(newtons), force[30] / 1e3, 1e-4 * (force[30] / 1e3), 'O.f in kN');
  // each curve of a sweep has its unit too, clear of its name
  const sweep = await open('crank_rocker', { study: 'fluctuation' });
  const many = plot(sweep.tab, 'speed');
  assert.equal((await first(many))[1], 'rad/s');
  const gaps = await many.locator('.legend button').evaluateAll((all) => all.map((entry) => {
    const [name, value] = ['span', '.value'].map((part) => {
      const range = document.createRange();
      range.selectNodeContents(entry.querySelector(part));
      return range.getBoundingClientRect();
    });
    return [value.left - name.right, entry.parentElement.getBoundingClientRect().right - value.right];
  }));
  gaps.forEach(([between, behind]) => assert.ok(between > 8 && behind > 0, `${between} and ${behind} pixels`));
}

export async function poles_at_dead_points_leave_the_axis_with_a_word(open) {
  const { tab, directory } = await open('stuck');
  const found = csv(`${directory}/turn.csv`)['rocker.alpha'].filter(Number.isFinite);
  assert.ok(Math.max(...found) > 4000, 'without bound');
  const ticks = (await plot(tab, 'alpha').locator('text').allTextContents()).map((text) => Number(text.replace('−', '-'))).filter(Number.isFinite);
  assert.ok(ticks.includes(100) && ticks.every((tick) => Math.abs(tick) < 1000), ticks.join());
  assert.equal(await plot(tab, 'alpha').locator('.leaving').count(), 2);
  assert.equal(await plot(tab, 'alpha').locator('.note').innerText(), 'arrows: without bound towards a dead point');
  // a rate that stays as it is has no pole
  assert.equal(await plot(tab, 'speed').locator('.leaving').count(), 0);
  assert.equal(await plot(tab, 'speed').locator('.note').isVisible(), false);
}

export async function numbers_of_runs_without_bound_leave_the_axis(open) {
  const { tab, directory } = await open('poles');
  for (const [name, inView, count] of [['pole', 2, 2], ['one', 1, 2], ['both', 1, 2], ['plain', 1, 0]]) {
    const figure = plot(tab, name);
    const ticks = (await figure.locator('text').allTextContents()).map((text) => Number(text.replace('−', '-'))).filter(Number.isFinite);
    assert.ok(Math.max(...ticks) <= 10, `${name}: ${ticks}`);
    const ways = (of) => of.map((points) => points.split(' ').map((pair) => pair.split(',').map(Number))).map(([tip, left]) => Math.sign(left[1] - tip[1])).sort();
    const onPage = ways(await figure.locator('.leaving').evaluateAll((all) => all.map((one) => one.getAttribute('points'))));
    const inFile = ways([...readFileSync(`${directory}/turn-${name}.svg`, 'utf8').matchAll(/<polygon points="([^"]+)" fill="#0072b2"/g)].map(([, points]) => points));
    assert.equal(onPage.length, count, name);
    assert.deepEqual(onPage, inFile, name);
    assert.equal(await figure.locator('.note').isVisible() && (await figure.locator('.note').innerText()), count > 0 && 'arrows: without bound', name);
    const line = await figure.locator('svg.chart g[clip-path] path').first().getAttribute('d');
    assert.equal(line.split('M').length - 1, inView, `${name}: ${line}`);
  }
}

export async function paths_reach_dead_points_where_rates_have_no_value(open) {
  const { tab, directory } = await open('stuck');
  const { 'rocker.alpha': rates, 'coupler.end.x': x } = csv(`${directory}/turn.csv`);
  const last = x.length - 1;
  assert.ok([0, last].every((row) => !Number.isFinite(rates[row]) && Number.isFinite(x[row])), 'no rate in the first and the last row');
  const line = await plot(tab, 'path').locator('svg.chart g[clip-path] path').first().getAttribute('d');
  assert.equal(line.split('M').length, 2, 'one line without a gap');
  // from the first place to the last one, as told by the axis
  const points = line.slice(1).split('L').map((pair) => Number(pair.split(' ')[0]));
  const [low, high] = [Math.min(...x), Math.max(...x)];
  const across = (row) => (x[row] - low) / (high - low);
  const ends = [Math.min(...points), Math.max(...points)];
  for (const [row, at] of [[0, points[0]], [last, points[points.length - 1]]]) near((at - ends[0]) / (ends[1] - ends[0]), across(row), 5e-3, `row ${row}`);
  // between the last two rows the cursor finds a value, too
  await seek(tab, (csv(`${directory}/turn.csv`)['O.angle'][last] + csv(`${directory}/turn.csv`)['O.angle'][last - 1]) / 2);
  assert.ok(Number.isFinite(await value(tab, 'path')));
}

export async function curves_beside_poles_are_those_of_the_rows(open) {
  const { tab, directory } = await open('slant');
  const { 'O.angle': angle, 'drive.torque': torque } = csv(`${directory}/turn.csv`);
  for (const row of [40, 55, 62, 77, 90]) {
    await seek(tab, angle[row]);
    // from -10 to 10 N m at most
    near(await value(tab, 'torque'), torque[row], 2e-3, `torque at ${angle[row]}`);
  }
}

export async function axes_say_what_those_of_the_program_say(open) {
  for (const [model, study] of [['digits', 'swing'], ['swing', 'path']]) {
    const { tab, directory } = await open(model, { study });
    const names = await tab.locator('[data-plot]').evaluateAll((all) => all.map((one) => one.dataset.plot));
    for (const name of names) {
      await plot(tab, name).scrollIntoViewIfNeeded();
      await tab.waitForTimeout(100);
      const svg = readFileSync(`${directory}/${study}-${name}.svg`, 'utf8');
      // the names of axes have a size of their own, and units behind `in`
      const wanted = [...svg.matchAll(/<text[^>]* font-size="22"[^>]*>([^<]+)</g)].map(([, text]) => text.replace(/ in ([^ ].*)$/, ' [$1]'));
      const found = await plot(tab, name).locator('svg.chart text').allTextContents();
      assert.ok(wanted.length >= 2, svg.slice(0, 2000));
      for (const axis of wanted) assert.ok(found.includes(axis), `${name}: ${axis} is not among ${found.join(' | ')}`);
    }
  }
  const { tab } = await open('digits');
  // numbers are equal in no place, and end with the axis
  const ticks = (await plot(tab, 'nearly').locator('svg.chart text[text-anchor=end]').allTextContents());
  assert.ok(ticks.length >= 3 && new Set(ticks).size === ticks.length, ticks.join());
  const upright = (await plot(tab, 'spike').locator('svg.chart text[text-anchor=end]').allTextContents()).map(Number);
  assert.deepEqual([Math.min(...upright), Math.max(...upright)], [0, 20]);
}

export async function values_are_told_with_units_and_not_with_powers_of_ten_as_units(open) {
  const { tab } = await open('digits');
  await seek(tab, 0.25);
  const told = (name) => plot(tab, name).locator('.value').first().innerText();
  assert.match(await told('nearly'), /^29\.99999999\d+ deg$/);
  assert.match(await told('shift'), /^2\.000000[5-9]\d* m$/);
  assert.match(await told('tiny'), /^[5-9]\.\d+·10⁻¹⁸ m$/);
  assert.match(await told('spike'), /^4\.\d+$/);
}

export async function axes_of_different_places_fill_their_ranges(open) {
  const { tab } = await open('double_wishbone', { study: 'bump' });
  const ticks = (await plot(tab, 'track').locator('text').allTextContents()).map((text) => Number(text.replace('−', '-'))).filter(Number.isFinite);
  // from -18 mm to 4 mm over 169 mm
  assert.ok(ticks.includes(-15) && ticks.includes(-5), ticks.join());
  // of a truss that falls through the line is broken
  const { tab: truss } = await open('truss', { study: 'path' });
  const line = await plot(truss, 'height').locator('path[stroke-linejoin=round]').first().getAttribute('d');
  assert.equal(line.split('M').length - 1, 2, line);
}

export async function values_of_few_runs_are_marked(open) {
  const { tab } = await open('sizes', { study: 'sizes' });
  const figure = plot(tab, 'reach');
  await figure.scrollIntoViewIfNeeded();
  assert.equal(await figure.locator('circle.run').count(), 3);
  const rows = plot(tab, 'path');
  await rows.scrollIntoViewIfNeeded();
  assert.equal(await rows.locator('circle.run').count(), 0, 'curves of rows have none');
}
