// The page as a whole: contents, findings and their places, tables, light and dark, narrow and wide.

import { readFileSync } from 'node:fs';
import { assert, csv, near, until } from './read.mjs';

export async function studies_are_listed_with_what_they_are_about(open) {
  const { tab } = await open('crank_rocker');
  const links = tab.locator('nav a');
  assert.equal(await links.count(), 23);
  assert.match(await links.first().innerText(), /one-turn\s+One turn at constant speed/);
  assert.equal(await tab.locator('h1').innerText(), 'crank-rocker');
  assert.match(await tab.locator('.overview').innerText(), /1\s*degrees of freedom/);
}

export async function a_study_is_chosen_by_keys_and_by_address(open) {
  const { tab } = await open('crank_rocker', { study: 'modes' });
  assert.equal(await tab.locator('#study-title').innerText(), 'modes');
  assert.equal(await tab.locator('.title .kind').innerText(), 'modes, variants motor, elastic, absorber');
  await tab.locator('nav a', { hasText: 'start-up-exact' }).focus();
  await tab.keyboard.press('Enter');
  await until(tab, () => document.getElementById('study-title').textContent === 'start-up-exact');
  assert.equal(await tab.evaluate(() => document.activeElement.id), 'study-title');
  assert.equal(await tab.evaluate(() => [grashof.study('no-such'), grashof.study('balanced')].join()), 'false,true');
}

export async function every_study_of_every_kind_opens(open) {
  for (const model of ['crank_rocker', 'four_bar_spatial', 'heavy_top', 'truss', 'arm', 'pendulum']) {
    const { tab } = await open(model);
    const names = await tab.evaluate(() => [...document.querySelectorAll('nav .name')].map((name) => name.textContent));
    assert.ok(names.length > 0, model);
    for (const name of names) {
      await tab.evaluate((study) => grashof.study(study), name);
      assert.equal(await tab.locator('#study-title').innerText(), name);
      await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    }
  }
}

export async function text_of_a_model_is_text(open) {
  const { tab } = await open('signs');
  assert.equal(await tab.locator('h1').innerText(), 'signs </script><b>&amp;');
  assert.match(await tab.locator('.title .about').innerText(), /^<img src=x/);
  assert.equal(await tab.locator('img').count(), 0);
}

