// The mechanism in motion: places against the tables, play, keys, scrubbing, runs, drawings.

import { assert, csv, near, seek, time, until } from './read.mjs';

/** Largest length of models/crank_rocker.yaml, m. */
const SIZE = 1.2;

export async function joints_are_where_the_tables_say(open) {
  const { tab, directory } = await open('crank_rocker', { study: 'one-turn' });
  const { theta, phi2, phi3 } = csv(`${directory}/one-turn.csv`);
  const rows = theta.map((_, i) => i).filter((i) => i % 7 === 0);
  const places = await tab.evaluate((at) => at.map((x) => {
    grashof.seek(x);
    return ['A', 'B', 'C'].map((joint) => grashof.place(joint));
  }), rows.map((i) => theta[i]));
  rows.forEach((i, k) => {
    const [a, b, c] = places[k];
    const A = [0.15 * Math.cos(theta[i]), 0.15 * Math.sin(theta[i])];
    const B = [A[0] + Math.cos(phi2[i]), A[1] + Math.sin(phi2[i])];
    const again = [1 + 0.55 * Math.sin(phi3[i]), 0.55 * Math.cos(phi3[i])];
    for (const axis of [0, 1]) {
      near(a[axis], A[axis], 1e-6 * SIZE, `A in row ${i}`);
      near(b[axis], B[axis], 1e-6 * SIZE, `B in row ${i}`);
      near(b[axis], again[axis], 1e-6 * SIZE, `B from C in row ${i}`);
      near(c[axis], [1, 0][axis], 1e-6 * SIZE, `C in row ${i}`);
    }
  });
}

export async function joints_in_space_keep_their_distances(open) {
  const { tab, directory } = await open('four_bar_spatial', { study: 'one-turn' });
  const { theta } = csv(`${directory}/one-turn.csv`);
  const places = await tab.evaluate((at) => at.map((x) => {
    grashof.seek(x);
    return ['O', 'A', 'B', 'C'].map((joint) => grashof.place(joint));
  }), theta.filter((_, i) => i % 41 === 0));
  const distance = (p, q) => Math.hypot(...p.map((x, i) => x - q[i]));
  for (const [o, a, b, c] of places) {
    near(distance(o, a), 0.15, 1e-6 * SIZE, 'O A');
    near(distance(a, b), 1, 1e-6 * SIZE, 'A B');
    near(distance(c, b), 0.55, 1e-6 * SIZE, 'C B');
  }
  assert.equal(places[0][0].length, 3);
}

export async function it_plays_in_time_and_stops(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await tab.locator('[aria-label=speed]').selectOption('0.1×');
  await tab.locator('.play').click();
  await tab.waitForTimeout(600);
  await tab.locator('.play').click();
  const at = await time(tab);
  // 240 rpm at a tenth: about 2.5 rad/s
  assert.ok(at > 0.3 && at < 4, `at ${at}`);
  await tab.waitForTimeout(150);
  assert.equal(await time(tab), at);
  assert.match(await tab.locator('.time').innerText(), /theta [\d.]+ deg, [\d.]+ s/);
}

export async function keys_move_it(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await tab.locator('#study-title').focus();
  await tab.keyboard.press('End');
  near(await time(tab), 2 * Math.PI, 1e-9, 'end');
  await tab.keyboard.press('Home');
  assert.equal(await time(tab), 0);
  for (const _ of [1, 2]) await tab.keyboard.press('ArrowRight');
  near(await time(tab), (2 * Math.PI) / 100, 1e-9, 'two steps');
  await tab.keyboard.press('ArrowLeft');
  near(await time(tab), (2 * Math.PI) / 200, 1e-9, 'one step back');
  await tab.keyboard.press(' ');
  assert.equal(await tab.locator('.play').getAttribute('aria-label'), 'pause');
  await tab.waitForTimeout(100);
  await tab.keyboard.press(' ');
  assert.ok((await time(tab)) > 0.04);
}

