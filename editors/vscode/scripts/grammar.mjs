// The TextMate grammar, made from the tables of `tmcl spec --json`: no mnemonic, word or name is typed here.

const name = '[A-Za-z_][A-Za-z0-9_]*';
const number = [
  { name: 'constant.numeric.hexadecimal.tmcl', match: '\\$[0-9A-Fa-f]+\\b' },
  { name: 'constant.numeric.binary.tmcl', match: '%[01]+\\b' },
  {
    name: 'constant.numeric.decimal.tmcl',
    match: '(?<![A-Za-z0-9_])(?:[0-9]+(?:\\.[0-9]*)?|\\.[0-9]+)(?:[eE][+-]?[0-9]+)?\\b',
  },
];

/** A pattern for whole words, longest first, in any case. */
function anyOf(words) {
  const sorted = [...new Set(words)].sort((a, b) => b.length - a.length || (a < b ? -1 : 1));
  return `(?i:${sorted.join('|')})(?![A-Za-z0-9_])`;
}

/** The names that TMCLParam.tmc and Interrupts.inc define. */
function namesOfIncludeFiles(spec) {
  const axes = Math.max(...spec.modules.map((module) => module.axis_count));
  return [
    ...Array.from({ length: axes }, (_, axis) => `Motor${axis}`),
    ...[...spec.axis_parameters, ...spec.global_parameters, ...spec.interrupts].map((row) => row.symbol),
  ];
}

/** What only a program can do steers it: jumps, calls, waits. */
function scopeOf(instruction) {
  return instruction.where === 'program' ? 'keyword.control.tmcl' : 'keyword.other.instruction.tmcl';
}

/** Rules for statements, one for all instructions that look alike and take the same words. */
function statements(spec) {
  const groups = new Map();
  for (const instruction of spec.instructions) {
    if (instruction.mnemonic === null) continue;
    const words = instruction.operands.flatMap((operand) => (operand.words ?? []).map((row) => row.word));
    const key = [scopeOf(instruction), ...words].join();
    if (!groups.has(key)) groups.set(key, { scope: scopeOf(instruction), words, mnemonics: [] });
    groups.get(key).mnemonics.push(instruction.mnemonic);
  }
  return [...groups.values()].map(({ scope, words, mnemonics }) => ({
    begin: `(?<![A-Za-z0-9_])${anyOf(mnemonics)}(?!\\s*=)`,
    beginCaptures: { 0: { name: scope } },
    end: '(?=//|;|$)',
    patterns: [
      // Words end where an opening parenthesis follows: ABS is one of MVP, and a function.
      ...(words.length === 0
        ? []
        : [{ name: 'constant.language.tmcl', match: `(?<![A-Za-z0-9_])${anyOf(words)}(?!\\s*\\()` }]),
      { include: '#expression' },
    ],
  }));
}

export function grammarOf(spec) {
  return {
    name: 'TMCL',
    scopeName: 'source.tmcl',
    patterns: [
      { include: '#comment' },
      {
        match: `^\\s*(#)\\s*((?i:include))\\s+(.*?)\\s*(?=//|;|$)`,
        captures: {
          1: { name: 'punctuation.definition.directive.tmcl' },
          2: { name: 'keyword.control.directive.include.tmcl' },
          3: { name: 'string.unquoted.include.tmcl' },
        },
      },
      {
        begin: `^\\s*(${name})\\s*(=)`,
        beginCaptures: {
          1: { name: 'variable.other.constant.tmcl' },
          2: { name: 'keyword.operator.assignment.tmcl' },
        },
        end: '(?=//|;|$)',
        patterns: [{ include: '#expression' }],
      },
      {
        match: `^\\s*(${name})\\s*(:)`,
        captures: {
          1: { name: 'entity.name.function.tmcl' },
          2: { name: 'punctuation.separator.label.tmcl' },
        },
      },
      ...statements(spec),
    ],
    repository: {
      comment: {
        patterns: [
          { name: 'comment.line.double-slash.tmcl', match: '//.*$' },
          { name: 'comment.line.semicolon.tmcl', match: ';.*$' },
        ],
      },
      expression: {
        patterns: [
          ...number,
          {
            name: 'support.function.tmcl',
            match: `(?<![A-Za-z0-9_])${anyOf(spec.functions.map((row) => row.name))}(?=\\s*\\()`,
          },
          { name: 'support.constant.tmcl', match: `(?<![A-Za-z0-9_])${anyOf(namesOfIncludeFiles(spec))}` },
          { name: 'variable.other.tmcl', match: `(?<![A-Za-z0-9_])${name}` },
          { name: 'keyword.operator.arithmetic.tmcl', match: '[-+*/^]' },
          { name: 'punctuation.separator.operand.tmcl', match: ',' },
        ],
      },
    },
  };
}
