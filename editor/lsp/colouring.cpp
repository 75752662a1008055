#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "editor/lsp/requests.hpp"

namespace opentmcl::editor::lsp {

using lang::SourceLine;
using lang::Token;
using lang::TokenRole;

namespace {

enum class Colour : std::uint8_t {
  comment,
  keyword,
  macro,
  function,
  enum_member,
  variable,
  label,
  number,
  arithmetic
};

/// In the order of Colour; the names are the protocol's, "label" is new in 3.18 and skipped by clients without it.
constexpr std::array<const char*, 9> colour_names = {"comment",  "keyword", "macro",  "function", "enumMember",
                                                     "variable", "label",   "number", "operator"};
constexpr std::array<const char*, 2> modifier_names = {"definition", "readonly"};
constexpr unsigned is_definition = 1;
constexpr unsigned is_readonly = 2;

struct Paint {
  Colour colour;
  unsigned modifiers = 0;
};

Paint paint_of_name(const View& view, std::string_view name) {
  const lang::Symbol* const symbol = view.program.symbols().find(name);
  const bool is_label = symbol != nullptr && symbol->kind == lang::SymbolKind::label;
  return is_label ? Paint{Colour::label} : Paint{Colour::variable, is_readonly};
}

std::optional<Paint> paint_of(const View& view, const SourceLine& line, std::size_t index) {
  switch (line.roles[index]) {
    case TokenRole::label:
      return Paint{Colour::label, is_definition};
    case TokenRole::constant:
      return Paint{Colour::variable, is_definition | is_readonly};
    case TokenRole::mnemonic:
      return Paint{Colour::keyword};
    case TokenRole::word:
      return Paint{Colour::enum_member};
    case TokenRole::function:
      return Paint{Colour::function};
    case TokenRole::name:
      return paint_of_name(view, line.token(index).text(view.text()));
    case TokenRole::number:
      return Paint{Colour::number};
    case TokenRole::sign:
      break;
    case TokenRole::directive:
      return Paint{Colour::macro};
    case TokenRole::invalid:
      return std::nullopt;
  }
  switch (line.token(index).kind) {
    case lang::TokenKind::comma:
    case lang::TokenKind::colon:
    case lang::TokenKind::open:
    case lang::TokenKind::close:
      return std::nullopt;
    default:
      return Paint{Colour::arithmetic};
  }
}

/// Five numbers a token, as the protocol has it: the place relative to the token before, the length, what it is.
class TokenData {
 public:
  explicit TokenData(const TextIndex& index) : index_(&index) {}

  void add(std::size_t offset, std::size_t length, Paint paint) {
    const Position begin = index_->position_of(offset);
    const Position end = index_->position_of(offset + length);
    if (begin.line != end.line) return;
    const bool same_line = begin.line == last_.line;
    data_.push_back(begin.line - last_.line);
    data_.push_back(begin.character - (same_line ? last_.character : 0));
    data_.push_back(end.character - begin.character);
    data_.push_back(static_cast<std::size_t>(paint.colour));
    data_.push_back(paint.modifiers);
    last_ = begin;
  }

  json take() { return {{"data", std::move(data_)}}; }

 private:
  const TextIndex* index_;
  Position last_;
  std::vector<std::size_t> data_;
};

}  // namespace

json semantic_tokens_legend() {
  return {{"tokenTypes", colour_names}, {"tokenModifiers", modifier_names}};
}

json semantic_tokens(const View& view, std::size_t begin, std::size_t end) {
  TokenData data(view.index());
  lang::Lexer lexer(view.text(), lang::start_of_line(view.text(), begin));
  SourceLine line;
  std::size_t line_number = view.index().position_of(begin).line;
  while (!lexer.at_end() && view.index().start_of(line_number) <= end) {
    lang::read_source_line(lexer, view.text(), line);
    for (std::size_t i = 0; i < line.token_count(); ++i) {
      const Token& token = line.token(i);
      if (const std::optional<Paint> paint = paint_of(view, line, i)) data.add(token.offset, token.length, *paint);
    }
    // The line's own token is where its comment begins.
    const std::size_t comment = line.end_of_line().offset;
    const std::size_t line_end = view.index().start_of(line_number) + view.index().line(line_number).size();
    if (comment < line_end) data.add(comment, line_end - comment, {Colour::comment});
    ++line_number;
    if (line_number == view.index().line_count()) break;
  }
  return data.take();
}

json folding_ranges(const View& view) {
  json ranges = json::array();
  const auto add = [&](std::size_t first, std::size_t last, const char* kind) {
    if (last <= first) return;
    json range = {{"startLine", first}, {"endLine", last}};
    if (kind != nullptr) range["kind"] = kind;
    ranges.push_back(std::move(range));
  };
  lang::Lexer lexer(view.text());
  SourceLine line;
  std::optional<std::size_t> label;
  std::optional<std::size_t> comment;
  std::size_t last_code = 0;
  std::size_t number = 0;
  for (; !lexer.at_end(); ++number) {
    lang::read_source_line(lexer, view.text(), line);
    const bool has_code = line.token_count() > 0;
    const bool is_comment =
        !has_code && !view.index().line(number).empty() &&
        view.index().start_of(number) + view.index().line(number).size() > line.end_of_line().offset;
    if (comment && !is_comment) {
      add(*comment, number - 1, "comment");
      comment.reset();
    } else if (is_comment && !comment) {
      comment = number;
    }
    if (!has_code) continue;
    if (line.roles[0] == TokenRole::label) {
      if (label) add(*label, last_code, nullptr);
      label = number;
    }
    last_code = number;
  }
  if (comment) add(*comment, number - 1, "comment");
  if (label) add(*label, last_code, nullptr);
  return ranges;
}

}  // namespace opentmcl::editor::lsp