export async function a_variable_that_falls_falls_in_play(open) {
  const { tab } = await open('clamp', { study: 'close' });
  const [begin, end] = [97, 37].map((angle) => (angle * Math.PI) / 180);
  near(await time(tab), begin, 1e-9, 'begin');
  await tab.locator('[aria-label=speed]').selectOption('0.1×');
  await tab.locator('.play').click();
  await tab.waitForTimeout(500);
  await tab.locator('.play').click();
  const at = await time(tab);
  // 6 deg/s
  assert.ok(at < begin - 0.01 && at > begin - 0.3, `at ${at}`);
  await tab.keyboard.press('End');
  near(await time(tab), end, 1e-9, 'end');
  await tab.keyboard.press('ArrowLeft');
  near(await time(tab), end + (begin - end) / 200, 1e-9, 'one step back');
}

export async function what_is_at_rest_has_no_transport(open) {
  for (const [model, study] of [['truss', 'loaded'], ['truss', 'path'], ['cart_pole', 'linear']]) {
    const { tab } = await open(model, { study });
    await tab.locator('.canvas canvas').waitFor();
    for (const part of ['.play', '.scrub', '.time', '[aria-label=speed]', '[aria-label="again and again"]']) assert.equal(await tab.locator(part).isVisible(), false, `${part} in ${study}`);
    assert.ok(await tab.locator('[aria-label="whole mechanism"]').isVisible());
    const before = await time(tab);
    await tab.locator('#study-title').focus();
    await tab.keyboard.press(' ');
    await tab.waitForTimeout(100);
    assert.equal(await time(tab), before, study);
  }
}

export async function what_rests_is_drawn_where_it_rests(open) {
  for (const [model, wanted] of [['hangs', [0, -1]], ['hangs-in-space', [0, 0, -1]]]) {
    const { tab } = await open(model, { study: 'rest' });
    const drawing = tab.locator('select[aria-label=drawing]');
    const image = () => tab.locator('.canvas canvas').evaluate((canvas) => canvas.toDataURL());
    await picture(tab);
    (await tab.evaluate(() => grashof.place('Q'))).forEach((x, i) => near(x, wanted[i], 1e-6, `${model}, ${i}`));
    // the start behind it, or all equilibria
    const one = await image();
    await drawing.selectOption('equilibria');
    await picture(tab);
    (await tab.evaluate(() => grashof.place('Q'))).forEach((x, i) => near(x, wanted[i], 1e-6, `${model}, all, ${i}`));
    assert.ok((await image()) !== one, model);
    assert.ok(await tab.locator('summary', { hasText: /^Equilibria$/ }).isVisible());
  }
}

export async function positions_without_time_say_so(open) {
  const { tab } = await open('crank_rocker', { study: 'lengths' });
  const [speed, timeless] = [tab.locator('[aria-label=speed]'), tab.locator('.timeless')];
  assert.equal(await timeless.innerText(), 'positions, no time');
  assert.match(await timeless.getAttribute('title'), /positions over theta.*not a motion in time/);
  assert.equal(await speed.inputValue(), 'shown in 4 s');
  assert.ok((await speed.locator('option').allInnerTexts()).every((text) => /^shown in \d+ s$/.test(text)));
  // where time would be stands what they are over
  await tab.locator('.scrub').fill('5000');
  assert.match(await tab.locator('.time').innerText(), /^theta [\d.]+ deg$/);
  await tab.evaluate(() => grashof.study('modes'));
  await until(tab, () => document.querySelector('.timeless').textContent === 'shape, no time');
  await tab.evaluate(() => grashof.study('one-turn'));
  await until(tab, () => document.querySelector('[aria-label=speed]').value === '1×');
  assert.equal(await timeless.isVisible(), false);
}

export async function the_slider_scrubs(open) {
  const { tab } = await open('crank_rocker', { study: 'start-up-exact' });
  await tab.locator('.scrub').click();
  near(await time(tab), 1, 0.03, 'middle of 2 s');
}

