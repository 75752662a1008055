#include "lang/switched_off.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "lang/diagnostic_kind.hpp"
#include "lang/lexer.hpp"
#include "lang/suggestion.hpp"
#include "lang/token.hpp"

namespace opentmcl::lang {
namespace {

/// What begins the list of names in a comment. All sources are searched for it, so it begins with a rare character.
constexpr std::string_view mark_end = "-warning:";
constexpr std::string_view mark_begin = "no";

constexpr std::string_view blanks_and_commas = " \t,";
constexpr std::string_view line_ends = "\r\n";

/// One comment that switches warnings off.
struct SwitchOff {
  std::size_t line = 0;      ///< offset of its line's first byte
  std::size_t line_end = 0;  ///< offset behind its line's last byte
  bool is_alone = false;
  DiagnosticKinds kinds;
};

std::size_t line_of(std::string_view text, std::size_t offset) {
  const std::size_t end = offset == 0 ? std::string_view::npos : text.find_last_of(line_ends, offset - 1);
  return end == std::string_view::npos ? 0 : end + 1;
}

/// Reads one file's comments. Of names that no warning has, and only of them, `unknown` is told.
template <typename Unknown>
std::vector<SwitchOff> read_switches(std::string_view text, const Unknown& unknown) {
  std::vector<SwitchOff> switches;
  Tokens tokens;
  std::size_t next = 0;
  for (std::size_t at = text.find(mark_end); at != std::string_view::npos; at = text.find(mark_end, next)) {
    next = at + 1;
    if (at < mark_begin.size() || text.substr(at - mark_begin.size(), mark_begin.size()) != mark_begin) continue;
    const std::size_t line = line_of(text, at);
    const std::size_t line_end = std::min(text.find_first_of(line_ends, at), text.size());
    next = line_end;  // one comment a line: no line is read twice, however long
    Lexer lexer(text, line);
    lexer.read_line(tokens);
    // The mark is the first thing the comment says.
    const std::size_t comment = tokens.back().offset;
    const std::size_t mark = at - mark_begin.size();
    if (comment > mark) continue;
    if (text.substr(comment, mark - comment).find_first_not_of("/; \t") != std::string_view::npos) continue;

    SwitchOff found{line, line_end, tokens.size() == 1, {}};
    std::size_t begin = at + mark_end.size();
    while ((begin = text.find_first_not_of(blanks_and_commas, begin)) < line_end) {
      const std::size_t end = std::min(text.find_first_of(blanks_and_commas, begin), line_end);
      const std::string_view name = text.substr(begin, end - begin);
      if (name == all_warnings_name) {
        found.kinds |= all_warnings();
      } else if (const std::optional<DiagnosticKind> kind = find_warning(name)) {
        found.kinds.set(index_of(*kind));
      } else {
        unknown(begin, name);
      }
      begin = end;
    }
    switches.push_back(found);
  }
  return switches;
}

/// What the comments of one file switch off.
class FileSwitches {
 public:
  explicit FileSwitches(std::string_view text) : switches_(read_switches(text, [](std::size_t, std::string_view) {})) {
    for (const SwitchOff& found : switches_) {
      if (found.is_alone) everywhere_ |= found.kinds;
    }
  }

  bool has(DiagnosticKind kind, std::size_t offset) const {
    if (switches_.empty()) return false;
    if (everywhere_[index_of(kind)]) return true;
    const auto next = std::upper_bound(switches_.begin(), switches_.end(), offset,
                                       [](std::size_t wanted, const SwitchOff& one) { return wanted < one.line; });
    if (next == switches_.begin()) return false;
    const SwitchOff& last_before = *std::prev(next);
    return offset <= last_before.line_end && last_before.kinds[index_of(kind)];
  }

 private:
  std::vector<SwitchOff> switches_;  // in the order of their lines
  DiagnosticKinds everywhere_;
};

}  // namespace

std::vector<Diagnostic> without_switched_off(std::vector<Diagnostic> diagnostics, const Sources& sources) {
  std::map<FileId, FileSwitches> files;
  const auto is_switched_off = [&](const Diagnostic& diagnostic) {
    if (severity_of(diagnostic.kind) == Severity::error) return false;
    const FileId file = diagnostic.span.file;
    auto found = files.find(file);
    if (found == files.end()) found = files.emplace(file, FileSwitches(sources[file].text)).first;
    return found->second.has(diagnostic.kind, diagnostic.span.offset);
  };
  diagnostics.erase(std::remove_if(diagnostics.begin(), diagnostics.end(), is_switched_off), diagnostics.end());
  return diagnostics;
}

void find_unknown_warnings(const Sources& sources, DiagnosticList& diagnostics) {
  for (FileId file = 0; file < sources.size(); ++file) {
    read_switches(sources[file].text, [&](std::size_t offset, std::string_view name) {
      const Span span{file, static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(name.size())};
      Suggestion suggestion(name);
      for (const DiagnosticKindSpec& row : diagnostic_kinds) {
        if (row.severity == Severity::warning && diagnostics.wants_suggestions()) suggestion.consider(row.name);
      }
      diagnostics.add(DiagnosticKind::unknown_warning, span, "there is no warning " + in_quotes(name),
                      suggestion.text(), {}, fix_of(suggestion, span));
    });
  }
}

}  // namespace opentmcl::lang
