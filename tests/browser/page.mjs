// The page as a whole: contents, findings and their places, tables, light and dark, narrow and wide.

import { assert } from './read.mjs';

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
  await tab.locator('nav a', { hasText: 'start-up-exact' }).focus();
  await tab.keyboard.press('Enter');
  await tab.waitForFunction(() => document.getElementById('study-title').textContent === 'start-up-exact');
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
  assert.match(await rows.locator('.note').innerText(), /rows shown: \d+ of 36\d\d, curves within 0.0001 of their range/);
  const head = rows.locator('th', { hasText: /^phi3/ });
  await head.locator('button').click();
  assert.equal(await head.getAttribute('aria-sort'), 'ascending');
  const column = await rows.locator('th').evaluateAll((cells) => cells.findIndex((cell) => cell.textContent.startsWith('phi3')));
  const values = await rows.locator('tbody tr:not([aria-hidden])').evaluateAll((all, k) => all.map((row) => Number(row.children[k].textContent.replace('−', '-'))), column);
  assert.ok(values.every((x, i) => i === 0 || x >= values[i - 1]), 'not sorted');
  assert.ok(values.length < 60, 'all rows were made');
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
  for (const width of [390, 768, 1280, 2560]) {
    const { tab } = await open('crank_rocker', { width });
    for (const study of ['one-turn', 'lengths', 'modes']) {
      await tab.evaluate((name) => grashof.study(name), study);
      await tab.waitForTimeout(100);
      const wide = await tab.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= width, `${study} is ${wide} wide in ${width}`);
    }
  }
}

export async function controls_have_names(open) {
  for (const [model, study] of [['crank_rocker', 'one-turn'], ['crank_rocker', 'lengths'], ['four_bar_spatial', 'one-turn']]) {
    const { tab } = await open(model, { study });
    const nameless = await tab.evaluate(() => [...document.querySelectorAll('button, select, input, a')].filter((control) =>
      !(control.getAttribute('aria-label') || control.textContent.trim() || control.closest('label')?.textContent.trim())).map((control) => control.outerHTML));
    assert.deepEqual(nameless, []);
    assert.equal(await tab.locator('.time').getAttribute('aria-live'), 'polite');
  }
}
