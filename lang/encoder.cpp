#include "lang/encoder.hpp"

#include <cmath>
#include <cstddef>
#include <string>

#include "firmware/spec/parameter_rows.hpp"
#include "lang/command_check.hpp"
#include "lang/instruction_table.hpp"
#include "lang/operand_field.hpp"
#include "lang/suggestion.hpp"

namespace opentmcl::lang {
namespace {

/// With more names than this none is suggested for a wrong one: comparing would take longer than assembling.
constexpr std::size_t maximum_suggested_names = 5000;

/// Halves away from zero. Nearly all operands are small whole numbers already.
double nearest_integer(double number) {
  const bool is_small = number >= int32_minimum && number <= int32_maximum;
  if (is_small && static_cast<double>(static_cast<std::int32_t>(number)) == number) return number;
  return std::round(number);
}

bool fits(Field field, double whole) {
  return field == Field::value ? whole >= int32_minimum && whole <= int32_maximum : whole >= 0 && whole <= 255;
}

/// "GAP takes 2 operands"
std::string takes(const InstructionSpec& instruction) {
  const std::size_t count = operand_count(instruction);
  return std::string(instruction.mnemonic) + " takes " + (count == 0 ? "no" : std::to_string(count)) +
         (count == 1 ? " operand" : " operands");
}

std::string list_of(const KeywordSet& set) {
  std::string list;
  for (std::size_t i = 0; i < set.count; ++i) {
    if (set.words[i].value == set.excluded) continue;
    if (!list.empty()) list += ", ";
    list += set.words[i].word;
  }
  return list;
}

}  // namespace

Encoding InstructionEncoder::encode(const InstructionSpec& instruction, const Statement& statement, const Scope& scope,
                                    Pass pass, Command& command) {
  const std::size_t written = statement.operands.size();
  const std::size_t expected = operand_count(instruction);
  const bool too_few = written < expected && !operands_are_optional(instruction);
  if (too_few || written > expected + 1) return report_count(instruction, statement, scope);
  const std::size_t reported = diagnostics_->size();
  command = {static_cast<std::uint8_t>(instruction.opcode), 0, 0, 0};
  Encoding encoding = Encoding::done;
  for (std::size_t i = 0; i < written; ++i) {
    const TokenRange range = statement.operands[i];
    const Encoding operand = i < expected ? encode_operand(instruction.operands[i], range, scope, pass, command)
                                          : check_surplus(instruction, range, scope, pass);
    if (operand == Encoding::undefined_names) {
      diagnostics_->rewind(reported);  // said again, and in full, when the names are known
      return operand;
    }
    if (operand == Encoding::failed) encoding = operand;
  }
  if (encoding == Encoding::done) check_command(instruction, command, *module_, statement, scope, *diagnostics_);
  return encoding;
}

Encoding InstructionEncoder::encode_operand(const OperandSpec& operand, TokenRange range, const Scope& scope, Pass pass,
                                            Command& command) {
  const Token& first = *range.first;
  double number = first.number;
  if (range.size() != 1 || first.kind != TokenKind::number) {
    if (range.size() == 1 && first.kind == TokenKind::name && takes_words(operand.kind)) {
      const int word = find_packed_word(operand.kind, first.packed);
      if (word >= 0) {
        set_operand_value(command, operand, word);
        return Encoding::done;
      }
    }
    const Encoding found = find_value(range, scope, pass, operand.kind, number);
    if (found != Encoding::done) return found;
  }
  const double rounded = nearest_integer(number);
  if (!fits(operand.field, rounded)) return report_not_encodable(operand.field, range, scope);
  const auto value = static_cast<std::int32_t>(rounded);
  if (takes_words(operand.kind) && word_of(operand.kind, value) == nullptr) {
    return report_no_word(operand.kind, value, range, scope);
  }
  set_operand_value(command, operand, value);
  return Encoding::done;
}

Encoding InstructionEncoder::report_count(const InstructionSpec& instruction, const Statement& statement,
                                          const Scope& scope) {
  diagnostics_->add(DiagnosticKind::wrong_operand_count, scope.span_of(statement.name),
                    takes(instruction) + ", not " + std::to_string(statement.operands.size()));
  return Encoding::failed;
}

Encoding InstructionEncoder::report_not_encodable(Field field, TokenRange range, const Scope& scope) {
  diagnostics_->add(DiagnosticKind::not_encodable, scope.span_of(range),
                    field == Field::value ? "the value does not fit 32 bits (-2147483648...2147483647)"
                                          : "the value does not fit 8 bits (0...255)");
  return Encoding::failed;
}

Encoding InstructionEncoder::report_no_word(OperandKind kind, std::int32_t value, TokenRange range,
                                            const Scope& scope) {
  diagnostics_->add(DiagnosticKind::invalid_word, scope.span_of(range),
                    std::to_string(value) + " stands for nothing here", "possible: " + list_of(keywords_of(kind)));
  return Encoding::failed;
}

Encoding InstructionEncoder::check_surplus(const InstructionSpec& instruction, TokenRange range, const Scope& scope,
                                           Pass pass) {
  double number = 0;
  const Encoding found = find_value(range, scope, pass, OperandKind::none, number);
  if (found != Encoding::done || number == 0) return found;
  diagnostics_->add(DiagnosticKind::wrong_operand_count, scope.span_of(range),
                    takes(instruction) + "; a surplus one must be 0");
  return Encoding::failed;
}

Encoding InstructionEncoder::find_value(TokenRange range, const Scope& scope, Pass pass, OperandKind kind,
                                        double& number) {
  const Evaluation evaluation = evaluate(range, scope, *diagnostics_);
  number = evaluation.value;
  switch (evaluation.state) {
    case Evaluation::State::value:
      return Encoding::done;
    case Evaluation::State::failed:
      return Encoding::failed;
    case Evaluation::State::undefined:
      break;
  }
  if (pass == Pass::reading) return Encoding::undefined_names;
  const Token& name = *find_undefined_name(range, scope);
  report_undefined_name(scope.span_of(name), name.text(scope.text), *scope.symbols, keywords_of(kind), *diagnostics_);
  return Encoding::failed;
}

void report_undefined_name(Span span, std::string_view name, const SymbolTable& symbols, const KeywordSet& words,
                           DiagnosticList& diagnostics) {
  Suggestion suggestion(name);
  for (std::size_t i = 0; i < words.count; ++i) {
    if (words.words[i].value != words.excluded) suggestion.consider(words.words[i].word);
  }
  if (symbols.symbols().size() <= maximum_suggested_names && diagnostics.wants_suggestions()) {
    for (const Symbol& symbol : symbols.symbols()) suggestion.consider(symbol.name);
  }
  diagnostics.add(DiagnosticKind::undefined_name, span, in_quotes(name) + " is not defined", suggestion.text(), {},
                  fix_of(suggestion, span));
}

}  // namespace opentmcl::lang
