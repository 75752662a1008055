#include "apps/tmcl/unified_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "lang/source.hpp"

namespace opentmcl::app {

using lang::LineEdit;

namespace {

constexpr std::size_t context = 3;  // lines

using Edits = std::vector<LineEdit>::const_iterator;

std::size_t count_lines(std::string_view text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void append_lines(std::string& hunk, char sign, std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    hunk += sign;
    hunk += text.substr(0, end);
    if (text[end - 1] != '\n') hunk += "\n\\ No newline at end of file\n";
    text.remove_prefix(end);
  }
}

/// Lines are those of the diff, which ends them at LF alone.
class DiffWriter {
 public:
  explicit DiffWriter(std::string_view source) : source_(source), lines_(source) {
    line_count_ = lines_.start_of(lines_.line_count()) == source.size() ? lines_.line_count() - 1 : lines_.line_count();
  }

  /// One hunk for the edits [first, last), which are close to each other.
  std::string hunk(Edits first, Edits last) {
    const std::size_t begin = first->line > context ? first->line - context : 1;
    const std::size_t end = std::min(std::prev(last)->line + context, line_count_);
    std::string text;
    std::size_t count_after = 0;
    auto edit = first;
    for (std::size_t line = begin; line <= end; ++line) {
      if (edit == last || edit->line != line) {
        append_lines(text, ' ', whole_line(line));
        ++count_after;
        continue;
      }
      // All that goes before all that comes, as far as changed lines follow each other.
      std::string coming;
      for (; edit != last && edit->line == line; ++edit, ++line) {
        append_lines(text, '-', whole_line(line));
        coming += edit->text;
      }
      --line;
      append_lines(text, '+', coming);
      count_after += count_lines(coming);
    }
    const std::size_t count_before = end - begin + 1;
    const auto begin_after = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(begin) + lines_added_);
    lines_added_ += static_cast<std::ptrdiff_t>(count_after) - static_cast<std::ptrdiff_t>(count_before);
    return fmt::format("@@ -{},{} +{},{} @@\n{}", begin, count_before, count_after == 0 ? begin_after - 1 : begin_after,
                       count_after, text);
  }

 private:
  std::string_view whole_line(std::size_t line) const {
    const std::size_t end = line < lines_.line_count() ? lines_.start_of(line + 1) : source_.size();
    return source_.substr(lines_.start_of(line), end - lines_.start_of(line));
  }

  std::string_view source_;
  lang::LineIndex lines_;
  std::size_t line_count_;
  std::ptrdiff_t lines_added_ = 0;  ///< by the hunks so far
};

}  // namespace

std::string unified_diff(std::string_view path, std::string_view source, const std::vector<LineEdit>& edits) {
  if (edits.empty()) return {};
  std::string diff = fmt::format("--- a/{0}\n+++ b/{0}\n", path);
  DiffWriter writer(source);
  for (auto first = edits.begin(); first != edits.end();) {
    auto last = std::next(first);
    while (last != edits.end() && last->line <= std::prev(last)->line + 2 * context + 1) ++last;
    diff += writer.hunk(first, last);
    first = last;
  }
  return diff;
}

}  // namespace opentmcl::app
