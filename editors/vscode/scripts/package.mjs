// Makes the extension: build/vscode/extension as a folder, and build/vscode/opentmcl-VERSION.vsix to install.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { grammarOf } from './grammar.mjs';
import { vsixOf } from './vsix.mjs';

const folder = dirname(dirname(fileURLToPath(import.meta.url)));
const project = dirname(dirname(folder));
export const tmcl = process.env.TMCL ?? join(project, 'build/release/tmcl');
export const output = join(project, 'build/vscode');

/** package.json as users get it: without what only builds and tests need. */
function manifest() {
  const content = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  for (const key of ['private', 'scripts', 'dependencies', 'devDependencies']) delete content[key];
  return content;
}

/** The program of the extension, and the paths of the files that it is made of. */
async function bundle() {
  const result = await build({
    absWorkingDir: folder,
    entryPoints: [join(folder, 'source/extension.ts')],
    bundle: true,
    write: false,
    platform: 'node',
    format: 'cjs',
    target: 'node18',
    external: ['vscode'],
    minify: true,
    legalComments: 'none',
    metafile: true,
    logLevel: 'warning',
  });
  return { program: result.outputFiles[0].contents, sources: Object.keys(result.metafile.inputs) };
}

/** What the licences of bundled packages want to be shown. */
function noticesOf(sources) {
  const packages = sources.map((path) => /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]);
  const names = [...new Set(packages.filter((name) => name !== undefined))].sort();
  return names
    .map((name) => {
      const place = join(folder, 'node_modules', name);
      const licence = readdirSync(place).find((file) => /^licen[cs]e/i.test(file));
      if (licence === undefined) throw new Error(`the package ${name} has no licence to show`);
      const { version } = JSON.parse(readFileSync(join(place, 'package.json'), 'utf8'));
      return `${name} ${version}\n\n${readFileSync(join(place, licence), 'utf8').trim()}\n`;
    })
    .join('\n----\n\n');
}

export async function makePackage() {
  const bytes = (text) => new TextEncoder().encode(text);
  const json = (content) => bytes(`${JSON.stringify(content, null, 2)}\n`);
  const spec = JSON.parse(execFileSync(tmcl, ['spec', '--json'], { encoding: 'utf8', maxBuffer: 1 << 26 }));
  const extension = manifest();
  const { program, sources } = await bundle();
  const files = new Map([
    ['package.json', json(extension)],
    ['extension.js', program],
    ['tmcl.tmLanguage.json', json(grammarOf(spec))],
    ['third-party-notices.txt', bytes(noticesOf(sources))],
    ['LICENSE.txt', readFileSync(join(project, 'LICENSE'))],
    ...['language-configuration.json', 'snippets.json', 'README.md'].map((name) => [name, readFileSync(join(folder, name))]),
  ]);

  const unpacked = join(output, 'extension');
  rmSync(unpacked, { recursive: true, force: true });
  mkdirSync(unpacked, { recursive: true });
  for (const [path, content] of files) writeFileSync(join(unpacked, path), content);
  const vsix = join(output, `${extension.name}-${extension.version}.vsix`);
  writeFileSync(vsix, vsixOf(extension, files));
  return vsix;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) console.log(await makePackage());
