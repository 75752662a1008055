#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "editor/lsp/requests.hpp"
#include "firmware/spec/instructions.hpp"
#include "lang/completion.hpp"
#include "lang/expression.hpp"
#include "lang/include_directive.hpp"
#include "lang/include_search.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"
#include "lang/operand_field.hpp"
#include "lang/operand_meaning.hpp"
#include "lang/operand_values.hpp"
#include "units/physical_value.hpp"

namespace opentmcl::editor::lsp {

using lang::Explanation;
using lang::OperandValues;
using lang::SourceLine;
using lang::Token;
using lang::TokenRole;
using units::PhysicalScale;

namespace {

/// Reads the lines of a document from its beginning on, and what its instructions do to the scale of physical values.
class ScaledLines {
 public:
  explicit ScaledLines(const View& view)
      : view_(&view), lexer_(view.text()), scale_(units::factory_scale(view.program.module())) {}

  /// False behind the last line.
  bool next() {
    if (lexer_.at_end()) return false;
    if (values_ && all_known()) units::follow(values_->command, view_->program.module(), scale_);
    lang::read_source_line(lexer_, view_->text(), line_);
    values_.reset();
    if (line_.instruction != nullptr) {
      values_ = lang::operand_values(line_, view_->text(), view_->file, view_->program.symbols());
    }
    return true;
  }

  const SourceLine& line() const { return line_; }
  /// Of an instruction.
  const std::optional<OperandValues>& values() const { return values_; }
  /// As it is before the line.
  const PhysicalScale& scale() const { return scale_; }

 private:
  bool all_known() const {
    return std::all_of(values_->is_known, values_->is_known + lang::operand_count(*line_.instruction),
                       [](bool known) { return known; });
  }

