#include "lang/diagnostic.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace opentmcl::lang {
namespace {

constexpr std::size_t shown_line_length = 240;
constexpr std::size_t shown_before_span = 100;
constexpr std::size_t shown_text_length = 60;

/// One LineIndex for each file that has something to show.
class Lines {
 public:
  explicit Lines(const Sources& sources) : sources_(&sources) {}

  const LineIndex& of(FileId file) {
    const auto found = indices_.find(file);
    if (found != indices_.end()) return found->second;
    return indices_.emplace(file, LineIndex((*sources_)[file].text)).first->second;
  }

 private:
  const Sources* sources_;
  std::map<FileId, LineIndex> indices_;
};

/// What a terminal shows instead of a control character.
std::string printable(std::string_view text) {
  std::string result = to_utf8(text);
  for (char& c : result) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\t') || byte == 0x7F) c = '?';
  }
  return result;
}

bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// As many blanks as `text` is wide, tabs kept.
std::string blanks(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (!is_continuation(c)) result += c == '\t' ? '\t' : ' ';
  }
  return result;
}

std::size_t characters(std::string_view utf8) {
  const auto continuations = std::count_if(utf8.begin(), utf8.end(), is_continuation);
  return utf8.size() - static_cast<std::size_t>(continuations);
}

/// The source line and the line of carets.
std::string excerpt(Span span, const LineIndex& lines, const Position& position) {
  const std::string_view line = lines.line(position.line);
  const std::size_t from = std::min<std::size_t>(span.offset - lines.start_of(position.line), line.size());
  std::size_t begin = 0;
  std::size_t end = line.size();
  if (line.size() > shown_line_length) {
    begin = from > shown_before_span ? from - shown_before_span : 0;
    while (begin < from && is_continuation(line[begin])) ++begin;
    end = std::max(from, std::min(line.size(), begin + shown_line_length));
  }
  const std::size_t to = std::min<std::size_t>(from + span.length, end);
  const std::string before = printable(line.substr(begin, from - begin));
  const std::string marked = printable(line.substr(from, to - from));
  const std::string after = printable(line.substr(to, end - to));
  const std::string_view left = begin > 0 ? "..." : "";
  const std::string_view right = end < line.size() ? "..." : "";
  std::string result;
  result.append(left).append(before).append(marked).append(after).append(right).append("\n");
  result.append(blanks(left)).append(blanks(before)).append("^");
  result.append(std::max<std::size_t>(characters(marked), 1) - 1, '~').append("\n");
  return result;
}

std::string heading(const Sources& sources, Span span, const Position& position) {
  return printable(sources[span.file].name) + ":" + std::to_string(position.line) + ":" +
         std::to_string(position.column) + ": ";
}

std::string format(const Diagnostic& diagnostic, const Sources& sources, Lines& lines) {
  const LineIndex& index = lines.of(diagnostic.span.file);
  const Position position = index.position_of(diagnostic.span.offset);
  std::string result = heading(sources, diagnostic.span, position);
  if (diagnostic.severity() == Severity::error) {
    result += "error: " + diagnostic.message;
  } else {
    result += "warning: " + diagnostic.message + " [" + name_of(diagnostic.kind) + "]";
  }
  result += '\n';
  result += excerpt(diagnostic.span, index, position);
  if (diagnostic.related) {
    const LineIndex& related_index = lines.of(diagnostic.related->file);
    const Position related = related_index.position_of(diagnostic.related->offset);
    result += heading(sources, *diagnostic.related, related) + "note: " + diagnostic.note + "\n" +
              excerpt(*diagnostic.related, related_index, related);
  } else if (!diagnostic.note.empty()) {
    result += "note: " + diagnostic.note + "\n";
  }
  return result;
}

}  // namespace

