// One line as somebody sees it who looks at a place in a source rather than at the program it makes: what each word in
// it is, also where the line is not finished or wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "lang/lexer.hpp"
#include "lang/statement.hpp"
#include "lang/token.hpp"

namespace opentmcl::lang {

enum class TokenRole : std::uint8_t {
  label,     ///< defined here
  constant,  ///< defined here
  mnemonic,  ///< also an unknown one
  word,      ///< that stands for an operand: ABS, GE
  function,  ///< also an unknown one
  name,      ///< use of a label or a constant
  number,
  sign,
  directive,
  invalid,
};

struct SourceLine {
  Statement statement;
  std::vector<TokenRole> roles;         ///< of the tokens of the statement but the end of the line
  std::vector<std::uint32_t> operands;  ///< of which operand each of these is a part, where they begin to be of any
  std::size_t first_operand_token = 0;  ///< index of the first token after mnemonic or "="
  const InstructionSpec* instruction = nullptr;  ///< none if the line has none, or an unknown one

  std::size_t token_count() const { return roles.size(); }
  const Token& token(std::size_t index) const { return statement.tokens[index]; }
  const Token& end_of_line() const { return statement.tokens.back(); }
  /// The operand that token `index` is a part of, or nullptr.
  const OperandSpec* operand_of(std::size_t index) const;
};

/// Reads the next line of `text`, which is the lexer's.
void read_source_line(Lexer& lexer, std::string_view text, SourceLine& line);

/// Where the line begins that a place is in.
std::size_t start_of_line(std::string_view text, std::size_t offset);

/// The token that begins before or at `offset` and ends at or behind it, the later one of two that touch if that is a
/// name or number and the other one is none; the number of tokens if there is none.
std::size_t token_at(const SourceLine& line, std::size_t offset);

}  // namespace opentmcl::lang
