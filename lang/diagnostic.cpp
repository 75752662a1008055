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

/// Escape sequences of terminals: bold, and the colours compilers use.
struct Palette {
  const char* place = "";
  const char* error = "";
  const char* warning = "";
  const char* note = "";
  const char* message = "";
  const char* carets = "";
  const char* end = "";
};

constexpr Palette terminal_palette{"\033[1m", "\033[1;31m", "\033[1;35m", "\033[1;36m",
                                   "\033[1m", "\033[1;32m", "\033[0m"};

class Formatter {
 public:
  Formatter(const Sources& sources, FormatStyle style)
      : sources_(&sources), lines_(sources), palette_(style.colours ? terminal_palette : Palette{}) {}

  std::string format(const Diagnostic& diagnostic) {
    const bool is_error = diagnostic.severity() == Severity::error;
    const bool is_named = severity_of(diagnostic.kind) == Severity::warning;
    std::string name;
    if (is_named) name.append(" [").append(name_of(diagnostic.kind)).append("]");
    std::string result =
        at(diagnostic.span, is_error ? "error: " : "warning: ", is_error ? palette_.error : palette_.warning,
           diagnostic.message, name);
    if (diagnostic.related) {
      result += at(*diagnostic.related, "note: ", palette_.note, diagnostic.note, {});
    } else if (!diagnostic.note.empty()) {
      result += coloured(palette_.note, "note: ") + diagnostic.note + "\n";
    }
    return result;
  }

 private:
  /// The line with place and message, and the excerpt below it.
  std::string at(Span span, const char* word, const char* colour, const std::string& message, const std::string& name) {
    const LineIndex& index = lines_.of(span.file);
    const Position position = index.position_of(span.offset);
    const std::string place = printable((*sources_)[span.file].name) + ":" + std::to_string(position.line) + ":" +
                              std::to_string(position.column) + ": ";
    std::string result = coloured(palette_.place, place);
    result += coloured(colour, word);
    result += coloured(palette_.message, message);
    result += name + "\n" + excerpt(span, index, position);
    return result;
  }

  std::string coloured(const char* colour, const std::string& text) const {
    return std::string(colour).append(text).append(palette_.end);
  }

  /// The source line and the line of carets.
  std::string excerpt(Span span, const LineIndex& lines, const Position& position) const {
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
    std::string carets(std::max<std::size_t>(characters(marked), 1), '~');
    carets.front() = '^';
    result.append(blanks(left)).append(blanks(before)).append(coloured(palette_.carets, carets)).append("\n");
    return result;
  }

  const Sources* sources_;
  Lines lines_;
  Palette palette_;
};

}  // namespace

DiagnosticCounts count(const std::vector<Diagnostic>& diagnostics) {
  DiagnosticCounts counts;
  for (const Diagnostic& diagnostic : diagnostics) {
    ++(diagnostic.severity() == Severity::error ? counts.errors : counts.warnings);
  }
  return counts;
}

std::string summary(const DiagnosticCounts& counts) {
  const auto counted = [](std::size_t number, const char* what) {
    return number == 0 ? std::string() : std::to_string(number) + " " + what + (number == 1 ? "" : "s");
  };
  const std::string errors = counted(counts.errors, "error");
  const std::string warnings = counted(counts.warnings, "warning");
  return errors + (errors.empty() || warnings.empty() ? "" : ", ") + warnings;
}

void DiagnosticList::add(DiagnosticKind kind, Span span, std::string message, std::string note,
                         std::optional<Span> related, std::optional<Fix> fix) {
  if (switched_off_[index_of(kind)]) return;
  const Severity severity = severity_of(kind);
  std::size_t& count = count_[static_cast<std::size_t>(severity)];
  if (count > maximum_count) return;
  ++count;
  if (count <= maximum_count) {
    diagnostics_.push_back({kind, span, std::move(message), std::move(note), related, std::move(fix)});
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

std::string format(const Diagnostic& diagnostic, const Sources& sources, FormatStyle style) {
  return Formatter(sources, style).format(diagnostic);
}

std::string format(const std::vector<Diagnostic>& diagnostics, const Sources& sources, FormatStyle style) {
  Formatter formatter(sources, style);
  std::string result;
  for (const Diagnostic& diagnostic : diagnostics) result += formatter.format(diagnostic);
  return result;
}

}  // namespace opentmcl::lang
