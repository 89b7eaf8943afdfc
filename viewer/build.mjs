// Writes dist/: of the report the style sheet, the page, the part that only mechanisms in space need, and the policy that lets these
// three and nothing else be loaded; and the same of the live page, which has a bundle and a style sheet of its own.
import { build } from 'esbuild';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';

process.chdir(new URL('.', import.meta.url).pathname);
const dist = process.argv[2] ?? 'dist';
mkdirSync(dist, { recursive: true });
await build({
  entryPoints: { page: 'src/main.ts', space: 'src/space/main.ts', style: 'src/page.css', live: 'src/live/main.ts', 'live-style': 'src/live/live.css' },
  outdir: dist,
  entryNames: '[name]',
  bundle: true,
  minify: true,
  charset: 'utf8',
  format: 'iife',
  target: ['chrome103', 'firefox113', 'safari16.4'],
  legalComments: 'none',
  logLevel: 'warning',
  write: false,
}).then(({ outputFiles }) => {
  const digests = {};
  for (const { path, text } of outputFiles) {
    const name = path.split('/').pop().replace('live-style.css', 'live.css').replace('style.css', 'page.css');
    // the end of a line is no part of what stands in the page
    const bytes = text.trimEnd();
    writeFileSync(`${dist}/${name}`, bytes);
    digests[name] = `'sha256-${createHash('sha256').update(bytes).digest('base64')}'`;
  }
  const policy = (scripts, styles, more) => `${[
    "default-src 'none'",
    `script-src ${scripts.map((name) => digests[name]).sort().join(' ')}`,
    `style-src ${styles.map((name) => digests[name]).join(' ')}`,
    'img-src data: blob:',
    ...more,
    "base-uri 'none'",
    "form-action 'none'",
  ].join('; ')}\n`;
  writeFileSync(`${dist}/policy.txt`, policy(['page.js', 'space.js'], ['page.css'], []));
  writeFileSync(`${dist}/live-policy.txt`, policy(['live.js', 'space.js'], ['page.css', 'live.css'], ["connect-src 'self'"]));
});
for (const name of ['page.js', 'space.js', 'page.css', 'live.js', 'live.css']) console.log(`${name}: ${readFileSync(`${dist}/${name}`).length} bytes`);
