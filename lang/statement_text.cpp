#include "lang/statement_text.hpp"

#include <algorithm>
#include <cstddef>

#include "firmware/spec/instructions.hpp"
#include "lang/expression.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

/// Whether a token can be part of an expression; all of these can be written with or without blanks around them, but
/// for two words, which need one between them.
bool belongs_to_expressions(const Token& token) {
  switch (token.kind) {
    case TokenKind::name:
    case TokenKind::number:
    case TokenKind::plus:
    case TokenKind::minus:
    case TokenKind::star:
    case TokenKind::slash:
    case TokenKind::caret:
    case TokenKind::open:
    case TokenKind::close:
      return true;
    default:
      return false;
  }
}

bool is_expression(TokenRange range) {
  return !range.empty() && std::all_of(range.first, range.last, belongs_to_expressions);
}

bool ends_value(const Token& token) {
  return token.kind == TokenKind::name || token.kind == TokenKind::number || token.kind == TokenKind::close;
}

bool begins_value(const Token& token) {
  return token.kind == TokenKind::name || token.kind == TokenKind::number || token.kind == TokenKind::open;
}

/// Operators with blanks around them, if they stand between two values. A slash has them always, lest two of them begin
/// a comment.
bool is_spaced_operator(const Token& token, bool after_value) {
  switch (token.kind) {
    case TokenKind::slash:
      return true;
    case TokenKind::plus:
    case TokenKind::minus:
    case TokenKind::star:
      return after_value;
    default:
      return false;
  }
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  std::transform(upper.begin(), upper.end(), upper.begin(), to_upper);
  return upper;
}

bool is_function(std::string_view name) {
  return std::any_of(functions, functions + function_count,
                     [&](const FunctionSpec& function) { return equal_ignoring_case(function.name, name); });
}

void append_expression(std::string& text, TokenRange range, std::string_view source) {
  bool after_value = false;
  bool blank_follows = false;
  for (const Token* token = range.first; token != range.last; ++token) {
    const std::string_view written = token->text(source);
    const bool is_called = token->kind == TokenKind::name && token + 1 != range.last &&
                           token[1].kind == TokenKind::open && is_function(written);
    const bool calls = token->kind == TokenKind::open && token != range.first && is_function(token[-1].text(source));
    const bool is_spaced = is_spaced_operator(*token, after_value);
    const bool stands_beside_value = after_value && begins_value(*token) && !calls;
    if (token != range.first && (blank_follows || is_spaced || stands_beside_value)) text += ' ';
    text += is_called ? upper_case(written) : std::string(written);
    blank_follows = is_spaced;
    after_value = ends_value(*token);
  }
}

void append_operand(std::string& text, OperandKind kind, TokenRange range, std::string_view source) {
  const std::string_view written = range.first->text(source);
  if (range.size() == 1 && range.first->kind == TokenKind::name && find_word(kind, written) >= 0) {
    text += upper_case(written);
  } else {
    append_expression(text, range, source);
  }
}

std::optional<std::string> instruction_text(const Statement& statement, std::string_view source) {
  const InstructionSpec* const instruction = find_mnemonic(statement.name.text(source));
  if (instruction == nullptr) return std::nullopt;
  std::string text = instruction->mnemonic;
  for (std::size_t i = 0; i < statement.operands.size(); ++i) {
    const TokenRange operand = statement.operands[i];
    if (!is_expression(operand)) return std::nullopt;
    text += i == 0 ? " " : ", ";
    const OperandKind kind = i < operand_count(*instruction) ? instruction->operands[i].kind : OperandKind::none;
    append_operand(text, kind, operand, source);
  }
  return text;
}

std::optional<std::string> constant_text(const Statement& statement, std::string_view source) {
  const TokenRange value = statement.operands.front();
  if (!is_expression(value)) return std::nullopt;
  std::string text;
  append_expression(text, value, source);
  return text;
}

std::optional<std::string> directive_text(const Statement& statement, std::string_view source) {
  constexpr std::string_view include = "include";
  constexpr std::string_view blanks = " \t\v\f";
  std::string_view rest = statement.name.text(source).substr(1);
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  if (!equal_ignoring_case(rest.substr(0, include.size()), include)) return std::nullopt;
  rest.remove_prefix(include.size());
  if (rest.empty() || continues_name(rest.front())) return std::nullopt;
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  return "#include " + std::string(rest);
}

}  // namespace

std::optional<std::string> statement_text(const Statement& statement, std::string_view source) {
  switch (statement.kind) {
    case StatementKind::empty:
      return std::string();
    case StatementKind::instruction:
      return instruction_text(statement, source);
    case StatementKind::constant:
      return constant_text(statement, source);
    case StatementKind::directive:
      return directive_text(statement, source);
    case StatementKind::invalid_token:
    case StatementKind::unexpected:
      break;
  }
  return std::nullopt;
}

}  // namespace opentmcl::lang
