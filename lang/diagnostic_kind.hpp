// Everything the assembler can complain about, as one table: what `tmcl asm --list-warnings` prints, what can be
// switched off by name, and what docs/diagnostics.md explains (a test holds the page to this table).
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace opentmcl::lang {

enum class Severity : std::uint8_t { error, warning };

enum class DiagnosticKind : std::uint8_t {
  // errors: there is no program
  not_text,
  unexpected_character,
  malformed_number,
  number_too_large,
  line_too_long,
  expected_statement,
  unknown_directive,
  missing_file_name,
  file_not_found,
  file_not_readable,
  file_too_large,
  include_cycle,
  too_many_includes,
  unknown_instruction,
  instruction_not_available,
  wrong_operand_count,
  expected_expression,
  unexpected_token,
  missing_parenthesis,
  unknown_function,
  undefined_name,
  used_before_definition,
  division_by_zero,
  undefined_result,
  expression_too_deep,
  invalid_word,
  not_encodable,
  duplicate_name,
  program_too_large,
  not_one_instruction,
  too_many_problems,
  // warnings: the module will not do what the source seems to say
  operand_out_of_range,
  no_such_motor,
  no_such_parameter,
  parameter_not_accessible,
  parameter_out_of_range,
  label_after_end,
  jump_outside_program,
  no_stop_at_end,
  unreachable_code,
  subroutines_nested_too_deep,
  recursive_subroutine,
  return_without_call,
  interrupt_without_return,
  interrupt_entered_directly,
  endless_wait_in_interrupt,
  stored_in_loop,
  unused_label,
  unused_constant,
  unknown_warning,
  too_many_warnings,
};

inline constexpr std::size_t diagnostic_kind_count = static_cast<std::size_t>(DiagnosticKind::too_many_warnings) + 1;

struct DiagnosticKindSpec {
  DiagnosticKind kind;
  const char* name;     ///< as a user types it, and the anchor of its section in docs/diagnostics.md
  Severity severity;    ///< unless warnings are to be errors
  const char* summary;  ///< one line, without a full stop
};

/// One row a kind, in the order of DiagnosticKind.
inline constexpr DiagnosticKindSpec diagnostic_kinds[diagnostic_kind_count] = {
    {DiagnosticKind::not_text, "not-text", Severity::error,
     "the file is UTF-16 or binary, not a source in UTF-8 or Latin-1"},
    {DiagnosticKind::unexpected_character, "unexpected-character", Severity::error,
     "a character that is none of the language"},
    {DiagnosticKind::malformed_number, "malformed-number", Severity::error,
     "something that begins as a number but is none"},
    {DiagnosticKind::number_too_large, "number-too-large", Severity::error, "a number too large to be represented"},
    {DiagnosticKind::line_too_long, "line-too-long", Severity::error, "a line with more code than any instruction has"},
    {DiagnosticKind::expected_statement, "expected-statement", Severity::error,
     "neither instruction, label, constant nor #include"},
    {DiagnosticKind::unknown_directive, "unknown-directive", Severity::error, "a directive other than #include"},
    {DiagnosticKind::missing_file_name, "missing-file-name", Severity::error, "#include without a file name"},
    {DiagnosticKind::file_not_found, "file-not-found", Severity::error, "an included file that is nowhere"},
    {DiagnosticKind::file_not_readable, "file-not-readable", Severity::error, "an included file that cannot be read"},
    {DiagnosticKind::file_too_large, "file-too-large", Severity::error, "sources larger than any program needs"},
    {DiagnosticKind::include_cycle, "include-cycle", Severity::error,
     "a file that includes itself, directly or through others"},
    {DiagnosticKind::too_many_includes, "too-many-includes", Severity::error,
     "included files nested too deep, or too many of them"},
    {DiagnosticKind::unknown_instruction, "unknown-instruction", Severity::error, "a mnemonic that no module has"},
    {DiagnosticKind::instruction_not_available, "instruction-not-available", Severity::error,
     "an instruction this module does not have"},
    {DiagnosticKind::wrong_operand_count, "wrong-operand-count", Severity::error, "too few or too many operands"},
    {DiagnosticKind::expected_expression, "expected-expression", Severity::error,
     "nothing, or something else, where a value belongs"},
    {DiagnosticKind::unexpected_token, "unexpected-token", Severity::error,
     "two values without an operator between them"},
    {DiagnosticKind::missing_parenthesis, "missing-parenthesis", Severity::error, "a parenthesis that is not closed"},
    {DiagnosticKind::unknown_function, "unknown-function", Severity::error, "a function the language does not have"},
    {DiagnosticKind::undefined_name, "undefined-name", Severity::error,
     "a name that is neither label, constant nor word"},
    {DiagnosticKind::used_before_definition, "used-before-definition", Severity::error,
     "a constant used above its definition"},
    {DiagnosticKind::division_by_zero, "division-by-zero", Severity::error, "an expression that divides by zero"},
    {DiagnosticKind::undefined_result, "undefined-result", Severity::error, "an expression without a finite value"},
    {DiagnosticKind::expression_too_deep, "expression-too-deep", Severity::error, "parentheses nested too deep"},
    {DiagnosticKind::invalid_word, "invalid-word", Severity::error,
     "a number that stands for none of an operand's words"},
    {DiagnosticKind::not_encodable, "not-encodable", Severity::error,
     "a value that does not fit the field of the instruction"},
    {DiagnosticKind::duplicate_name, "duplicate-name", Severity::error, "a name that is defined twice"},
    {DiagnosticKind::program_too_large, "program-too-large", Severity::error,
     "more instructions than the module holds"},
    {DiagnosticKind::not_one_instruction, "not-one-instruction", Severity::error,
     "something else where one instruction is expected"},
    {DiagnosticKind::too_many_problems, "too-many-problems", Severity::error, "more errors than are worth showing"},
    {DiagnosticKind::operand_out_of_range, "operand-out-of-range", Severity::warning,
     "an operand outside the range of its instruction"},
    {DiagnosticKind::no_such_motor, "no-such-motor", Severity::warning, "a motor the module does not have"},
    {DiagnosticKind::no_such_parameter, "no-such-parameter", Severity::warning,
     "a parameter or interrupt the module does not have"},
    {DiagnosticKind::parameter_not_accessible, "parameter-not-accessible", Severity::warning,
     "writing, reading or storing a parameter that does not allow it"},
    {DiagnosticKind::parameter_out_of_range, "parameter-out-of-range", Severity::warning,
     "a value the parameter does not take"},
    {DiagnosticKind::label_after_end, "label-after-end", Severity::warning, "a label that no instruction follows"},
    {DiagnosticKind::jump_outside_program, "jump-outside-program", Severity::warning,
     "a jump to an address where the program has nothing"},
    {DiagnosticKind::no_stop_at_end, "no-stop-at-end", Severity::warning,
     "a program that runs on behind its last instruction"},
    {DiagnosticKind::unreachable_code, "unreachable-code", Severity::warning, "instructions nothing can reach"},
    {DiagnosticKind::subroutines_nested_too_deep, "subroutines-nested-too-deep", Severity::warning,
     "a call that is ignored because the stack of subroutine calls is full"},
    {DiagnosticKind::recursive_subroutine, "recursive-subroutine", Severity::warning,
     "a subroutine that is called again before it returns"},
    {DiagnosticKind::return_without_call, "return-without-call", Severity::warning,
     "RSUB or RETI where nothing was called"},
    {DiagnosticKind::interrupt_without_return, "interrupt-without-return", Severity::warning,
     "an interrupt routine without RETI"},
    {DiagnosticKind::interrupt_entered_directly, "interrupt-entered-directly", Severity::warning,
     "the program runs or jumps into an interrupt routine"},
    {DiagnosticKind::endless_wait_in_interrupt, "endless-wait-in-interrupt", Severity::warning,
     "WAIT without a time limit in an interrupt routine"},
    {DiagnosticKind::stored_in_loop, "stored-in-loop", Severity::warning,
     "a loop that writes to the EEPROM, which wears out"},
    {DiagnosticKind::unused_label, "unused-label", Severity::warning, "a label nothing refers to"},
    {DiagnosticKind::unused_constant, "unused-constant", Severity::warning, "a constant nothing refers to"},
    {DiagnosticKind::unknown_warning, "unknown-warning", Severity::warning,
     "a comment that switches off a warning that does not exist"},
    {DiagnosticKind::too_many_warnings, "too-many-warnings", Severity::warning, "more warnings than are worth showing"},
};

constexpr std::size_t index_of(DiagnosticKind kind) {
  return static_cast<std::size_t>(kind);
}

/// Kinds up to `too_many_problems` are errors.
constexpr Severity severity_of(DiagnosticKind kind) {
  return kind <= DiagnosticKind::too_many_problems ? Severity::error : Severity::warning;
}

consteval bool diagnostic_kinds_are_consistent() {
  for (std::size_t i = 0; i < diagnostic_kind_count; ++i) {
    const DiagnosticKindSpec& row = diagnostic_kinds[i];
    if (index_of(row.kind) != i || row.severity != severity_of(row.kind)) return false;
  }
  return true;
}
static_assert(diagnostic_kinds_are_consistent(), "one row a kind, in the order of the kinds, errors before warnings");

/// The kind's name as a user types it: "undefined-name".
const char* name_of(DiagnosticKind kind);

/// The warning of this name, or nothing: errors cannot be switched off.
std::optional<DiagnosticKind> find_warning(std::string_view name);

/// The word that stands for all warnings where names of warnings are expected.
inline constexpr std::string_view all_warnings_name = "all";

/// A set of kinds; bit `index_of(kind)`.
using DiagnosticKinds = std::bitset<diagnostic_kind_count>;

/// All warnings.
DiagnosticKinds all_warnings();

}  // namespace opentmcl::lang
