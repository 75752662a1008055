#include "lang/statement.hpp"

#include <algorithm>

namespace opentmcl::lang {
namespace {

void split_at_commas(const Token* first, const Token* last, std::vector<TokenRange>& operands) {
  if (first == last) return;
  const Token* start = first;
  for (const Token* token = first; token != last; ++token) {
    if (token->kind != TokenKind::comma) continue;
    operands.push_back({start, token});
    start = token + 1;
  }
  operands.push_back({start, last});
}

}  // namespace

void read_statement(Lexer& lexer, Statement& statement) {
  statement.operands.clear();
  const bool is_valid = lexer.read_line(statement.tokens);
  const Token* token = statement.tokens.data();
  const Token* const last = token + statement.tokens.size() - 1;

  while (token->kind == TokenKind::name && token[1].kind == TokenKind::colon) token += 2;
  statement.label_count = static_cast<std::size_t>(token - statement.tokens.data()) / 2;
  statement.name = *token;

  if (!is_valid) {
    statement.kind = StatementKind::invalid_token;
    statement.name = *std::find_if(token, last, [](const Token& each) { return is_invalid(each.kind); });
  } else if (token == last) {
    statement.kind = StatementKind::empty;
  } else if (token->kind == TokenKind::directive && statement.label_count == 0) {
    statement.kind = StatementKind::directive;
  } else if (token->kind != TokenKind::name) {
    statement.kind = StatementKind::unexpected;
  } else if (token[1].kind == TokenKind::equals) {
    statement.kind = StatementKind::constant;
    statement.operands.push_back({token + 2, last});
  } else {
    statement.kind = StatementKind::instruction;
    split_at_commas(token + 1, last, statement.operands);
  }
}

}  // namespace opentmcl::lang
