// The live page: it follows the file, keeps what a reader has chosen, and moves values.

import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { assert, seek, time, until } from './read.mjs';

const MODEL = `grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { length: 50 cm }   # of the rod
bodies: { rod: { bar: { length: length, mass: 2 kg } } }
joints: { O: { revolute: [ground, rod.start] } }
start: { O.angle: -60 deg }
measures: { phi: O.angle }
studies:
  swing: { dynamics: { until: 1 s, every: 10 ms }, columns: [phi], scalars: { far: max(phi) }, plot: { angle: [phi] } }
  rest: { statics: { from: start } }
`;

/** Watches a model of its own while `use` has the page. */
async function watched(browser, program, use) {
  const directory = mkdtempSync(join(tmpdir(), 'grashof-live-'));
  const file = join(directory, 'model.yaml');
  writeFileSync(file, MODEL);
  const child = spawn(program, ['watch', file, '-q'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  const faults = [];
  const open = async () => {
    const tab = await context.newPage();
    tab.on('console', (message) => ['error', 'warning'].includes(message.type()) && faults.push(`console: ${message.text()}`));
    tab.on('pageerror', (error) => faults.push(`error: ${error.message}`));
    tab.on('request', (request) => request.url().startsWith(address.split('?')[0]) || faults.push(`request: ${request.url()}`));
    await tab.goto(address);
    await until(tab, () => Boolean(window.grashof && document.querySelector('.plot svg')));
    return tab;
  };
  const address = await new Promise((done) => child.stdout.once('data', (text) => done(String(text).trim())));
  try {
    await use({ open, save: (text) => writeFileSync(file, text), text: () => readFileSync(file, 'utf8') });
    if (faults.length > 0) throw new Error(faults.join('; '));
  } finally {
    await context.close();
    child.kill('SIGINT');
    rmSync(directory, { recursive: true, force: true });
  }
}

const far = (tab) => tab.locator('.values dd').first().innerText();
const changes = (tab, before) => until(tab, (was) => document.querySelector('.values dd')?.textContent !== was, before);

export async function a_save_is_shown_and_nothing_is_lost(browser, program) {
  await watched(browser, program, async ({ open, save }) => {
    const tab = await open();
    await seek(tab, 0.4);
    await tab.locator('.legend button').first().click();
    await tab.locator('.shown label', { hasText: 'names' }).locator('input').uncheck();
    const before = await far(tab);
    save(MODEL.replace('-60 deg', '-80 deg'));
    await changes(tab, before);
    assert.equal(await time(tab), 0.4);
    assert.equal(await tab.locator('.legend button').first().getAttribute('aria-pressed'), 'false');
    assert.equal(await tab.locator('.shown label', { hasText: 'names' }).locator('input').isChecked(), false);
  });
}

export async function view_and_zoom_stay_over_a_save(browser, program) {
  await watched(browser, program, async ({ open, save }) => {
    const tab = await open();
    const canvas = tab.locator('.stage canvas');
    await canvas.focus();
    await tab.keyboard.press('+');
    const box = await canvas.boundingBox();
    await tab.mouse.move(box.x + 80, box.y + 80);
    await tab.mouse.down();
    await tab.mouse.move(box.x + 120, box.y + 95, { steps: 3 });
    await tab.mouse.up();
    const figure = tab.locator('.plot-stage').first();
    await figure.focus();
    for (const _ of [1, 2]) await tab.keyboard.press('+');
    const across = () => figure.locator('svg.chart text[text-anchor=middle]').allTextContents();
    const [look, ticks] = [await tab.evaluate(() => grashof.look()), await across()];
    assert.ok(look[0] > 1 && look[1] !== 0, look.join());
    await tab.evaluate(() => document.querySelectorAll('.stage canvas, .plot-stage, .legend button').forEach((one) => (one.before = true)));
    for (const angle of ['-70 deg', '-80 deg']) {
      const before = await far(tab);
      save(MODEL.replace('-60 deg', angle));
      await changes(tab, before);
      assert.deepEqual([await tab.evaluate(() => grashof.look()), await across()], [look, ticks]);
    }
    // the page goes on in its own elements
    assert.ok(await tab.evaluate(() => [...document.querySelectorAll('.stage canvas, .plot-stage')].every((one) => one.before)));
  });
}

export async function a_broken_file_is_told_above_the_last_picture(browser, program) {
  await watched(browser, program, async ({ open, save }) => {
    const tab = await open();
    save(MODEL.replace('name: pendulum', 'name: [pendulum'));
    await tab.locator('.notices.bad').waitFor();
    await tab.locator('.notices .place').first().click();
    assert.match(await tab.locator('.yaml .here').innerText(), /\S/);
    assert.ok(await tab.locator('.stage canvas').isVisible());
    save(MODEL);
    await tab.locator('.notices').waitFor({ state: 'hidden' });
  });
}

export async function values_are_moved_in_all_tabs_and_written(browser, program) {
  await watched(browser, program, async ({ open, text }) => {
    const [one, two] = [await open(), await open()];
    const before = await far(two);
    const slider = one.locator('[data-place="start.O.angle"] input[type=range]');
    await slider.focus();
    for (let i = 0; i < 10; i++) await one.keyboard.press('ArrowRight');
    await changes(two, before);
    await until(two, () => document.querySelector('[data-place="start.O.angle"] input').value === '-51');
    assert.equal(text(), MODEL);
    await two.locator('[data-place="start.O.angle"] .write').click();
    await until(two, () => !document.querySelector('.moved'));
    assert.equal(text(), MODEL.replace('-60 deg', '-51 deg'));
  });
}

export async function names_of_values_have_room_until_these_are_moved(browser, program) {
  await watched(browser, program, async ({ open, save }) => {
    const tab = await open();
    save(MODEL.replace('length: 50 cm }', 'rod_length: 50 cm }').replace('length: length', 'length: rod_length'));
    await until(tab, () => Boolean(document.querySelector('[data-place="parameters.rod_length"]')));
    const row = tab.locator('[data-place="parameters.rod_length"]');
    const state = () => row.evaluate((one) => {
      const [name, write] = ['.name', '.write'].map((part) => one.querySelector(part));
      return { whole: name.scrollWidth <= name.clientWidth, free: one.querySelector('.number').getBoundingClientRect().left - name.getBoundingClientRect().right, write: write.getBoundingClientRect().width > 0, height: one.offsetHeight };
    });
    const before = await state();
    assert.ok(before.whole && before.free < 12 && !before.write, JSON.stringify(before));
    await row.locator('input[type=range]').focus();
    await tab.keyboard.press('ArrowRight');
    const after = await state();
    assert.ok(after.write, 'it cannot be written');
    assert.equal(after.height, before.height);
  });
}

export async function a_narrow_page_is_not_wider_with_errors(browser, program) {
  await watched(browser, program, async ({ open, save, text }) => {
    const tab = await open();
    await tab.setViewportSize({ width: 390, height: 844 });
    save(text().replace('name: pendulum', 'name: Whitworth pendulum').replace('ground, rod.start', 'ground, rod.begin'));
    await until(tab, () => document.querySelector('.status')?.textContent?.includes('errors'));
    const [own, window] = await tab.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
    assert.ok(own <= window, `${own} in ${window}`);
  });
}