export async function what_is_not_met_is_marked_and_leads_to_its_line(open) {
  const { tab } = await open('signs', { study: 'small' });
  assert.equal(await tab.locator('nav .bad').innerText(), 'small');
  await tab.locator('.findings .bad .place').click();
  assert.match(await tab.locator('.yaml .here').innerText(), /expect: \{ max\(P\.position\)/);
}

export async function a_study_without_results_says_why(open) {
  const { tab } = await open('short_arm');
  assert.deepEqual(await tab.locator('nav .name').allInnerTexts(), ['far', 'turn']);
  assert.equal(await tab.locator('nav .bad').innerText(), 'far');
  assert.equal(await tab.locator('#study-title').innerText(), 'far');
  const found = tab.locator('.findings .bad');
  assert.match(await found.innerText(), /`?reach`? does not meet its target 5 m[^]*studies\.far\.solve[^]*help: give other bounds/);
  await found.locator('.place').click();
  assert.match(await tab.locator('.yaml .here').innerText(), /solve: \{ vary: l/);
  await tab.locator('nav a', { hasText: 'turn' }).click();
  await tab.locator('#study-title', { hasText: 'turn' }).waitFor();
}

export async function warnings_stand_before_notes(open) {
  const { tab } = await open('thrown', { study: 'coarse' });
  const found = await tab.locator('.findings li').allInnerTexts();
  assert.equal(found.length, 2);
  assert.match(found[0], /^warning: the balance of energy lacks/);
  assert.match(found[1], /^late is not defined/);
  assert.equal(await tab.locator('.findings li.warning').count(), 1);
}

export async function the_file_shows_the_place_of_a_finding(open) {
  const { tab } = await open('crank_rocker', { study: 'lengths' });
  const place = tab.locator('.findings .place').first();
  const path = await place.innerText();
  await place.click();
  const line = await tab.locator('.yaml .here').innerText();
  assert.ok(line.includes(`${path.split('.').pop()}:`), `${path} at ${line}`);
  assert.ok(await tab.locator('.yaml .y-comment').count() > 10 && (await tab.locator('.yaml .y-key').count()) > 100);
}

export async function tables_sort_and_show_what_they_left_out(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const rows = tab.locator('.table', { hasText: 'Rows' });
  assert.match(await rows.locator('.note').innerText(), /rows shown: \d+ of 36\d\d, curves within 0.0001 of the range of their axes/);
  const head = rows.locator('th', { hasText: /^phi3/ });
  await head.locator('button').click();
  assert.equal(await head.getAttribute('aria-sort'), 'ascending');
  const column = await rows.locator('th').evaluateAll((cells) => cells.findIndex((cell) => cell.textContent.startsWith('phi3')));
  const values = await rows.locator('tbody tr:not([aria-hidden])').evaluateAll((all, k) => all.map((row) => Number(row.children[k].textContent.replace('−', '-'))), column);
  assert.ok(values.every((x, i) => i === 0 || x >= values[i - 1]), 'not sorted');
  assert.ok(values.length < 60, 'all rows were made');
}

/** The texts of all rows of a table, of which only those in view are made. */
const rowsOf = (tab, title) => tab.evaluate((name) => {
  const box = document.querySelector(`.rows[aria-label="${name}"]`);
  const seen = new Map();
  for (let top = 0; top <= box.scrollHeight; top += 200) {
    box.scrollTop = top;
    box.dispatchEvent(new Event('scroll'));
    for (const row of box.querySelectorAll('tbody tr:not([aria-hidden])')) {
      const side = row.querySelector('.side')?.textContent ?? '';
      seen.set(row.getAttribute('aria-rowindex'), { side, cells: [...row.cells].map((cell, k) => (k === 0 ? cell.textContent.slice(side.length) : cell.textContent)) });
    }
  }
  return [...seen.values()];
}, title);

export async function tables_have_the_digits_that_their_columns_carry(open) {
  const { tab } = await open('clamp', { study: 'close' });
  const heads = await tab.locator('.rows[aria-label=Rows] th').allInnerTexts();
  const angle = heads.findIndex((head) => head.startsWith('A.angle'));
  const rows = await rowsOf(tab, 'Rows');
  assert.ok(rows.length > 10, `${rows.length} rows`);
  // its rows are at whole degrees, of which the page has a rounded number of radians
  for (const { cells } of rows) assert.match(cells[angle], /^\d+(\.0+)?$/);
  const lengths = new Set(rows.map(({ cells }) => (cells[angle].split('.')[1] ?? '').length));
  assert.equal(lengths.size, 1, 'the same decimals in all rows');
}

export async function small_numbers_beside_large_ones_have_their_digits(open) {
  const { tab, directory } = await open('slant', { study: 'turn' });
  const wanted = csv(`${directory}/turn.csv`);
  const heads = (await tab.locator('.rows[aria-label=Rows] th').allInnerTexts()).map((head) => head.split(' [')[0]);
  const number = (text) => Number(text.replace('−', '-').replace('·10', 'e').replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]/g, (c) => '⁰¹²³⁴⁵⁶⁷⁸⁹⁻'.indexOf(c) === 10 ? '-' : '⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(c)));
  const rows = await rowsOf(tab, 'Rows');
  assert.ok(rows.length > 20, `${rows.length} rows`);
  for (const { cells } of rows) {
    const angle = (number(cells[0]) * Math.PI) / 180;
    const off = wanted['O.angle'].map((x) => Math.abs(x - angle));
    const row = off.indexOf(Math.min(...off));
    for (const name of ['drive.torque', 'drive.power', 'A.fx', 'A.fy', 'A.fz']) {
      const [found, exact] = [number(cells[heads.indexOf(name)]), wanted[name][row]];
      if (Number.isFinite(found)) near(found, exact, 6e-5 * Math.abs(exact), `${name} at ${cells[0]}`);
    }
  }
  const extreme = tab.locator('.rows[aria-label=Extremes] tr', { hasText: 'A.fx' });
  const { max } = JSON.parse(readFileSync(`${directory}/turn.json`, 'utf8')).extrema['A.fx'];
  near(number((await extreme.locator('td').nth(2).textContent())), max.value, 1e-4 * Math.abs(max.value), 'greatest A.fx');
}

export async function what_a_drawing_leaves_out_is_told_and_small_beside_a_dead_point(open) {
  const { tab } = await open('slant', { study: 'turn' });
  const note = await tab.locator('.stage').innerText();
  const [, told, power = ''] = /drawn to within ([\d.]+)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))? m/.exec(note) ?? [null, '0'];
  const size = Number(told) * 10 ** (power === '' ? 0 : -[...power.slice(1)].reduce((sum, c) => 10 * sum + '⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(c), 0));
  assert.ok(size < 1e-3 * 0.35, note);
}

export async function names_of_bodies_stand_on_their_own(open) {
  const { tab } = await open('crossing');
  await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const [names, [scale]] = await tab.evaluate(() => [grashof.names(), grashof.look()]);
  const at = (text) => names.find((name) => name.text === text)?.at ?? assert.fail(`${text} is not among ${names.map((name) => name.text)}`);
  const apart = (a, b) => Math.hypot(at(a)[0] - at(b)[0], at(a)[1] - at(b)[1]);
  assert.ok(apart('ring', 'S, R') > 0.03 * scale, 'the ring has its name within the sun');
  for (const bar of ['one', 'two']) assert.ok(apart(bar, 'M') > 12, `the name of ${bar} begins where both cross`);
}

export async function rows_on_both_sides_of_a_switch_say_which(open) {
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  const rows = await rowsOf(tab, 'Rows');
  const [before, after] = ['before', 'after'].map((side) => rows.filter((row) => row.side === side));
  assert.ok(before.length > 0 && before.length < 4, `${before.length} switches`);
  assert.deepEqual(before.map(({ cells }) => cells[0]), after.map(({ cells }) => cells[0]));
  // where nothing jumps there is one row
  rows.forEach(({ cells }, i) => assert.ok(i === 0 || cells.join() !== rows[i - 1].cells.join(), `two rows are alike: ${cells[0]}`));
}

/** Whether a part of the page lies within a box of it and within the window. */
const within = (tab, inner, outer) => tab.evaluate(([a, b]) => {
  const [own, box] = [document.querySelector(a).getBoundingClientRect(), document.querySelector(b).getBoundingClientRect()];
  return own.height > 0 && own.top >= box.top - 1 && own.bottom <= Math.min(box.bottom, innerHeight) + 1;
}, [inner, outer]);

export async function the_chosen_study_is_in_view_in_the_contents(open) {
  for (const study of ['one-turn', 'fluctuation', 'modes-k0']) {
    const { tab } = await open('crank_rocker', { study });
    for (const part of ['nav [aria-current]', 'nav h2']) assert.ok(await within(tab, part, 'nav'), `${part} with ${study}`);
    await tab.evaluate(() => (location.hash = 'stiffness-small'));
    await until(tab, () => document.getElementById('study-title').textContent === 'stiffness-small');
    for (const part of ['nav [aria-current]', 'nav h2']) assert.ok(await within(tab, part, 'nav'), `${part} from ${study}`);
    const [head, link] = await tab.evaluate(() => ['nav h2', 'nav [aria-current]'].map((part) => document.querySelector(part).getBoundingClientRect()).map(({ top, bottom }) => ({ top, bottom })));
    assert.ok(link.top >= head.bottom - 1, 'the heading lies over the chosen study');
  }
}

export async function narrow_windows_have_a_compact_list_of_studies(open) {
  const { tab } = await open('crank_rocker', { study: 'modes', width: 390, height: 844 });
  const list = tab.getByLabel('study', { exact: true });
  assert.deepEqual([await tab.locator('nav ol').isVisible(), await list.isVisible(), await list.inputValue()], [false, true, 'modes']);
  assert.ok((await tab.locator('nav').boundingBox()).height < 80);
  await list.focus();
  await list.selectOption('start-up-exact');
  await until(tab, () => document.getElementById('study-title').textContent === 'start-up-exact');
  assert.ok(await within(tab, '#study-title', 'body'), 'the title is out of view');
  assert.equal(await tab.evaluate(() => document.activeElement.getAttribute('aria-label')), 'study');
  assert.match(tab.url(), /#start-up-exact$/);
}

export async function light_and_dark_follow_the_system_and_the_switch(open) {
  const { tab } = await open('crank_rocker', { colorScheme: 'dark' });
  const paper = () => tab.evaluate(() => getComputedStyle(document.querySelector('.card')).backgroundColor);
  const dark = await paper();
  await tab.locator('.theme').click();
  const light = await paper();
  assert.equal(light, 'rgb(255, 255, 255)');
  assert.notEqual(dark, light);
}

export async function nothing_is_wider_than_the_window(open) {
  const pages = [['crank_rocker', ['one-turn', 'lengths', 'modes']], ['stewart_platform', ['ride']], ['winch', ['fall']], ['cart_pole', ['linear']]];
  for (const width of [390, 768, 1280, 2560]) {
    for (const [model, studies] of pages) {
      const { tab } = await open(model, { width });
      for (const study of studies) {
        await tab.evaluate((name) => grashof.study(name), study);
        await tab.evaluate(() => document.querySelectorAll('details').forEach((part) => (part.open = true)));
        await tab.waitForTimeout(100);
        const wide = await tab.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${model}, ${study} is ${wide} wide in ${width}`);
      }
    }
  }
}

/** The name of what has the focus. */
const focused = (tab) => tab.evaluate(() => {
  const { activeElement: on } = document;
  return on.getAttribute('aria-label') || on.closest('label')?.textContent.trim() || on.textContent.trim().split('\n')[0] || on.tagName;
});

export async function the_controls_are_reached_and_used_by_keys(open) {
  const { tab } = await open('winch');
  const names = [];
  for (let k = 0; k < 60 && !names.includes('Add figure'); k++) {
    await tab.keyboard.press('Tab');
    names.push(await focused(tab));
  }
  const wanted = [/^Skip|^To the/i, /^drawing of the mechanism/, /^play$/, /^place of the motion$/, /^speed$/, /^again and again$/, /^whole mechanism$/, /^names$/, /^loads$/,
    /^reactions$/, /^length of the arrows$/, /^height/, /^column to draw$/, /^drawn over$/, /^Add figure$/];
  let from = 0;
  for (const name of wanted) {
    const found = names.findIndex((one, k) => k >= from && name.test(one));
    assert.ok(found >= 0, `${name} not in ${names.slice(from).join(' | ')}`);
    from = found;
  }
  await tab.getByRole('checkbox', { name: 'loads' }).focus();
  await tab.keyboard.press(' ');
  assert.equal(await tab.getByRole('checkbox', { name: 'loads' }).isChecked(), false);
  await tab.locator('.legend button').first().focus();
  await tab.keyboard.press('Enter');
  assert.equal(await tab.locator('.legend button').first().getAttribute('aria-pressed'), 'false');
  await tab.locator('.scrub').focus();
  await tab.keyboard.press('End');
  assert.ok(Math.abs((await tab.evaluate(() => grashof.time())) - 0.5) < 1e-9);
  await tab.locator('.canvas canvas').focus();
  const before = await tab.evaluate(() => grashof.look());
  await tab.keyboard.press('+');
  assert.ok((await tab.evaluate(() => grashof.look()))[0] > before[0]);
}

export async function controls_have_names(open) {
  const pages = [['crank_rocker', 'one-turn'], ['crank_rocker', 'lengths'], ['four_bar_spatial', 'one-turn'], ['winch', 'fall'], ['cart_pole', 'linear'], ['truss', 'path']];
  for (const [model, study] of pages) {
    const { tab } = await open(model, { study });
    const nameless = await tab.evaluate(() => [...document.querySelectorAll('button, select, input, a, canvas, summary, output, [tabindex="0"], svg[role=img]')].filter((control) =>
      !(control.getAttribute('aria-label') || control.textContent.trim() || control.closest('label')?.textContent.trim() || control.matches('output:empty'))).map((control) => control.outerHTML));
    assert.deepEqual(nameless, []);
    assert.equal(await tab.locator('.time').getAttribute('aria-live'), 'polite');
  }
}

export async function results_stay_below_the_mechanism_beside_the_figures(open) {
  const boxes = (tab, ...parts) => tab.evaluate((all) => all.map((part) => document.querySelector(part).getBoundingClientRect().toJSON()), parts);
  const { tab } = await open('crank_rocker', { study: 'one-turn' });
  for (const opened of [false, true]) {
    await tab.evaluate((on) => document.querySelectorAll('.facts details').forEach((part) => (part.open = on)), opened);
    await tab.evaluate(() => scrollTo(0, 1500));
    await tab.waitForTimeout(150);
    const [stage, facts, plots] = await boxes(tab, '.stage', '.facts', '.plots');
    assert.ok(stage.top >= 0 && facts.top >= stage.bottom && plots.left >= facts.right, 'results are not below the mechanism');
    assert.ok(facts.height > 100 && facts.bottom <= 900, `results from ${facts.top} to ${facts.bottom}`);
  }
  // few results take no more room than they need
  const few = await open('crank_rocker', { study: 'fluctuation' });
  const [{ height }] = await boxes(few.tab, '.facts');
  assert.ok(height < 80, `one closed part is ${height} high`);
  // a study without figures has them beside the mechanism
  const still = await open('quarter_car', { study: 'frequencies' });
  const [stage, facts] = await boxes(still.tab, '.stage', '.facts');
  assert.ok(facts.left >= stage.right && Math.abs(facts.top - stage.top) < 2, 'results are not beside the mechanism');
}

export async function the_drawing_is_as_high_as_the_mechanism_asks_for(open) {
  const part = async (model, study) => {
    const { width, height } = await (await open(model, { study })).tab.locator('.canvas').boundingBox();
    return height / width;
  };
  const [flat, tall] = [await part('crank_rocker', 'one-turn'), await part('jansen_leg', 'step')];
  assert.ok(flat < 0.75 && tall > 0.95, `${flat} and ${tall}`);
}

export async function the_lead_of_a_model_is_a_sentence(open) {
  for (const [model, lead] of [['garage_door', /^While the lower rollers rise .* lies down\.$/], ['jansen_leg', /^The leg of the beach animals/]]) {
    const { tab } = await open(model);
    assert.match(await tab.locator('.lead').innerText(), lead);
  }
}

export async function rounding_in_a_list_is_nothing(open) {
  const { tab } = await open('truss', { study: 'unloaded' });
  const row = tab.locator('tr', { hasText: 'equilibria.G.position' });
  assert.match(await row.innerText(), /0\.66332,\s+0,\s+−0\.66332/);
}

export async function parameters_are_those_of_the_run_that_is_shown(open) {
  const { tab } = await open('swing', { study: 'lengths' });
  const part = tab.locator('.facts .part', { hasText: 'Parameters' });
  await part.locator('summary').click();
  const values = () => part.innerText();
  assert.match(await values(), /of the run l = 0\.2 m\s+l\s+0\.2 m/);
  await tab.locator('select[aria-label="run"]').selectOption({ index: 2 });
  assert.match(await values(), /of the run l = 0\.6 m\s+l\s+0\.6 m/, 'and the part stays open');
}

export async function shapes_and_equilibria_are_told_as_on_the_terminal(open) {
  const { tab } = await open('leaf', { study: 'rest' });
  const facts = tab.locator('.facts');
  assert.match(await facts.innerText(), /S\.position = -34\.68\d* mm, P\.angle = -90 deg/);
  assert.match(await tab.locator('tr', { hasText: 'equilibria.S.position' }).innerText(), /\[mm\]\s+−34\.68/);
  assert.match(await tab.locator('tr', { hasText: 'equilibria.P.angle' }).innerText(), /\[deg\]\s+−90/);
  await tab.locator('.part', { hasText: 'Parameters' }).locator('summary').click();
  assert.match(await facts.innerText(), /k\s+2 N\/cm\s+l\s+500 mm/, 'as they are written, or in the units that are asked for');
  const modes = await open('leaf', { study: 'modes' });
  const shape = (k) => modes.tab.locator('tr', { hasText: `shape ${k}` }).locator('td').innerText();
  for (const k of [1, 2]) assert.match(await shape(k), /^\S+ 1, +\S+ −?\d/);
  const damped = await open('leaf', { study: 'damped' });
  assert.match(await damped.tab.locator('tr', { hasText: 'shape 1' }).locator('td').innerText(), /^\S+ 1, +\S+ \S+ at \S+ deg$/);
}

export async function the_start_of_what_rests_is_pale_as_a_whole(open) {
  const { tab } = await open('tray', { study: 'rest' });
  await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const through = await tab.locator('.canvas canvas').evaluate((canvas) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    // less pale than what lies behind: something of it is seen through something else
    for (let i = 3; i < data.length; i += 4) if (data[i] > 110 && data[i] < 170) count++;
    return count;
  });
  assert.ok(through < 1000, `${through} pixels`);
}
