// The grammar above expressions. One line is one statement:
//   line      = [label ":"]... [instruction | constant] | directive
//   constant  = name "=" expression
//   instruction = mnemonic [expression {"," expression}]
//   directive = "#include" file name
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lang/lexer.hpp"
#include "lang/token.hpp"

namespace opentmcl::lang {

/// Tokens [first, last) of a statement; `last` can always be read, because a line ends with a token of its own.
struct TokenRange {
  const Token* first = nullptr;
  const Token* last = nullptr;

  bool empty() const { return first == last; }
  std::size_t size() const { return static_cast<std::size_t>(last - first); }
};

enum class StatementKind : std::uint8_t {
  empty,  ///< labels at most
  instruction,
  constant,
  directive,
  invalid_token,  ///< `name` is a token that is none of the language
  unexpected,     ///< `name` is a token no statement can have there
};

/// One line, taken apart. Meant to be used again for the next line, so that reading lines does not allocate.
struct Statement {
  StatementKind kind = StatementKind::empty;
  std::size_t label_count = 0;
  Token name;                        ///< mnemonic, constant, directive, or the token that is wrong
  std::vector<TokenRange> operands;  ///< of an instruction; of a constant its value alone

  /// Label `index` counts from 0.
  const Token& label(std::size_t index) const { return tokens[2 * index]; }

  Tokens tokens;  ///< all of the line
};

/// Reads the next line into `statement`.
void read_statement(Lexer& lexer, Statement& statement);

}  // namespace opentmcl::lang
