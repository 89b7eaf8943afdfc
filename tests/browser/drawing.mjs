// The signs of a drawing, as in the figures of the program: stops, drives, ground; and its arrows.

import { assert } from './read.mjs';

/** Waits until the page has drawn what it is to show. */
const seen = (tab) => tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** How many pixels of the drawing have a colour, and the box around them. */
async function inked(tab, wanted) {
  await seen(tab);
  return tab.locator('.canvas canvas').evaluate((canvas, wanted) => {
    const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height }).getContext('2d', { willReadFrequently: true });
    copy.drawImage(canvas, 0, 0);
    const { data, width } = copy.getImageData(0, 0, canvas.width, canvas.height);
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] < 255 || wanted.some((value, k) => Math.abs(data[i + k] - value) > 2)) continue;
      const [x, y] = [(i / 4) % width, Math.floor(i / 4 / width)];
      box.splice(0, 4, Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y));
      count++;
    }
    return { count, box, width: box[2] - box[0], height: box[3] - box[1], size: [width, canvas.height] };
  }, wanted);
}
const STOP = [176, 20, 40];
const RUST = [150, 60, 20];
const DRIVE = [0, 112, 84];
/** Of bearings: a quarter of --faint on --paper. */
const BEARING = [229, 232, 234];
const LOADS = [213, 94, 0];
const VELOCITIES = [0, 158, 115];

export async function stops_are_drawn(open) {
  const { tab } = await open('marks', { study: 'slide' });
  const found = await inked(tab, STOP);
  assert.ok(found.count > 80, `stops of ${found.count} pixels`);
  // two bars across the way of the slide, farther apart than it goes
  assert.ok(found.width > 80 && found.width > 2 * found.height, JSON.stringify(found));
  const hinge = await open('marks', { study: 'hinge' });
  const { count } = await inked(hinge.tab, STOP);
  assert.ok(count > 30, `stops of ${count} pixels at a hinge`);
  const none = await open('crank_rocker', { study: 'one-turn' });
  assert.equal((await inked(none.tab, STOP)).count, 0);
}

export async function clutches_brakes_and_shafts_are_drawn(open) {
  const inks = {};
  for (const study of ['apart', 'together', 'brake', 'shoe', 'shaft', 'none']) {
    const { tab } = await open('held', { study });
    await tab.evaluate(() => { const names = [...document.querySelectorAll('label')].find((label) => label.textContent.includes('names')).querySelector('input'); if (names.checked) names.click(); });
    inks[study] = await inked(tab, RUST);
  }
  assert.equal(inks.none.count, 0);
  // two plates across a line, arcs around one place, shoes, a spiral in a line
  for (const study of ['apart', 'together', 'brake', 'shoe', 'shaft']) assert.ok(inks[study].count > 30, `${study}: ${JSON.stringify(inks[study])}`);
  // plates and a spiral stand out on both sides of the line; what is so flat has the whole width of the page
  for (const study of ['apart', 'shaft']) assert.ok(inks[study].height > 15 && inks[study].size[0] > 800, `${study}: ${JSON.stringify(inks[study])}`);
  for (const study of ['together', 'brake', 'shoe']) assert.ok(inks[study].width < 50 && inks[study].height < 50, `${study}: ${JSON.stringify(inks[study])}`);
}

export async function what_drives_a_joint_is_drawn(open) {
  for (const [model, study] of [['crank_rocker', 'one-turn'], ['sleeve', 'out'], ['door', 'open']]) {
    const { tab } = await open(model, { study });
    const { count, width } = await inked(tab, DRIVE);
    assert.ok(count > 30 && width > 15, `${model}: ${count} pixels, ${width} wide`);
  }
  const free = await open('marks', { study: 'slide' });
  assert.equal((await inked(free.tab, DRIVE)).count, 0);
}

export async function no_outline_hides_a_bearing(open) {
  const { tab } = await open('covered', { study: 'turn' });
  const { count } = await inked(tab, BEARING);
  assert.ok(count > 100, `${count} pixels`);
}

export async function paths_have_none_of_the_colours_of_loads_and_reactions(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const names = await tab.evaluate(() => window.grashof.names().filter(({ of }) => of === 'path').length);
  assert.equal(names, 2);
  // in their lines and their names
  assert.equal((await inked(tab, LOADS)).count, 0);
}

export async function arrows_have_room(open) {
  for (const width of [1280, 390]) {
    const { tab } = await open('pushed', { width });
    for (const part of ['0', '5000', '10000']) {
      await tab.locator('.scrub').fill(part);
      const { count, box: [left, top, right], size } = await inked(tab, LOADS);
      assert.ok(count > 100 && left > 3 && top > 3 && right < size[0] - 4, `${width}, ${part}: from ${left}, ${top} to ${right} of ${size}`);
    }
  }
}

