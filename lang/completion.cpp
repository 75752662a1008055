#include "lang/completion.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"
#include "firmware/spec/io_ports.hpp"
#include "lang/include_directive.hpp"
#include "lang/instruction_table.hpp"
#include "lang/lexer.hpp"
#include "lang/names.hpp"
#include "lang/source_line.hpp"

namespace opentmcl::lang {
namespace {

using Kind = CursorPlace::Kind;

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\v\f") == std::string_view::npos;
}

/// A comment leaves no token: something else than blanks between the last one and the cursor is one.
bool is_in_comment(std::string_view text, const SourceLine& line, std::size_t line_start, std::size_t offset) {
  std::size_t code_end = line.token_count() == 0 ? line_start : line.token(line.token_count() - 1).end();
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (code_end == 0 && text.substr(0, byte_order_mark.size()) == byte_order_mark) code_end = byte_order_mark.size();
  return offset > code_end && !is_blank(text.substr(code_end, offset - code_end));
}

/// `#include`, a name, or both, as far as they are written.
CursorPlace place_in_directive(std::string_view text, const Token& directive) {
  CursorPlace place;
  place.kind = Kind::directive;
  place.start = directive.offset;
  const std::optional<std::string_view> name = included_file_name(directive.text(text));
  if (!name) return place;
  // The blanks behind `#include` are no part of the directive when nothing follows them.
  const bool is_missing = name->empty();
  if (is_missing && text.size() == directive.end()) return place;
  place.kind = Kind::file_name;
  place.start =
      is_missing ? static_cast<std::uint32_t>(text.size()) : static_cast<std::uint32_t>(name->data() - text.data());
  if (text.substr(place.start, 1) == "\"") ++place.start;
  return place;
}

/// Whether the letters of `written` come in `label` in this order: more than any editor shows.
bool may_match(std::string_view written, std::string_view label) {
  auto at = label.begin();
  for (const char c : written) {
    at = std::find_if(at, label.end(), [&](char other) { return to_upper(other) == to_upper(c); });
    if (at == label.end()) return false;
    ++at;
  }
  return true;
}

class Collection {
 public:
  Collection(std::string_view written, const ModuleDescription& module) : written_(written), module_(&module) {}

  CompletionList take() { return std::move(list_); }

  void add_statements() {
    for (const InstructionSpec& row : instructions) {
      if (row.mnemonic == nullptr || !contains(row.modules, module_->id)) continue;
      add(CompletionKind::mnemonic, row.mnemonic, row.mnemonic, [&] { return explain(row, *module_); });
    }
    add_directive();
  }

  void add_directive() {
    add(CompletionKind::directive, "#include ", "#include", [] {
      return Explanation{"#include FILE", {"Reads another file here."}};
    });
  }

  /// What chooses something of the module by a word or a number.
  void add_choices(OperandKind kind) {
    const KeywordSet set = keywords_of(kind);
    for (std::size_t i = 0; i < set.count; ++i) {
      const Keyword& word = set.words[i];
      if (word.value == set.excluded) continue;
      add(CompletionKind::word, word.word, word.word, [&] { return explain(word, kind); });
    }
    switch (kind) {
      case OperandKind::motor:
        for (int motor = 0; motor < module_->axis_count; ++motor)
          add_number(motor, "motor", [] { return Explanation(); });
        break;
      case OperandKind::axis_parameter:
        add_parameters(axis_parameters, axis_parameter_count);
        break;
      case OperandKind::global_parameter:
        add_parameters(global_parameters, global_parameter_count);
        break;
      case OperandKind::interrupt:
        for (const InterruptSpec& row : interrupts) {
          if (!contains(row.modules, module_->id)) continue;
          add_number(static_cast<int>(row.number), row.name, [&] { return explain(row); });
        }
        break;
      case OperandKind::port:
        add_ports();
        break;
      default:
        break;
    }
  }

  void add_functions() {
    for (std::size_t i = 0; i < function_count; ++i) {
      add(CompletionKind::function, std::string(functions[i].name) + "(", functions[i].name,
          [&] { return explain(functions[i]); });
    }
  }

  void add_symbols(const SymbolTable& symbols, FileId file, std::size_t offset, bool with_labels) {
    for (const Symbol& symbol : symbols.symbols()) {
      const bool is_label = symbol.kind == SymbolKind::label;
      const bool is_behind = symbol.span.file == file && symbol.span.offset >= offset;
      if (is_label ? !with_labels : is_behind) continue;
      add(is_label ? CompletionKind::label : CompletionKind::constant, symbol.name, symbol.name,
          [&] { return explain(symbol); });
    }
  }

