// What `animate` and `export` write, in other programs: node tests/browser/exports/check.mjs GRASHOF [CHROMIUM]
//
// glTF files go through the validator of the Khronos Group, which must find no error and no warning; SVG that moves is opened in
// Chromium, where the bars of a linkage must keep their lengths at all times.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { validateBytes } from 'gltf-validator';
import { chromium } from '../../../viewer/node_modules/playwright-core/index.mjs';

const [, , program, executablePath = '/usr/bin/chromium'] = process.argv;
if (!program) {
  console.error('usage: node tests/browser/exports/check.mjs GRASHOF [CHROMIUM]');
  process.exit(2);
}
const models = fileURLToPath(new URL('../../../models', import.meta.url));
const directory = mkdtempSync(join(tmpdir(), 'grashof-exports-'));
let failed = 0;

/** Runs a command on a study; gives the path of the file that it writes. */
function made(command, model, study, file, ...options) {
  const path = join(directory, file);
  const target = command === 'animate' ? ['-o', path] : ['--gltf', path];
  execFileSync(program, [command, join(models, `${model}.yaml`), '--study', study, ...target, ...options], { stdio: 'pipe' });
  return path;
}

async function test(name, run) {
  try {
    await run();
    console.log(`ok      ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}: ${error.message}`);
  }
}

const STUDIES = [
  ['four_bar_spatial', 'one-turn'], ['heavy_top', 'nutation'], ['arm', 'lift'], ['crank_rocker', 'one-turn'], ['crank_rocker', 'modes'],
  ['andrews', 'squeeze'], ['slider_crank', 'driven'], ['quick_return', 'one-turn'], ['scotch_yoke', 'one-turn'], ['double_pendulum', 'swing'],
];
for (const [model, study] of STUDIES) {
  for (const ending of ['glb', 'gltf']) {
    await test(`${model} ${study} as .${ending}`, async () => {
      const path = made('export', model, study, `${model}-${study}.${ending}`, '--duration', '2');
      const { issues } = await validateBytes(new Uint8Array(readFileSync(path)));
      if (issues.numErrors + issues.numWarnings > 0) throw new Error(JSON.stringify(issues.messages.slice(0, 5)));
    });
  }
}

const browser = await chromium.launch({ executablePath, args: ['--no-sandbox'] });
const page = await browser.newPage();
await test('bars of an SVG that moves keep their lengths', async () => {
  await page.goto(`file://${made('animate', 'crank_rocker', 'one-turn', 'turn.svg', '--duration', '4')}`);
  const lengths = [];
  const cranks = new Set();
  for (const time of [0, 0.37, 1.01, 1.9, 2.5, 3.3, 3.99]) {
    const pins = await page.evaluate((t) => {
      document.documentElement.pauseAnimations();
      document.documentElement.setCurrentTime(t);
      const white = [...document.querySelectorAll('circle')].filter((circle) => circle.getAttribute('fill') === '#ffffff');
      return white.map((circle) => {
        const box = circle.getBoundingClientRect();
        return [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
      });
    }, time);
    if (pins.length !== 4) throw new Error(`${pins.length} pins`);
    const [o, a, b, c] = pins;
    const far = (p, q) => Math.hypot(p[0] - q[0], p[1] - q[1]);
    lengths.push([far(o, a), far(a, b), far(b, c), far(o, c)]);
    cranks.add(Math.round(Math.atan2(a[1] - o[1], a[0] - o[0]) * 100));
  }
  for (let k = 0; k < 4; k++) {
    const all = lengths.map((row) => row[k]);
    if (Math.max(...all) - Math.min(...all) > 0.3) throw new Error(`a length goes from ${Math.min(...all)} to ${Math.max(...all)}`);
  }
  if (cranks.size < 6) throw new Error('the crank does not turn');
});
await test('a flip-book shows one picture at a time', async () => {
  await page.goto(`file://${made('animate', 'four_bar_spatial', 'one-turn', 'space.svg', '--duration', '4')}`);
  for (const time of [0, 0.5, 3.99]) {
    const shown = await page.evaluate((t) => {
      document.documentElement.pauseAnimations();
      document.documentElement.setCurrentTime(t);
      const pictures = [...document.querySelectorAll('g')].filter((g) => g.querySelector(':scope > animate[attributeName=display]'));
      return [pictures.length, pictures.filter((g) => getComputedStyle(g).display !== 'none').length];
    }, time);
    if (shown[0] > 0 && shown[1] !== 1) throw new Error(`${shown[1]} of ${shown[0]} pictures at ${time} s`);
  }
});
await browser.close();
rmSync(directory, { recursive: true, force: true });
process.exit(failed === 0 ? 0 : 1);