export async function arrows_have_room_in_space(open) {
  const { tab } = await open('arm', { study: 'lift' });
  await tab.getByRole('checkbox', { name: 'velocities' }).check();
  let most = 0;
  for (let part = 0; part <= 10; part++) {
    await tab.locator('.scrub').fill(String(1000 * part));
    const { count, box: [left, top, right, bottom], size } = await inked(tab, VELOCITIES);
    if (count > 0) assert.ok(left > 3 && top > 3 && right < size[0] - 4 && bottom < size[1] - 4, `${part}: from ${left}, ${top} to ${right}, ${bottom} of ${size}`);
    most = Math.max(most, count);
  }
  assert.ok(most > 300, `${most} pixels of arrows`);
}

/** What is told where a reader points. */
async function told(tab, [x, y]) {
  const { x: left, y: top } = await tab.locator('.canvas').boundingBox();
  await tab.mouse.move(left + x, top + y);
  await seen(tab);
  const tip = tab.locator('.canvas .tip');
  return (await tip.isVisible()) ? tip.innerText() : null;
}

export async function what_is_pointed_at_is_named(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await seen(tab);
  const names = await tab.evaluate(() => grashof.names());
  const place = (text) => names.find((name) => name.text === text).at;
  assert.match(await told(tab, place('A')), /^A: revolute, .*crank/);
  // the path of its middle runs there, too
  assert.equal(await told(tab, place('coupler')), 'coupler\npath of coupler.com');
  assert.equal(await told(tab, [4, 4]), null);
  const spatial = (await open('stewart_platform', { study: 'ride' })).tab;
  await seen(spatial);
  const { at } = (await spatial.evaluate(() => grashof.names())).find(({ text }) => text === 'cylinder2');
  assert.equal(await told(spatial, at), 'cylinder2');
}

export async function what_stands_behind_another_body_is_not_what_one_points_at(open) {
  const { tab } = await open('behind');
  await tab.getByRole('checkbox', { name: 'names' }).uncheck();
  await seen(tab);
  const { x, y, width, height } = await tab.locator('.canvas').boundingBox();
  const across = async () => {
    const all = new Set();
    for (let k = 0; k <= 40; k++) all.add(await told(tab, [(width * k) / 40, height / 2 + 12]));
    return [...all].filter((text) => text !== null).map((text) => text.split(':')[0]).sort();
  };
  assert.deepEqual(await across(), ['near']);
  // half a turn of the view
  await tab.mouse.move(x + 20, y + height / 2);
  await tab.mouse.down();
  await tab.mouse.move(x + 20 + Math.PI / 0.008, y + height / 2, { steps: 4 });
  await tab.mouse.up();
  assert.deepEqual(await across(), ['back', 'near']);
}

export async function names_without_room_are_told(open) {
  for (const [model, study, bodies] of [['excavator', 'dig', /boom|stick|bucket|lever|link|(barrel|rod)[123]/g], ['stewart_platform', 'ride', /plate|(cylinder|rod)[1-6]/g]]) {
    const { tab } = await open(model, { study });
    const named = new Set();
    for (let part = 0; part <= 10; part++) {
      await tab.locator('.scrub').fill(String(1000 * part));
      await seen(tab);
      for (const { text, of } of await tab.evaluate(() => grashof.names())) if (of === 'body') named.add(text);
    }
    const note = await tab.locator('.unnamed').innerText();
    assert.match(note, /^no room for the names? of .*: point at a part/);
    const left = note.match(bodies) ?? [];
    const count = { excavator: 11, stewart_platform: 13 }[model];
    assert.equal(new Set([...named, ...left]).size, count, `${model}: ${[...named]} and ${note}`);
    await tab.getByRole('checkbox', { name: 'names' }).uncheck();
    await seen(tab);
    assert.equal(await tab.locator('.unnamed').innerText(), '');
  }
}

export async function the_largest_torque_of_the_loads_is_told(open) {
  const texts = async (tab) => {
    await seen(tab);
    return (await tab.evaluate(() => grashof.scales())).map(({ kind, text }) => [kind, text]);
  };
  const { tab } = await open('winch');
  assert.deepEqual((await texts(tab))[1], ['torques', 'torques: at most 1 N m']);
  await tab.getByRole('checkbox', { name: 'loads' }).uncheck();
  assert.deepEqual((await texts(tab)).map(([kind]) => kind), ['reactions']);
  const { tab: pushed } = await open('pushed');
  assert.deepEqual((await texts(pushed)).map(([kind]) => kind), ['loads', 'reactions'], 'no torque, no word');
}

export async function the_largest_moment_of_a_joint_is_told(open) {
  const { tab } = await open('cantilever');
  await seen(tab);
  const told = await tab.evaluate(() => grashof.scales());
  assert.deepEqual(told.map(({ kind }) => kind), ['reactions', 'moments']);
  assert.equal(told[1].text, 'moments: at most 100 N m');
}

export async function modes_are_chosen_by_their_frequencies(open) {
  const { tab } = await open('leaf', { study: 'damped' });
  const select = tab.locator('select[aria-label=drawing]');
  await select.waitFor();
  const titles = await select.locator('option').allTextContents();
  assert.ok(titles.length === 2, `${titles}`);
  titles.forEach((title, k) => assert.match(title, new RegExp(`^mode ${k + 1}: [0-9.]+ Hz, damping ratio [0-9.]+$`)));
}
