// What a snippet writes must assemble as it stands and without a warning, in a program that has the labels to jump to and
// the calls of subroutines.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { tmcl } from '../scripts/package.mjs';

const snippets = JSON.parse(readFileSync(join(dirname(fileURLToPath(import.meta.url)), '../snippets.json'), 'utf8'));

/** The text with all placeholders as they are offered, the first of each choice. */
function expanded(body) {
  return body
    .join('\n')
    .replace(/\$\{\d+:([^}]*)\}/g, '$1')
    .replace(/\$\{\d+\|([^|,]*)[^|]*\|\}/g, '$1')
    .replace(/\$0/g, '');
}

/** The labels that instructions jump to and nobody defines. */
function missingLabels(text) {
  const defined = new Set([...text.matchAll(/^(\w+):/gm)].map(([, label]) => label));
  const used = [...text.matchAll(/^\s+(?:JC \w+|JA|CSUB),? (\w+)/gm)].map(([, label]) => label);
  return [...new Set(used)].filter((label) => !defined.has(label));
}

test('there is a dozen of them, each with a prefix of its own', () => {
  const all = Object.values(snippets);
  assert.ok(all.length >= 12);
  assert.equal(new Set(all.map((snippet) => snippet.prefix)).size, all.length);
});

for (const [name, snippet] of Object.entries(snippets)) {
  test(`${name} assembles`, () => {
    const folder = mkdtempSync(join(tmpdir(), 'tmcl_snippet.'));
    try {
      const text = expanded(snippet.body);
      const calls = [...text.matchAll(/^(\w+):\n[^:]*^    RSUB$/gm)].map(([, label]) => `    CSUB ${label}\n    STOP\n`);
      const labels = missingLabels(text).map((label) => `${label}:\n    STOP\n`);
      const path = join(folder, 'snippet.tmc');
      writeFileSync(path, [...calls, text, '\n    STOP\n', ...labels].join(''));
      const done = spawnSync(tmcl, ['asm', path, '-o', join(folder, 'snippet.bin')], { encoding: 'utf8' });
      assert.equal(done.status, 0, done.stderr);
      assert.doesNotMatch(done.stderr, /warning/);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
}