 private:
  /// Explained only if it is wanted: a program can have very many names.
  template <class Explain>
  void add(CompletionKind kind, std::string_view text, std::string_view label, const Explain& explain_it) {
    if (!may_match(written_, label)) return;
    if (list_.items.size() == most_completions) {
      list_.is_complete = false;
      return;
    }
    list_.items.push_back({kind, std::string(text), std::string(label), explain_it()});
  }

  template <class Explain>
  void add_number(int number, const std::string& name, const Explain& explain_it) {
    const std::string text = std::to_string(number);
    add(CompletionKind::number, text, text + " " + name, explain_it);
  }

  template <class Row>
  void add_parameters(const Row* rows, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (rows[i].in(module_->id).access == Access::none) continue;
      add_number(static_cast<int>(rows[i].number), rows[i].name, [&] { return explain(rows[i], *module_); });
    }
  }

  void add_ports() {
    for (const IoPortSpec& row : io_ports) {
      if (!contains(row.modules, module_->id)) continue;
      // The bank has an operand of its own.
      const std::string text = std::to_string(row.port);
      std::string detail = text;
      detail.append(" bank ").append(std::to_string(static_cast<int>(row.bank))).append(": ").append(row.description);
      add(CompletionKind::number, text, detail, [&] { return explain(row); });
    }
  }

  std::string_view written_;
  const ModuleDescription* module_;
  CompletionList list_;
};

}  // namespace

const OperandSpec* CursorPlace::spec() const {
  const bool exists = kind == Kind::operand && instruction != nullptr && operand < operand_count(*instruction);
  return exists ? &instruction->operands[operand] : nullptr;
}

CursorPlace place_of_cursor(std::string_view text, std::size_t offset) {
  // What comes behind the cursor has nothing to say about what may be written at it.
  const std::size_t line_start = start_of_line(text, offset);
  const std::string_view before = text.substr(0, offset);
  SourceLine line;
  Lexer lexer(before, line_start);
  read_source_line(lexer, before, line);

  CursorPlace place;
  place.start = static_cast<std::uint32_t>(offset);
  if (is_in_comment(before, line, line_start, offset)) return place;
  const std::size_t count = line.token_count();
  const Token* const last = count == 0 ? nullptr : &line.token(count - 1);
  if (last != nullptr && last->kind == TokenKind::directive) return place_in_directive(before, *last);
  const bool is_written =
      last != nullptr && last->end() == offset && (last->kind == TokenKind::name || last->kind == TokenKind::number);
  if (is_written) place.start = last->offset;

  const std::size_t finished = is_written ? count - 1 : count;  // tokens before what is being written
  if (finished == 2 * line.statement.label_count) {
    // A number begins no statement.
    if (!is_written || last->kind == TokenKind::name) place.kind = Kind::statement;
    return place;
  }
  const Token& previous = line.token(finished - 1);
  const bool follows_value =
      previous.kind == TokenKind::name || previous.kind == TokenKind::number || previous.kind == TokenKind::close;
  const bool is_first = finished == line.first_operand_token;
  if (follows_value && !is_first) return place;
  const bool is_constant = line.roles[2 * line.statement.label_count] == TokenRole::constant;
  place.kind = is_constant ? Kind::expression : Kind::operand;
  place.instruction = line.instruction;
  place.operand = static_cast<std::size_t>(std::count_if(
      line.statement.tokens.begin(), line.statement.tokens.begin() + static_cast<std::ptrdiff_t>(finished),
      [](const Token& token) { return token.kind == TokenKind::comma; }));
  place.is_alone = is_first || previous.kind == TokenKind::comma;
  return place;
}

CompletionList completions(const CursorPlace& place, std::string_view written, FileId file, std::size_t offset,
                           const SymbolTable& symbols, const ModuleDescription& module) {
  Collection list(written, module);
  switch (place.kind) {
    case Kind::nothing:
    case Kind::file_name:
      break;
    case Kind::directive:
      list.add_directive();
      break;
    case Kind::statement:
      list.add_statements();
      break;
    case Kind::expression:
      list.add_symbols(symbols, file, offset, false);
      list.add_functions();
      break;
    case Kind::operand: {
      const OperandSpec* const operand = place.spec();
      if (operand == nullptr) break;
      if (place.is_alone) list.add_choices(operand->kind);
      // Names for numbers are allowed where a word belongs, but nobody wants to read them.
      if (takes_words(operand->kind)) break;
      list.add_symbols(symbols, file, offset, operand->kind == OperandKind::address);
      if (operand->field == Field::value && operand->kind != OperandKind::address) list.add_functions();
      break;
    }
  }
  return list.take();
}

}  // namespace opentmcl::lang