  const View* view_;
  lang::Lexer lexer_;
  PhysicalScale scale_;
  SourceLine line_;
  std::optional<OperandValues> values_;
};

bool is_known(const ScaledLines& lines, const OperandSpec* operand) {
  if (operand == nullptr || !lines.values()) return false;
  return lines.values()->is_known[operand - lines.line().instruction->operands];
}

std::optional<Explanation> explain_word(const SourceLine& line, std::size_t token, std::string_view text) {
  const OperandSpec* const operand = line.operand_of(token);
  const KeywordSet set = keywords_of(operand->kind);
  const int value = lang::find_word(operand->kind, text);
  for (std::size_t i = 0; i < set.count; ++i) {
    if (set.words[i].value == value) return lang::explain(set.words[i], operand->kind);
  }
  return std::nullopt;
}

std::optional<Explanation> explain_function(std::string_view name) {
  for (std::size_t i = 0; i < lang::function_count; ++i) {
    if (lang::equal_ignoring_case(lang::functions[i].name, name)) return lang::explain(lang::functions[i]);
  }
  return std::nullopt;
}

std::optional<Explanation> explain_name(const View& view, std::string_view name) {
  const lang::Symbol* const symbol = view.program.symbols().find(name);
  if (symbol == nullptr) return std::nullopt;
  return lang::explain(*symbol);
}

std::optional<Explanation> explain_include(const View& view, const Token& directive) {
  const std::optional<std::string_view> name = lang::included_file_name(directive.text(view.text()));
  if (!name || name->empty()) return std::nullopt;
  const lang::IncludeSearchResult found = view.workspace.search_include(*name, view.document, view.program.module());
  if (found.state != lang::FileContent::State::found) return std::nullopt;
  return Explanation{"#include " + std::string(*name), {found.is_built_in ? "built in" : found.path}};
}

/// What the name or number means, and then what the operand is that it is a part of.
void append(std::optional<Explanation>& explanation, const std::optional<Explanation>& more) {
  if (!more) return;
  // A constant of a built-in file is what the operand is.
  if (!explanation || explanation->title == more->title) {
    explanation = more;
    return;
  }
  explanation->lines.push_back(more->title);
  explanation->lines.insert(explanation->lines.end(), more->lines.begin(), more->lines.end());
}

std::optional<Explanation> explain_token(const View& view, const ScaledLines& lines, std::size_t index) {
  const SourceLine& line = lines.line();
  const std::string_view text = line.token(index).text(view.text());
  std::optional<Explanation> explanation;
  switch (line.roles[index]) {
    case TokenRole::mnemonic:
      if (line.instruction != nullptr) explanation = lang::explain(*line.instruction, view.program.module());
      return explanation;
    case TokenRole::word:
      return explain_word(line, index, text);
    case TokenRole::function:
      return explain_function(text);
    case TokenRole::directive:
      return explain_include(view, line.token(index));
    case TokenRole::label:
    case TokenRole::constant:
      return explain_name(view, text);
    case TokenRole::name:
      explanation = explain_name(view, text);
      break;
    case TokenRole::number:
      break;
    case TokenRole::sign:
    case TokenRole::invalid:
      return explanation;
  }
  const OperandSpec* const operand = line.operand_of(index);
  if (is_known(lines, operand)) {
    append(explanation, lang::explain_operand(*operand, lines.values()->command, view.program.module(), lines.scale()));
  }
  return explanation;
}

}  // namespace

json hover(const View& view, std::size_t offset, const ClientAbilities& client) {
  const std::size_t start = lang::start_of_line(view.text(), offset);
  ScaledLines lines(view);
  while (lines.next()) {
    const SourceLine& line = lines.line();
    if (line.end_of_line().offset < start) continue;
    const std::size_t index = lang::token_at(line, offset);
    if (index == line.token_count()) return nullptr;
    const std::optional<Explanation> explanation = explain_token(view, lines, index);
    if (!explanation) return nullptr;
    const Token& token = line.token(index);
    return {{"contents", markup(*explanation, client)}, {"range", view.range({view.file, token.offset, token.length})}};
  }
  return nullptr;
}

json signature_help(const View& view, std::size_t offset) {
  const lang::CursorPlace place = lang::place_of_cursor(view.text(), offset);
  if (place.kind != lang::CursorPlace::Kind::operand || place.instruction == nullptr) return nullptr;
  const std::size_t count = lang::operand_count(*place.instruction);
  if (count == 0) return nullptr;
  Explanation explanation = lang::explain(*place.instruction, view.program.module());
  const std::string label = std::exchange(explanation.title, {});

  json parameters = json::array();
  std::size_t at = std::string_view(place.instruction->mnemonic).size() + 1;  // behind the mnemonic and a blank
  for (std::size_t i = 0; i < count; ++i) {
    const OperandSpec& operand = place.instruction->operands[i];
    const std::size_t end = at + lang::name_of_operand_kind(operand.kind).size();
    parameters.push_back(
        {{"label", {at, end}}, {"documentation", lang::describe_operand(operand, view.program.module())}});
    at = end + std::string_view(", ").size();
  }
  const json signature = {
      {"label", label}, {"documentation", place.instruction->description}, {"parameters", std::move(parameters)}};
  return {{"signatures", json::array({signature})},
          {"activeSignature", 0},
          {"activeParameter", std::min(place.operand, count - 1)}};
}

json inlay_hints(const View& view, std::size_t begin, std::size_t end) {
  json hints = json::array();
  const auto add = [&](const Token& token, std::string_view text, InlayHintKindCode kind) {
    hints.push_back({{"position", to_json(view.index().position_of(token.end()))},
                     {"label", text},
                     {"kind", number_of(kind)},
                     {"paddingLeft", true}});
  };
  ScaledLines lines(view);
  while (lines.next()) {
    const SourceLine& line = lines.line();
    if (line.end_of_line().offset < begin || !lines.values()) continue;
    if (line.token(0).offset > end) break;
    const Command& command = lines.values()->command;
    const ModuleDescription& module = view.program.module();
    const std::size_t count = std::min(lang::operand_count(*line.instruction), line.statement.operands.size());
    for (std::size_t i = 0; i < count; ++i) {
      const OperandSpec& operand = line.instruction->operands[i];
      if (!lines.values()->is_known[i]) continue;
      const lang::TokenRange written = line.statement.operands[i];
      // A name says what it is; of a number one has to be told.
      const bool is_number = written.size() == 1 && written.first->kind == lang::TokenKind::number;
      const std::string_view name = is_number ? lang::name_of_operand(operand, command, module) : std::string_view();
      if (!name.empty()) add(written.last[-1], name, InlayHintKindCode::parameter);
      const Unit unit = lang::unit_of_operand(operand, command, module);
      const std::int32_t value = lang::operand_value(command, operand);
      const std::string physical = units::short_physical_value(unit, value, lines.scale());
      const bool says_more = unit != Unit::none && physical != std::to_string(value) && value != 0;
      if (says_more && !physical.empty()) add(written.last[-1], "= " + physical, InlayHintKindCode::type);
    }
  }
  return hints;
}

}  // namespace opentmcl::editor::lsp
