// The grammar as VS Code uses it: with its own library for TextMate grammars and regular expressions.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import oniguruma from 'vscode-oniguruma';
import textmate from 'vscode-textmate';
import { grammarOf } from '../scripts/grammar.mjs';
import { tmcl } from '../scripts/package.mjs';

const project = join(dirname(fileURLToPath(import.meta.url)), '../../..');
const spec = JSON.parse(execFileSync(tmcl, ['spec', '--json'], { encoding: 'utf8', maxBuffer: 1 << 26 }));
const grammar = await load(grammarOf(spec));

async function load(content) {
  const wasm = createRequire(import.meta.url).resolve('vscode-oniguruma/release/onig.wasm');
  await oniguruma.loadWASM(readFileSync(wasm));
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => textmate.parseRawGrammar(JSON.stringify(content), 'tmcl.json'),
  });
  return registry.loadGrammar('source.tmcl');
}

/** Lines of `text`, each as an array of [text, innermost scope], without what has no scope. */
function tokens(text) {
  let state = textmate.INITIAL;
  return text.split(/\r?\n/).map((line) => {
    const result = grammar.tokenizeLine(line, state);
    state = result.ruleStack;
    return result.tokens
      .map((token) => [line.slice(token.startIndex, token.endIndex), token.scopes.at(-1).replace(/\.tmcl$/, '')])
      .filter(([, scope]) => scope !== 'source');
  });
}

function tokensOfLine(line) {
  return tokens(line)[0];
}

test('every mnemonic has a colour, in any case, and steering ones another', () => {
  for (const { mnemonic, where } of spec.instructions) {
    if (mnemonic === null) continue;
    const scope = where === 'program' ? 'keyword.control' : 'keyword.other.instruction';
    for (const spelling of [mnemonic, mnemonic.toLowerCase()]) {
      assert.deepEqual(tokensOfLine(`    ${spelling}`), [[spelling, scope]]);
      assert.deepEqual(tokensOfLine(`There: ${spelling}`).at(-1), [spelling, scope]);
      assert.deepEqual(tokensOfLine(`    ${spelling}_`), []);
    }
  }
});

test('every word of an operand is a word', () => {
  for (const { mnemonic, operands } of spec.instructions) {
    for (const { word } of operands.flatMap((operand) => operand.words ?? [])) {
      assert.deepEqual(tokensOfLine(`${mnemonic} ${word}, 0`)[1], [word, 'constant.language']);
    }
  }
});

test('functions and the names of the include files are known', () => {
  for (const { name } of spec.functions) {
    assert.deepEqual(tokensOfLine(`X = ${name}(1)`)[2], [name, 'support.function']);
  }
  for (const { symbol } of [...spec.axis_parameters, ...spec.global_parameters, ...spec.interrupts]) {
    assert.deepEqual(tokensOfLine(`SAP ${symbol}, Motor0, 1`).slice(1, 4), [
      [symbol, 'support.constant'],
      [',', 'punctuation.separator.operand'],
      ['Motor0', 'support.constant'],
    ]);
  }
});

test('labels, constants, numbers, directives and comments', () => {
  assert.deepEqual(tokensOfLine('Stop: JC ze, Stop // again'), [
    ['Stop', 'entity.name.function'],
    [':', 'punctuation.separator.label'],
    ['JC', 'keyword.control'],
    ['ze', 'constant.language'],
    [',', 'punctuation.separator.operand'],
    ['Stop', 'variable.other'], // STOP is a word of RFS alone
    ['// again', 'comment.line.double-slash'],
  ]);
  assert.deepEqual(tokensOfLine('Speed = -(1.5e3 + $fF) * %101 ^ 2 ; fast'), [
    ['Speed', 'variable.other.constant'],
    ['=', 'keyword.operator.assignment'],
    ['-', 'keyword.operator.arithmetic'],
    ['1.5e3', 'constant.numeric.decimal'],
    ['+', 'keyword.operator.arithmetic'],
    ['$fF', 'constant.numeric.hexadecimal'],
    ['*', 'keyword.operator.arithmetic'],
    ['%101', 'constant.numeric.binary'],
    ['^', 'keyword.operator.arithmetic'],
    ['2', 'constant.numeric.decimal'],
    ['; fast', 'comment.line.semicolon'],
  ]);
  assert.deepEqual(tokensOfLine('Wait = 3')[0], ['Wait', 'variable.other.constant']);
  assert.deepEqual(tokensOfLine('#include Interrupts.inc // names'), [
    ['#', 'punctuation.definition.directive'],
    ['include', 'keyword.control.directive.include'],
    ['Interrupts.inc', 'string.unquoted.include'],
    ['// names', 'comment.line.double-slash'],
  ]);
  assert.deepEqual(tokensOfLine('MVP ABS, 0, ABS(-3)').filter(([text]) => text === 'ABS'), [
    ['ABS', 'constant.language'],
    ['ABS', 'support.function'],
  ]);
});

function* programsIn(folder) {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) yield* programsIn(path);
    else if (entry.name.endsWith('.tmc')) yield path;
  }
}

/** How many instructions the assembler makes of a program; eight bytes each. */
function instructionsIn(path, module) {
  const folder = mkdtempSync(join(tmpdir(), 'tmcl_grammar.'));
  try {
    const binary = join(folder, 'program.bin');
    execFileSync(tmcl, ['asm', path, '--module', module, '--no-append-stop', '-o', binary], { stdio: 'pipe' });
    return statSync(binary).size / 8;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test('in the example programs all has a scope, and instructions are what the assembler takes for them', () => {
  const withoutParentheses = (text) => text.replace(/[()\s]/g, '');
  let programs = 0;
  for (const path of programsIn(join(project, 'examples'))) {
    programs += 1;
    const text = readFileSync(path, 'utf8');
    const lines = tokens(text);
    for (const [number, line] of text.split(/\r?\n/).entries()) {
      const coloured = lines[number].map(([token]) => token).join('');
      assert.equal(withoutParentheses(coloured), withoutParentheses(line), `${path}:${number + 1}`);
    }
    const isInstruction = ([, scope]) => scope === 'keyword.control' || scope === 'keyword.other.instruction';
    const module = /^\/\/ module: (\w+)/m.exec(text)?.[1] ?? 'pd1161';
    assert.equal(lines.flat().filter(isInstruction).length, instructionsIn(path, module), path);
  }
  assert.ok(programs > 10);
});
