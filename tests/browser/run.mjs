// The report page in a browser: node tests/browser/run.mjs GRASHOF [CHROMIUM]
//
// GRASHOF is the program to test, CHROMIUM the browser. The pages are those of models/ and of what models.mjs adds; every test has a page
// of its own, on which any error or warning of the console and any request for anything outside of the page is a failure.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from '../../viewer/node_modules/playwright-core/index.mjs';
import { FILES, MODELS, STOPPED, WITH_FIGURES } from './models.mjs';
import * as drawing from './drawing.mjs';
import * as motion from './motion.mjs';
import * as page from './page.mjs';
import * as paper from './paper.mjs';
import * as plots from './plots.mjs';
import { until } from './read.mjs';
import * as watch from './watch.mjs';

const [, , program, executablePath = '/usr/bin/chromium'] = process.argv;
if (!program) {
  console.error('usage: node tests/browser/run.mjs GRASHOF [CHROMIUM]');
  process.exit(2);
}
const root = fileURLToPath(new URL('../..', import.meta.url));
const directory = mkdtempSync(join(tmpdir(), 'grashof-browser-'));

/** Runs a model; gives the directory of its results. */
function results(name) {
  const out = join(directory, name);
  const text = MODELS[name];
  const model = text ? join(directory, `${name}.yaml`) : join(root, 'models', `${name}.yaml`);
  if (text) writeFileSync(model, text);
  for (const [file, beside] of Object.entries(FILES[name] ?? {})) writeFileSync(join(directory, file), beside);
  try {
    execFileSync(program, ['run', model, ...(WITH_FIGURES.includes(name) ? [] : ['--no-plots']), '--quiet', '-o', out], { stdio: 'pipe' });
  } catch (error) {
    // an expectation that is not met is one of the things to be shown
    if (error.status !== (STOPPED.includes(name) ? 3 : 1)) throw error;
  }
  return out;
}

const browser = await chromium.launch({ executablePath, args: ['--no-sandbox'] });
const known = new Map();
const open = async (name, { study = '', width = 1280, height = 900, colorScheme = 'light' } = {}) => {
  if (!known.has(name)) known.set(name, results(name));
  const context = await browser.newContext({ viewport: { width, height }, colorScheme, acceptDownloads: true });
  const tab = await context.newPage();
  const faults = [];
  tab.on('console', (message) => ['error', 'warning'].includes(message.type()) && faults.push(`console: ${message.text()}`));
  tab.on('pageerror', (error) => faults.push(`error: ${error.message}`));
  tab.on('request', (request) => /^(file|data|blob):/.test(request.url()) || faults.push(`request: ${request.url()}`));
  await tab.goto(`file://${known.get(name)}/report.html${study && `#${study}`}`);
  await until(tab, () => Boolean(window.grashof));
  return { tab, faults, directory: known.get(name), close: () => context.close() };
};

let [passed, failed] = [0, 0];
for (const tests of [page, drawing, motion, plots, paper]) {
  for (const [name, test] of Object.entries(tests)) {
    const opened = [];
    try {
      await test(async (...asked) => {
        opened.push(await open(...asked));
        return opened[opened.length - 1];
      });
      const faults = opened.flatMap((one) => one.faults);
      if (faults.length > 0) throw new Error(faults.join('; '));
      passed++;
      console.log(`ok      ${name}`);
    } catch (error) {
      failed++;
      console.log(`FAILED  ${name}: ${error.message}`);
    }
    for (const one of opened) await one.close();
  }
}
for (const [name, test] of Object.entries(watch)) {
  try {
    await test(browser, program);
    passed++;
    console.log(`ok      ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}: ${error.message}`);
  }
}
await browser.close();
rmSync(directory, { recursive: true, force: true });
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
