// Writes dist/: the style sheet, the page, the part that only mechanisms in space need, and the policy that lets these three and
// nothing else be loaded.
import { build } from 'esbuild';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';

process.chdir(new URL('.', import.meta.url).pathname);
const dist = process.argv[2] ?? 'dist';
mkdirSync(dist, { recursive: true });
await build({
  entryPoints: { page: 'src/main.ts', space: 'src/space/main.ts', style: 'src/page.css' },
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
  const digests = { js: [], css: [] };
  for (const { path, text } of outputFiles) {
    const name = path.split('/').pop().replace('style.css', 'page.css');
    // the end of a line is no part of what stands in the page
    const bytes = text.trimEnd();
    writeFileSync(`${dist}/${name}`, bytes);
    digests[name.split('.').pop()].push(`'sha256-${createHash('sha256').update(bytes).digest('base64')}'`);
  }
  const policy = [
    "default-src 'none'",
    `script-src ${digests.js.sort().join(' ')}`,
    `style-src ${digests.css.join(' ')}`,
    'img-src data: blob:',
    "base-uri 'none'",
    "form-action 'none'",
  ];
  writeFileSync(`${dist}/policy.txt`, `${policy.join('; ')}\n`);
});
for (const name of ['page.js', 'space.js', 'page.css']) console.log(`${name}: ${readFileSync(`${dist}/${name}`).length} bytes`);
