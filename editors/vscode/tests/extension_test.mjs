// The packed extension in an editor that is only as much of VS Code as it touches.
import assert from 'node:assert/strict';
import Module, { createRequire } from 'node:module';
import { join } from 'node:path';
import test from 'node:test';
import { makePackage, output, tmcl } from '../scripts/package.mjs';

await makePackage();

const settings = {};
const messages = [];
const commands = [];
const debug = {};
const editor = { document: { languageId: 'tmcl' } };

/** Classes that the language client derives from when it is loaded are empty here. */
function partOfVsCode(content) {
  return new Proxy(content, { get: (target, key) => (key in target || typeof key === 'symbol' ? target[key] : class {}) });
}

const disposable = { dispose() {} };
const vscode = partOfVsCode({
  commands: partOfVsCode({ registerCommand: (id) => commands.push(id) && disposable }),
  debug: partOfVsCode({
    registerDebugAdapterDescriptorFactory: (type, factory) => Object.assign(debug, { type, factory }) && disposable,
    registerDebugConfigurationProvider: (_type, provider) => Object.assign(debug, { provider }) && disposable,
  }),
  window: partOfVsCode({ activeTextEditor: editor, showErrorMessage: async (message) => void messages.push(message) }),
  workspace: partOfVsCode({
    workspaceFolders: [{ uri: { fsPath: '/' } }],
    getConfiguration: () => ({ get: (key, otherwise) => settings[key] ?? otherwise }),
    onDidChangeConfiguration: () => disposable,
  }),
  DebugAdapterExecutable: class {
    constructor(command, args) {
      Object.assign(this, { command, args });
    }
  },
  DebugConfigurationProviderTriggerKind: { Initial: 1, Dynamic: 2 },
});

/** Loads extension.js with `vscode` in the place of the editor's. */
function load() {
  const loader = Module._load;
  Module._load = (request, ...others) => (request === 'vscode' ? vscode : loader(request, ...others));
  try {
    return createRequire(import.meta.url)(join(output, 'extension/extension.js'));
  } finally {
    Module._load = loader;
  }
}

settings.path = 'no-such-program';
const extension = load();
await extension.activate({ subscriptions: [] });
const messagesOfActivation = messages.splice(0);

test('says what to do when there is no tmcl', () => {
  assert.equal(messagesOfActivation.length, 1);
  assert.match(messagesOfActivation[0], /'no-such-program' was not found.*\.\/run --build-only.*tmcl\.path/);
});

test('registers what the manifest promises', async () => {
  const manifest = createRequire(import.meta.url)(join(output, 'extension/package.json'));
  assert.deepEqual(commands, manifest.contributes.commands.map((row) => row.command));
  assert.equal(debug.type, manifest.contributes.debuggers[0].type);
});

test('debugs with tmcl dap, wherever the setting says that tmcl is', async () => {
  const places = [tmcl, tmcl.slice(1)]; // absolute, and from the folder of the workspace, which is / here
  for (const path of places) {
    settings.path = path;
    assert.deepEqual({ ...(await debug.factory.createDebugAdapterDescriptor()) }, { command: tmcl, args: ['dap'] });
  }
  settings.path = join(output, 'extension'); // a folder is no program
  assert.equal(await debug.factory.createDebugAdapterDescriptor(), undefined);
  assert.match(messages.splice(0).join(), /was not found/);
});

test('looks for a name in PATH', async () => {
  const path = process.env.PATH;
  settings.path = 'tmcl';
  try {
    process.env.PATH = `/no-such-folder:${tmcl.slice(0, tmcl.lastIndexOf('/'))}`;
    assert.equal((await debug.factory.createDebugAdapterDescriptor()).command, tmcl);
  } finally {
    process.env.PATH = path;
  }
});

test('F5 without a launch.json debugs the program in the editor on a virtual module', () => {
  settings.module = 'tmcm1110';
  const resolved = debug.provider.resolveDebugConfiguration(undefined, {});
  assert.equal(resolved.program, '${file}');
  assert.equal(resolved.request, 'launch');
  assert.equal(resolved.defaultModule, 'tmcm1110');
  assert.ok(!('port' in resolved) && !('module' in resolved));
});

test('F5 in a file of another language is none of its business', () => {
  editor.document.languageId = 'python';
  assert.deepEqual(debug.provider.resolveDebugConfiguration(undefined, {}), {});
  editor.document.languageId = 'tmcl';
});

test('a configuration without a program is refused with a message', () => {
  const incomplete = { type: 'tmcl', request: 'attach', name: 'mine', port: '/dev/ttyACM0' };
  assert.equal(debug.provider.resolveDebugConfiguration(undefined, incomplete), undefined);
  assert.match(messages.splice(0).join(), /'mine' has no 'program'/);
});

test('ends without a server', () => extension.deactivate());
