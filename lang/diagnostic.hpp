// What is wrong with a source, where, and what to do about it. Errors are values: nothing in lang/ throws.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lang/diagnostic_kind.hpp"
#include "lang/source.hpp"

namespace opentmcl::lang {

/// A change of the source that mends what a diagnostic complains about, for editors to offer.
struct Fix {
  Span span;  ///< what is replaced; empty where something is missing
  std::string replacement;
  std::string title;  ///< as a menu shows it: "change to MVP"
};

struct Diagnostic {
  DiagnosticKind kind;
  Span span;
  std::string message;
  std::string note;             ///< a hint, or what `related` shows; empty for none
  std::optional<Span> related;  ///< the other place the message speaks of
  std::optional<Fix> fix = {};
  bool is_warning_as_error = false;  ///< a warning, which the user wants to be an error

  Severity severity() const { return is_warning_as_error ? Severity::error : severity_of(kind); }
};

struct DiagnosticCounts {
  std::size_t errors = 0;
  std::size_t warnings = 0;
};

DiagnosticCounts count(const std::vector<Diagnostic>& diagnostics);

/// "2 errors, 1 warning"; empty if there is nothing to count.
std::string summary(const DiagnosticCounts& counts);

/// The diagnostics of one run: at most `maximum_count` errors and as many warnings, and one that says so if there are
/// more. Warnings that are switched off are not among them.
class DiagnosticList {
 public:
  static constexpr std::size_t maximum_count = 10000;
  /// Names are suggested for so many diagnostics: comparing names takes longer than all else.
  static constexpr std::size_t maximum_suggestions = 100;

  explicit DiagnosticList(const DiagnosticKinds& switched_off = {}) : switched_off_(switched_off) {}

  void add(DiagnosticKind kind, Span span, std::string message, std::string note = {}, std::optional<Span> related = {},
           std::optional<Fix> fix = {});

  std::size_t size() const { return diagnostics_.size(); }
  /// Forgets the diagnostics added since there were `size` of them.
  void rewind(std::size_t size);
  bool wants_suggestions() const { return diagnostics_.size() < maximum_suggestions; }
  bool has_errors() const { return count_[static_cast<std::size_t>(Severity::error)] > 0; }
  /// In the order of the files and of the places in them.
  std::vector<Diagnostic> take_sorted();

 private:
  std::vector<Diagnostic> diagnostics_;
  std::size_t count_[2] = {};  // by severity
  DiagnosticKinds switched_off_;
};

/// A piece of a source as messages show it: between ' and ', without control characters, and not all of it if it is
/// long.
std::string in_quotes(std::string_view text);

struct FormatStyle {
  bool colours = false;  ///< escape sequences for a terminal
};

/// `file:line:column: error: message`, the source line, and a line with ~ under the span. A tab in the source is a tab
/// in both lines, so that they align; a very long line is shown in part. Warnings end with their name in brackets.
std::string format(const Diagnostic& diagnostic, const Sources& sources, FormatStyle style = {});
std::string format(const std::vector<Diagnostic>& diagnostics, const Sources& sources, FormatStyle style = {});

}  // namespace opentmcl::lang