const char* name_of(DiagnosticKind kind) {
  switch (kind) {
    case DiagnosticKind::unexpected_character:
      return "unexpected-character";
    case DiagnosticKind::malformed_number:
      return "malformed-number";
    case DiagnosticKind::number_too_large:
      return "number-too-large";
    case DiagnosticKind::expected_statement:
      return "expected-statement";
    case DiagnosticKind::unknown_directive:
      return "unknown-directive";
    case DiagnosticKind::missing_file_name:
      return "missing-file-name";
    case DiagnosticKind::file_not_found:
      return "file-not-found";
    case DiagnosticKind::file_not_readable:
      return "file-not-readable";
    case DiagnosticKind::file_too_large:
      return "file-too-large";
    case DiagnosticKind::include_cycle:
      return "include-cycle";
    case DiagnosticKind::too_many_includes:
      return "too-many-includes";
    case DiagnosticKind::unknown_instruction:
      return "unknown-instruction";
    case DiagnosticKind::instruction_not_available:
      return "instruction-not-available";
    case DiagnosticKind::wrong_operand_count:
      return "wrong-operand-count";
    case DiagnosticKind::expected_expression:
      return "expected-expression";
    case DiagnosticKind::unexpected_token:
      return "unexpected-token";
    case DiagnosticKind::missing_parenthesis:
      return "missing-parenthesis";
    case DiagnosticKind::unknown_function:
      return "unknown-function";
    case DiagnosticKind::undefined_name:
      return "undefined-name";
    case DiagnosticKind::used_before_definition:
      return "used-before-definition";
    case DiagnosticKind::division_by_zero:
      return "division-by-zero";
    case DiagnosticKind::undefined_result:
      return "undefined-result";
    case DiagnosticKind::expression_too_deep:
      return "expression-too-deep";
    case DiagnosticKind::invalid_word:
      return "invalid-word";
    case DiagnosticKind::not_encodable:
      return "not-encodable";
    case DiagnosticKind::duplicate_name:
      return "duplicate-name";
    case DiagnosticKind::program_too_large:
      return "program-too-large";
    case DiagnosticKind::not_one_instruction:
      return "not-one-instruction";
    case DiagnosticKind::too_many_problems:
      return "too-many-problems";
    case DiagnosticKind::operand_out_of_range:
      return "operand-out-of-range";
    case DiagnosticKind::no_such_motor:
      return "no-such-motor";
    case DiagnosticKind::no_such_parameter:
      return "no-such-parameter";
    case DiagnosticKind::parameter_not_accessible:
      return "parameter-not-accessible";
    case DiagnosticKind::parameter_out_of_range:
      return "parameter-out-of-range";
    case DiagnosticKind::label_after_end:
      return "label-after-end";
    case DiagnosticKind::too_many_warnings:
      return "too-many-warnings";
  }
  return "";
}

Severity severity_of(DiagnosticKind kind) {
  return kind <= DiagnosticKind::too_many_problems ? Severity::error : Severity::warning;
}

void DiagnosticList::add(DiagnosticKind kind, Span span, std::string message, std::string note,
                         std::optional<Span> related) {
  const Severity severity = severity_of(kind);
  std::size_t& count = count_[static_cast<std::size_t>(severity)];
  if (count > maximum_count) return;
  ++count;
  if (count <= maximum_count) {
    diagnostics_.push_back({kind, span, std::move(message), std::move(note), related});
  } else if (severity == Severity::error) {
    diagnostics_.push_back({DiagnosticKind::too_many_problems, span, "too many errors; the rest is not shown", {}, {}});
  } else {
    diagnostics_.push_back(
        {DiagnosticKind::too_many_warnings, span, "too many warnings; the rest is not shown", {}, {}});
  }
}

void DiagnosticList::rewind(std::size_t size) {
  while (diagnostics_.size() > size) {
    --count_[static_cast<std::size_t>(diagnostics_.back().severity())];
    diagnostics_.pop_back();
  }
}

std::vector<Diagnostic> DiagnosticList::take_sorted() {
  const auto key = [](const Diagnostic& diagnostic) {
    const bool last =
        diagnostic.kind == DiagnosticKind::too_many_problems || diagnostic.kind == DiagnosticKind::too_many_warnings;
    return std::tuple(last, diagnostic.span.file, diagnostic.span.offset);
  };
  std::stable_sort(diagnostics_.begin(), diagnostics_.end(),
                   [&](const Diagnostic& left, const Diagnostic& right) { return key(left) < key(right); });
  return std::move(diagnostics_);
}

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  result += printable(text.substr(0, shown_text_length));
  result += text.size() > shown_text_length ? "...'" : "'";
  return result;
}

std::string format(const Diagnostic& diagnostic, const Sources& sources) {
  Lines lines(sources);
  return format(diagnostic, sources, lines);
}

std::string format(const std::vector<Diagnostic>& diagnostics, const Sources& sources) {
  Lines lines(sources);
  std::string result;
  for (const Diagnostic& diagnostic : diagnostics) result += format(diagnostic, sources, lines);
  return result;
}

}  // namespace opentmcl::lang