/** The pixels of the drawing. */
const picture = (tab) => tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(document.querySelector('.canvas canvas').toDataURL())))));

export async function runs_of_a_sweep_are_chosen(open) {
  const { tab } = await open('crank_rocker', { study: 'lengths' });
  const before = await tab.locator('.table', { hasText: 'Rows' }).locator('h3').innerText();
  const runs = tab.locator('[aria-label=run]');
  const labels = await runs.locator('option').allInnerTexts();
  assert.ok(labels.length > 3, labels.join());
  const drawn = await picture(tab);
  await runs.selectOption({ index: labels.length - 1 });
  assert.notEqual(await tab.locator('.table', { hasText: 'Rows' }).locator('h3').innerText(), before);
  assert.notEqual(await picture(tab), drawn);
}

export async function modes_swing(open) {
  const { tab } = await open('crank_rocker', { study: 'modes' });
  await seek(tab, 0);
  const still = await picture(tab);
  await tab.locator('.play').click();
  await tab.waitForTimeout(300);
  await tab.locator('.play').click();
  assert.notEqual(await picture(tab), still);
}

export async function space_is_turned_moved_and_enlarged(open) {
  for (const model of ['four_bar_spatial', 'crank_rocker']) {
    const { tab } = await open(model, { study: 'one-turn' });
    const box = await tab.locator('.canvas').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const pictures = [await picture(tab)];
    await tab.mouse.move(x, y);
    await tab.mouse.down();
    await tab.mouse.move(x + 60, y + 25, { steps: 4 });
    await tab.mouse.up();
    pictures.push(await picture(tab));
    await tab.keyboard.down('Control');
    await tab.mouse.wheel(0, -300);
    await tab.keyboard.up('Control');
    pictures.push(await picture(tab));
    assert.equal(new Set(pictures).size, 3, model);
    await tab.locator('[aria-label="whole mechanism"]').click();
    assert.equal(await picture(tab), pictures[0], model);
  }
}

export async function what_travels_far_is_followed(open) {
  for (const [model, study, end, leader, joint] of [['car', 'drive', 4, 'chassis', 'R'], ['thrown', 'fly', 1.5, 'b', 'J']]) {
    const { tab } = await open(model, { study });
    const select = tab.getByLabel('followed body');
    assert.equal(await select.evaluate((one) => one.selectedOptions[0].textContent), `follow ${leader}`);
    // the joint on the body that is followed stays where it is; without that it crosses the picture
    const path = async () => {
      const seen = [];
      for (let k = 0; k <= 8; k++) {
        await seek(tab, (end * k) / 8);
        await picture(tab);
        const name = (await tab.evaluate(() => grashof.names())).find(({ text }) => text.split(', ').includes(joint));
        if (name) seen.push(name.at);
      }
      assert.ok(seen.length > 5, `${joint} has its name at ${seen.length} places`);
      return Math.max(...seen.map(([x, y]) => Math.hypot(x - seen[0][0], y - seen[0][1])));
    };
    near(await path(), 0, 0.5, `${model}, followed`);
    await select.selectOption('follow nothing');
    assert.ok((await path()) > 200, model);
    await select.selectOption(`follow ${leader}`);
    near(await path(), 0, 0.5, `${model}, followed again`);
  }
  // what stays in its place is not followed, and a point alone is seen with something around it
  for (const [model, study, body] of [['crank_rocker', 'one-turn', 'coupler'], ['truss', 'path', 'node']]) {
    const { tab } = await open(model, { study });
    const select = tab.getByLabel('followed body');
    assert.equal(await select.evaluate((one) => one.selectedIndex), 0);
    await select.selectOption(`follow ${body}`);
    await picture(tab);
  }
}

