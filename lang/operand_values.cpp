#include "lang/operand_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "firmware/spec/parameter_rows.hpp"
#include "lang/diagnostic.hpp"
#include "lang/expression.hpp"
#include "lang/instruction_table.hpp"
#include "lang/operand_field.hpp"

namespace opentmcl::lang {
namespace {

std::optional<std::int32_t> value_of(TokenRange range, OperandKind kind, const Scope& scope) {
  if (range.size() == 1 && range.first->kind == TokenKind::name && takes_words(kind)) {
    const int word = find_packed_word(kind, range.first->packed);
    if (word >= 0) return word;
  }
  DiagnosticList unheard;
  const Evaluation evaluation = evaluate(range, scope, unheard);
  const double rounded = std::round(evaluation.value);
  const bool fits = rounded >= int32_minimum && rounded <= int32_maximum;
  if (evaluation.state != Evaluation::State::value || !fits) return std::nullopt;
  return static_cast<std::int32_t>(rounded);
}

/// False for a value that does not fit the field.
bool store(const OperandSpec& operand, std::int32_t value, Command& command) {
  if (operand.field != Field::value && (value < 0 || value > 255)) return false;
  set_operand_value(command, operand, value);
  return true;
}

}  // namespace

OperandValues operand_values(const SourceLine& line, std::string_view text, FileId file, SymbolTable& symbols) {
  OperandValues values;
  values.command.opcode = static_cast<std::uint8_t>(line.instruction->opcode);
  Scope scope;
  scope.file = file;
  scope.text = text;
  scope.symbols = &symbols;
  scope.visible_constants = symbols.symbols().size();
  const std::size_t count = std::min(operand_count(*line.instruction), line.statement.operands.size());
  for (std::size_t i = 0; i < count; ++i) {
    const OperandSpec& operand = line.instruction->operands[i];
    const std::optional<std::int32_t> value = value_of(line.statement.operands[i], operand.kind, scope);
    values.is_known[i] = value.has_value() && store(operand, *value, values.command);
  }
  return values;
}

}  // namespace opentmcl::lang
