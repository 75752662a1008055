// What is in the package that users install.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { makePackage, tmcl } from '../scripts/package.mjs';
import { unpackedExtension } from './package.mjs';

const files = await unpackedExtension();
const manifest = JSON.parse(files.get('extension/package.json'));

test('the package holds what users need and nothing of the development', () => {
  assert.deepEqual([...files.keys()].sort(), [
    '[Content_Types].xml',
    'extension.vsixmanifest',
    'extension/LICENSE.txt',
    'extension/README.md',
    'extension/extension.js',
    'extension/language-configuration.json',
    'extension/package.json',
    'extension/snippets.json',
    'extension/third-party-notices.txt',
    'extension/tmcl.tmLanguage.json',
  ]);
  for (const key of ['scripts', 'devDependencies', 'dependencies']) assert.ok(!(key in manifest), key);
});

test('licences of bundled packages are shown', () => {
  const notices = files.get('extension/third-party-notices.txt');
  for (const name of ['vscode-languageclient', 'vscode-jsonrpc', 'semver', 'minimatch']) {
    assert.match(notices, new RegExp(`^${name} \\d`, 'm'));
  }
});

test('every file that the manifest names is there', () => {
  const { grammars, languages, snippets } = manifest.contributes;
  const named = [manifest.main, languages[0].configuration, grammars[0].path, snippets[0].path];
  for (const path of named) assert.ok(files.has(join('extension', path)), path);
  for (const [, path] of files.get('extension.vsixmanifest').matchAll(/ Path="([^"]*)"/g)) {
    assert.ok(files.has(path), path);
  }
});

test('the manifest of the package agrees with that of the extension', () => {
  const [, id, version, publisher] = files
    .get('extension.vsixmanifest')
    .match(/<Identity Language="en-US" Id="([^"]*)" Version="([^"]*)" Publisher="([^"]*)"\/>/);
  assert.deepEqual([id, version, publisher], [manifest.name, manifest.version, manifest.publisher]);
  assert.match(files.get('extension.vsixmanifest'), /Code\.Engine" Value="\^1\.82\.0"/);
});

test('every kind of file has a content type', () => {
  const types = files.get('[Content_Types].xml');
  for (const path of files.keys()) {
    if (path === '[Content_Types].xml') continue;
    assert.ok(types.includes(`Extension="${path.slice(path.lastIndexOf('.'))}"`), path);
  }
});

test('the version is that of tmcl', () => {
  const version = execFileSync(tmcl, ['version'], { encoding: 'utf8' });
  assert.ok(version.includes(manifest.version), version);
});

test('the modules to choose from are those of tmcl', () => {
  const modules = JSON.parse(execFileSync(tmcl, ['spec', '--json'], { encoding: 'utf8', maxBuffer: 1 << 26 })).modules;
  const names = modules.map((module) => module.argument).sort();
  const { launch, attach } = manifest.contributes.debuggers[0].configurationAttributes;
  const setting = manifest.contributes.configuration.properties['tmcl.module'];
  for (const choice of [setting, launch.properties.module, attach.properties.module]) {
    assert.deepEqual([...choice.enum].sort(), names);
  }
});

test('configurations that are offered have no attribute that the schema does not know', () => {
  const { configurationAttributes, configurationSnippets, initialConfigurations } = manifest.contributes.debuggers[0];
  const common = ['type', 'request', 'name'];
  for (const configuration of [...initialConfigurations, ...configurationSnippets.map((row) => row.body)]) {
    const { properties, required } = configurationAttributes[configuration.request];
    for (const key of Object.keys(configuration)) assert.ok(common.includes(key) || key in properties, key);
    for (const key of required) assert.ok(key in configuration, key);
  }
});

test('the same sources give the same bytes', async () => {
  const first = readFileSync(await makePackage());
  assert.deepEqual(readFileSync(await makePackage()), first);
});