export async function arrows_are_drawn_on_demand(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await seek(tab, 2);
  const pictures = [await picture(tab)];
  for (const kind of ['velocities', 'accelerations', 'reactions']) {
    await tab.getByRole('checkbox', { name: kind }).check();
    pictures.push(await picture(tab));
  }
  await tab.getByLabel('length of the arrows').fill('60');
  pictures.push(await picture(tab));
  assert.equal(new Set(pictures).size, 5);
}

export async function arrows_begin_at_the_scale_of_the_model(open) {
  const { tab } = await open('winch');
  for (const kind of ['loads', 'reactions']) assert.ok(await tab.getByRole('checkbox', { name: kind }).isChecked(), kind);
  assert.equal(await tab.locator('.told').innerText(), 'loads 100 N/m, reactions 200 N/m');
  const slider = tab.getByLabel('length of the arrows');
  assert.equal(await slider.inputValue(), '25');
  const before = await picture(tab);
  await slider.fill('50');
  assert.equal(await tab.locator('.told').innerText(), 'loads 50 N/m, reactions 100 N/m');
  assert.notEqual(await picture(tab), before);
}

/** The opaque points of the drawing: colours and the places of those that differ from other ones. */
const inked = (tab, others) => tab.evaluate((before) => {
  const canvas = document.querySelector('.canvas canvas');
  const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height }).getContext('2d', { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const now = new Uint32Array(copy.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
  window.kept ??= now;
  return before ? now.reduce((sum, color, k) => sum + Number(color !== window.kept[k] && window.kept[k] >>> 24 === 255), 0) : 0;
}, others);

export async function paths_lie_over_bodies(open) {
  const { tab } = await open('planetary_gear');
  await tab.getByLabel('paths').selectOption('no paths');
  await picture(tab);
  await inked(tab, false);
  await tab.getByLabel('paths').selectOption('whole paths');
  await picture(tab);
  // those of the planets cross wheels, below which nothing of them is seen
  const seen = await inked(tab, true);
  assert.ok(seen > 300, `${seen} points of paths are seen over wheels`);
}

/** Force, velocity or acceleration to the pixel of each kind of arrow, of what the drawing tells. */
const told = async (tab) => {
  await picture(tab);
  return new Map((await tab.evaluate(() => grashof.scales())).filter(({ kind }) => kind !== 'torques').map(({ kind, text, length }) => {
    const [, number, prefix, unit] = /^\w+: ([\d.]+) ([km]?)(N|m\/s|m\/s²)(?: without ropes and teeth)?$/.exec(text) ?? assert.fail(text);
    assert.match(number, /^(0\.0*)?[125]0*$/);
    assert.ok(length > 20 && length <= 60.001, `${kind}: ${length} pixels`);
    return [kind, { unit, pixel: (Number(number) * ({ k: 1e3, m: 1e-3 }[prefix] ?? 1)) / length }];
  }));
};

export async function arrows_tell_their_scale(open) {
  const { tab } = await open('winch');
  const slider = tab.getByLabel('length of the arrows');
  const before = await told(tab);
  assert.deepEqual([...before.keys()], ['loads', 'reactions']);
  // 100 N/m and 200 N/m, also in a larger view
  near(before.get('reactions').pixel / before.get('loads').pixel, 2, 1e-9, 'reactions by loads');
  await tab.locator('.canvas canvas').focus();
  await tab.keyboard.press('+');
  near((await told(tab)).get('loads').pixel / before.get('loads').pixel, 1 / 1.2, 1e-9, 'with zoom');
  await slider.fill('50');
  near((await told(tab)).get('loads').pixel / before.get('loads').pixel, 1 / 2.4, 1e-9, 'with the slider');
  await tab.getByRole('checkbox', { name: 'loads' }).uncheck();
  assert.deepEqual([...(await told(tab)).keys()], ['reactions']);
  for (const model of ['crank_rocker', 'four_bar_spatial']) {
    const { tab: other } = await open(model, { study: 'one-turn' });
    for (const kind of ['velocities', 'accelerations']) await other.getByRole('checkbox', { name: kind }).check();
    const scales = await told(other);
    assert.deepEqual([...scales].map(([kind, { unit }]) => [kind, unit]), [['velocities', 'm/s'], ['accelerations', 'm/s²']]);
    // the longest arrow, at rest of the slider a quarter of the drawing, is that of the tip of the rocker or of the crank pin: 2.6 m/s to 11 m/s
    const { width, height } = await other.locator('.canvas').boundingBox();
    const most = scales.get('velocities').pixel * 0.25 * Math.min(width, height);
    assert.ok(most > 2.6 && most < 11, `${model}: ${most} m/s`);
  }
}

/** How deep points of one outline are within another one, at most, or with `out` outside of it, pixels. */
function depth(points, around, out = false) {
  const edges = around.map((a, k) => [a, around[(k + 1) % around.length]]);
  return Math.max(0, ...points.map(([x, y]) => {
    const inside = edges.filter(([a, b]) => (a[1] > y) !== (b[1] > y) && x < a[0] + ((y - a[1]) / (b[1] - a[1])) * (b[0] - a[0])).length % 2 === 1;
    if (inside === out) return 0;
    return Math.min(...edges.map(([a, b]) => {
      const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
      const part = Math.min(Math.max(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy || 1), 0), 1);
      return Math.hypot(x - a[0] - part * dx, y - a[1] - part * dy);
    }));
  }));
}

