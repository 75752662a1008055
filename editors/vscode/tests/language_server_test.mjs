// What the extension tells `tmcl lsp` in its own words: the module of the setting, and its changes.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import test from 'node:test';
import rpc from 'vscode-jsonrpc/node.js';
import { tmcl } from '../scripts/package.mjs';

const timeLimit = 20000;
const uri = 'file:///program.tmc';
// Only the PD-1161 has CALCVV.
const program = '    CALCVV ADD, 1, 2\n    STOP\n';

test('the setting tmcl.module decides of which module a program is', { timeout: timeLimit }, async () => {
  const server = spawn(tmcl, ['lsp'], { stdio: ['pipe', 'pipe', 'inherit'] });
  const ended = new Promise((resolve) => server.on('exit', resolve));
  const connection = rpc.createMessageConnection(server.stdout, server.stdin);
  const published = [];
  const waiting = [];
  connection.onNotification('textDocument/publishDiagnostics', (message) => {
    published.push(message.diagnostics.filter((diagnostic) => diagnostic.severity === 1).length);
    waiting.splice(0).forEach((resolve) => resolve());
  });
  connection.onRequest('workspace/configuration', () => [null]);
  connection.listen();
  /** The number of errors, once it is this. */
  const errors = async (count) => {
    while (published.at(-1) !== count) await new Promise((resolve) => waiting.push(resolve));
  };
  try {
    await connection.sendRequest('initialize', {
      processId: process.pid,
      rootUri: null,
      capabilities: {},
      initializationOptions: { module: 'tmcm1110' },
    });
    await connection.sendNotification('initialized', {});
    await connection.sendNotification('textDocument/didOpen', {
      textDocument: { uri, languageId: 'tmcl', version: 1, text: program },
    });
    await errors(1);
    await connection.sendNotification('workspace/didChangeConfiguration', { settings: { tmcl: { module: 'pd1161' } } });
    await errors(0);
    await connection.sendRequest('shutdown');
    await connection.sendNotification('exit');
    assert.equal(await ended, 0);
  } finally {
    connection.dispose();
    server.kill();
  }
});
