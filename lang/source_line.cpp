#include "lang/source_line.hpp"

#include <algorithm>

#include "lang/instruction_table.hpp"

namespace opentmcl::lang {
namespace {

bool is_wordy(TokenKind kind) {
  return kind == TokenKind::name || kind == TokenKind::number;
}

TokenRole role_of_sign(TokenKind kind) {
  if (is_invalid(kind)) return TokenRole::invalid;
  if (kind == TokenKind::number) return TokenRole::number;
  if (kind == TokenKind::directive) return TokenRole::directive;
  return TokenRole::sign;
}

/// Whether token `index` is all there is of its operand.
bool stands_alone(const SourceLine& line, std::size_t index) {
  const Tokens& tokens = line.statement.tokens;
  const TokenKind after = tokens[index + 1].kind;
  const bool begins = index == line.first_operand_token || tokens[index - 1].kind == TokenKind::comma;
  return begins && (after == TokenKind::comma || after == TokenKind::end_of_line);
}

TokenRole role_of_name(const SourceLine& line, std::size_t index, std::string_view text) {
  const Tokens& tokens = line.statement.tokens;
  if (tokens[index + 1].kind == TokenKind::open) return TokenRole::function;
  const OperandSpec* const operand = line.operand_of(index);
  const bool is_word = operand != nullptr && takes_words(operand->kind) && stands_alone(line, index) &&
                       find_word(operand->kind, tokens[index].text(text)) >= 0;
  return is_word ? TokenRole::word : TokenRole::name;
}

}  // namespace

const OperandSpec* SourceLine::operand_of(std::size_t index) const {
  if (instruction == nullptr || index < first_operand_token) return nullptr;
  const std::uint32_t operand = operands[index - first_operand_token];
  return operand < operand_count(*instruction) ? &instruction->operands[operand] : nullptr;
}

void read_source_line(Lexer& lexer, std::string_view text, SourceLine& line) {
  read_statement(lexer, line.statement);
  const Tokens& tokens = line.statement.tokens;
  const std::size_t count = tokens.size() - 1;
  line.roles.clear();
  line.operands.clear();
  line.instruction = nullptr;

  std::size_t at = 0;
  for (; at < 2 * line.statement.label_count; ++at) {
    line.roles.push_back(tokens[at].kind == TokenKind::name ? TokenRole::label : TokenRole::sign);
  }
  // Not the kind of the statement: a line with a wrong character is still a line with an instruction.
  if (at < count && tokens[at].kind == TokenKind::name) {
    const bool is_constant = tokens[at + 1].kind == TokenKind::equals;
    if (!is_constant) line.instruction = find_mnemonic(tokens[at].text(text));
    line.roles.push_back(is_constant ? TokenRole::constant : TokenRole::mnemonic);
    ++at;
    if (is_constant) {
      line.roles.push_back(TokenRole::sign);
      ++at;
    }
  }
  line.first_operand_token = at;
  std::uint32_t operand = 0;
  for (; at < count; ++at) {
    line.operands.push_back(operand);
    if (tokens[at].kind == TokenKind::comma) ++operand;
    line.roles.push_back(tokens[at].kind == TokenKind::name ? role_of_name(line, at, text)
                                                            : role_of_sign(tokens[at].kind));
  }
}

std::size_t start_of_line(std::string_view text, std::size_t offset) {
  // The end of a line belongs to the line it ends, also between CR and LF.
  if (offset > 0 && offset < text.size() && text[offset] == '\n' && text[offset - 1] == '\r') --offset;
  if (offset == 0) return 0;
  const std::size_t end = text.find_last_of("\r\n", offset - 1);
  return end == std::string_view::npos ? 0 : end + 1;
}

std::size_t token_at(const SourceLine& line, std::size_t offset) {
  const auto begin = line.statement.tokens.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(line.token_count());
  const auto touching =
      std::partition_point(begin, end, [&](const Token& token) { return std::size_t{token.end()} < offset; });
  if (touching == end || touching->offset > offset) return line.token_count();
  const auto next = touching + 1;
  const bool take_next = next != end && next->offset <= offset && (is_wordy(next->kind) || !is_wordy(touching->kind));
  return static_cast<std::size_t>((take_next ? next : touching) - begin);
}

}  // namespace opentmcl::lang