export async function teeth_mesh(open) {
  const trains = [
    ['planetary_gear', { ring: 72, planet1: 27, planet2: 27, planet3: 27, sun: 18 }, [1, 2, 3].flatMap((k) => [['sun', `planet${k}`], ['ring', `planet${k}`]])],
    ['train', { pinion: 20, wheel: 55, bar: 20 }, [['pinion', 'wheel'], ['bar', 'pinion']]],
  ];
  for (const [model, teeth, pairs] of trains) {
    const { tab } = await open(model);
    for (const part of [0, 0.13, 0.4, 0.77]) {
      await tab.locator('.scrub').fill(String(10_000 * part));
      await picture(tab);
      const wheels = await tab.evaluate(() => grashof.wheels());
      assert.deepEqual(Object.fromEntries(wheels.map((wheel) => [wheel.body, wheel.teeth])), teeth);
      const outline = (body) => wheels.find((wheel) => wheel.body === body).outline;
      const across = (points, axis) => Math.max(...points.map((at) => at[axis])) - Math.min(...points.map((at) => at[axis]));
      for (const [a, b] of pairs) {
        const [p, q] = [outline(a), outline(b)];
        // a tooth is as high as 2.25 modules
        const module = across(q, 0) / teeth[b];
        const most = a === 'ring' ? depth(q, p, true) : Math.max(depth(p, q), depth(q, p));
        assert.ok(most < 0.06 * module, `${a} and ${b} at ${part}: ${most} pixels deep, of modules of ${module}`);
      }
    }
  }
}

/** The names in the drawing at places evenly over the motion, as the page plays. */
const namesOver = (tab, count) => tab.evaluate(async (steps) => {
  const slider = document.querySelector('.scrub');
  const out = [];
  for (let k = 0; k <= steps; k++) {
    slider.value = String(Math.round((10_000 * k) / steps));
    slider.dispatchEvent(new Event('input'));
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    out.push(grashof.names());
  }
  return out;
}, count);

export async function the_page_begins_as_the_figure_is_seen(open) {
  const { tab } = await open('door');
  near(await time(tab), (37 * Math.PI) / 180, 1e-9, 'the place that `at` names');
  // of another study at its first position, from the side from which figures are isometric
  const { tab: other } = await open('heavy_top', { study: 'nutation' });
  assert.equal(await time(other), 0);
  for (const [page, azimuth, elevation] of [[tab, -Math.PI / 2, Math.PI / 2], [other, Math.PI / 4, Math.asin(1 / Math.sqrt(3))]]) {
    const [, , , turn, tilt] = await page.evaluate(() => grashof.look());
    near(turn, azimuth, 1e-9, 'azimuth');
    near(tilt, elevation, 1e-9, 'elevation');
  }
}

