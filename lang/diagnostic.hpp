// What is wrong with a source, where, and what to do about it. Errors are values: nothing in lang/ throws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lang/source.hpp"

namespace opentmcl::lang {

enum class Severity : std::uint8_t { error, warning };

enum class DiagnosticKind : std::uint8_t {
  // errors: there is no program
  unexpected_character,
  malformed_number,
  number_too_large,
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
  too_many_warnings,
};

/// The kind's name as a user types it: "undefined-name".
const char* name_of(DiagnosticKind kind);

/// Kinds up to `too_many_problems` are errors.
Severity severity_of(DiagnosticKind kind);

struct Diagnostic {
  DiagnosticKind kind;
  Span span;
  std::string message;
  std::string note;             ///< a hint, or what `related` shows; empty for none
  std::optional<Span> related;  ///< the other place the message speaks of

  Severity severity() const { return severity_of(kind); }
};

/// The diagnostics of one run: at most `maximum_count` errors and as many warnings, and one that says so if there are
/// more.
class DiagnosticList {
 public:
  static constexpr std::size_t maximum_count = 10000;

  void add(DiagnosticKind kind, Span span, std::string message, std::string note = {},
           std::optional<Span> related = {});

  std::size_t size() const { return diagnostics_.size(); }
  /// Forgets the diagnostics added since there were `size` of them.
  void rewind(std::size_t size);
  bool has_errors() const { return count_[static_cast<std::size_t>(Severity::error)] > 0; }
  /// In the order of the files and of the places in them.
  std::vector<Diagnostic> take_sorted();

 private:
  std::vector<Diagnostic> diagnostics_;
  std::size_t count_[2] = {};  // by severity
};

/// A piece of a source as messages show it: between ' and ', without control characters, and not all of it if it is
/// long.
std::string in_quotes(std::string_view text);

/// `file:line:column: error: message`, the source line, and a line with ~ under the span. A tab in the source is a tab
/// in both lines, so that they align; a very long line is shown in part.
std::string format(const Diagnostic& diagnostic, const Sources& sources);
std::string format(const std::vector<Diagnostic>& diagnostics, const Sources& sources);

}  // namespace opentmcl::lang