export async function bodies_have_their_names_and_colours(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  await tab.getByLabel('paths').selectOption('no paths');
  await picture(tab);
  const bodies = (await tab.evaluate(() => grashof.names())).filter(({ of }) => of === 'body');
  assert.deepEqual(bodies.map(({ text }) => text).sort(), ['coupler', 'crank', 'rocker']);
  // the fill of the figure, beside the line between the pins
  const { at: [x, y] } = bodies.find(({ text }) => text === 'coupler');
  const color = await tab.evaluate(([x, y]) => {
    const [canvas, ratio] = [document.querySelector('.canvas canvas'), window.devicePixelRatio];
    return [...canvas.getContext('2d').getImageData(Math.round(x * ratio), Math.round(y * ratio), 1, 1).data].slice(0, 3);
  }, [x, y]);
  assert.deepEqual(color, [232, 200, 148]);
}

export async function ground_stands_beside_what_slides_on_it(open) {
  const { tab } = await open('quarter_car', { study: 'bump' });
  await tab.getByRole('checkbox', { name: 'names' }).uncheck();
  await picture(tab);
  const inked = await tab.evaluate(() => {
    const canvas = document.querySelector('.canvas canvas');
    const { data, width, height } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const ratio = window.devicePixelRatio;
    // from the middle of the body to its right edge, and there to the hatch of its guide
    const fill = (x, y) => data[4 * (y * width + x) + 3] === 255;
    let found = 0;
    for (let y = 0; y < height; y++) {
      const middle = Math.round(width / 2);
      let x = middle + Math.round(20 * ratio);
      if (!fill(x, y) || data[4 * (y * width + x) + 2] < 200) continue;
      while (x < width && fill(x, y)) x++;
      if (x - middle < 60 * ratio) continue;
      for (let k = 3; k < 8; k++) if (data[4 * (y * width + x + Math.round(k * ratio)) + 3] > 0) found++;
    }
    return found;
  });
  assert.ok(inked > 20, `${inked} points of hatch beside the body`);
}

export async function springs_have_their_names(open) {
  const { tab } = await open('cam_follower', { study: 'turn' });
  await picture(tab);
  assert.deepEqual((await tab.evaluate(() => grashof.names())).filter(({ of }) => of === 'link').map(({ text }) => text), ['return']);
}

export async function paths_have_their_names(open) {
  const { tab } = await open('jansen_leg', { study: 'step' });
  const paths = async () => {
    await picture(tab);
    return (await tab.evaluate(() => grashof.names())).filter(({ of }) => of === 'path').map(({ text }) => text);
  };
  assert.deepEqual(await paths(), ['shin.S']);
  await tab.getByLabel('paths').selectOption('no paths');
  assert.deepEqual(await paths(), []);
}

export async function scales_of_space_stand_below_the_mechanism(open) {
  const { tab } = await open('stewart_platform', { study: 'ride', width: 390 });
  for (const kind of ['velocities', 'accelerations']) await tab.getByRole('checkbox', { name: kind }).check();
  await picture(tab);
  const { height } = await tab.locator('.canvas').boundingBox();
  assert.equal((await tab.evaluate(() => grashof.scales())).length, 2);
  // the axes of the world take 66 pixels
  const lowest = Math.max(...(await tab.evaluate(() => grashof.names())).map(({ at }) => at[1]));
  assert.ok(lowest < height - 66, `a joint at ${lowest} of ${height} pixels`);
}

export async function names_stand_beside_their_joints_and_keep_their_sides(open) {
  for (const [model, study, count] of [['stewart_platform', 'ride', 18], ['jansen_leg', 'step', 7], ['arm', 'lift', 8], ['inline_four', 'firing', 13], ['andrews', 'squeeze', 7], ['short', 'turn', 4]]) {
    const { tab } = await open(model, { study });
    const every = await namesOver(tab, 60);
    const all = every.map((names) => names.filter(({ of }) => of === 'joint'));
    for (const names of every) {
      const clash = names.find(({ box: [l, t, r, b] }, i) => names.slice(i + 1).some(({ box: [left, top, right, bottom] }) => left < r && l < right && top < b && t < bottom));
      assert.ok(!clash, `${model}: ${clash?.text} lies over another name`);
    }
    const { width, height } = await tab.locator('.canvas').boundingBox();
    const known = [...new Set(all.flatMap((names) => names.map(({ text }) => text)))];
    const sides = new Map(known.map((text) => [text, new Set()]));
    let changes = 0;
    let wrong = 0;
    const gap = ([x, y], [left, top, right, bottom]) => Math.hypot(Math.max(left - x, 0, x - right), Math.max(top - y, 0, y - bottom));
    all.forEach((names, k) => {
      names.forEach(({ text, at: [x, y], box: [left, top, right, bottom] }, i) => {
        assert.ok(left >= 0 && top >= 0 && right <= width && bottom <= height, `${model}: ${text} is cut off in step ${k}`);
        const other = names.slice(i + 1).find(({ box: [l, t, r, b] }) => left < r && l < right && top < b && t < bottom);
        assert.ok(!other, `${model}: ${text} lies over ${other?.text} in step ${k}`);
        const off = gap([x, y], [left, top, right, bottom]);
        // far from its joint it is at the end of a line
        if (off < 15 && names.some((one) => gap(one.at, [left, top, right, bottom]) < off - 0.1)) wrong++;
        assert.ok(off < 45, `${model}: ${text} is far from its joint in step ${k}`);
        if (left > 3 && right < width - 3 && top > 3 && bottom < height - 3) sides.get(text).add(`${Math.round(left - x)} ${Math.round(top - y)}`);
      });
      if (k > 0) changes += known.filter((text) => names.some((one) => one.text === text) !== all[k - 1].some((one) => one.text === text)).length;
    });
    for (const [text, places] of sides) assert.ok(places.size <= 1, `${model}: ${text} jumps: ${[...places].join('; ')}`);
    const shown = all.reduce((sum, names) => sum + names.length, 0) / (all.length * known.length);
    assert.equal(known.length, count, `${model}: ${known.join()}`);
    assert.ok(shown > 0.95, `${model}: ${shown} of ${count} names are shown`);
    assert.ok(wrong < 0.1 * all.length * count, `${model}: names stand nearer to another joint ${wrong} times`);
    assert.ok(changes <= 2 * known.length, `${model}: names come and go ${changes} times`);
    await tab.getByRole('checkbox', { name: 'names' }).uncheck();
    assert.deepEqual(await tab.evaluate(() => grashof.names()), []);
  }
}

export async function the_scale_has_room_below_the_mechanism(open) {
  for (const [model, study] of [['scotch_yoke', 'one-turn'], ['garage_door', 'lift'], ['toggle_press', 'stroke']]) {
    const { tab } = await open(model, { study });
    for (const part of [0, 0.25, 0.5, 0.75]) {
      await tab.locator('.scrub').fill(String(10_000 * part));
      await picture(tab);
      // the band above the bar and its number, 28 pixels from below
      const inked = await tab.evaluate(() => {
        const canvas = document.querySelector('.canvas canvas');
        const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: 3 }).getContext('2d', { willReadFrequently: true });
        copy.drawImage(canvas, 0, 29 - canvas.height);
        const { data } = copy.getImageData(0, 0, canvas.width, 3);
        return data.filter((_, k) => k % 4 === 3).some((alpha) => alpha > 0);
      });
      assert.equal(inked, false, `${model} at ${part} reaches the scale`);
    }
  }
}
