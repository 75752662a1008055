#include "lang/formatter.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "lang/lexer.hpp"
#include "lang/source.hpp"
#include "lang/statement.hpp"
#include "lang/statement_text.hpp"

namespace opentmcl::lang {
namespace {

constexpr std::size_t indentation = 4;
/// Where comments behind code begin, unless code of their block is too long.
constexpr std::size_t comment_column = 28;
/// Blanks between code and comment, at least.
constexpr std::size_t comment_distance = 2;
/// Columns of code and names of constants that others are aligned to. A line of a megabyte must not widen a thousand
/// more.
constexpr std::size_t longest_aligned_code = 80;
constexpr std::size_t tab_width = 8;

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

enum class LineKind : std::uint8_t {
  blank,
  code,
  constant,
  comment,       ///< alone on its line
  continuation,  ///< alone on its line, below a comment behind code
  untouched,
};

struct FormattedLine {
  LineKind kind = LineKind::blank;
  std::size_t source_line = 0;  ///< counts from 1
  std::string code;             ///< with its indentation; of a constant its value
  std::string name;             ///< of a constant
  std::string comment;
  bool is_long = false;  ///< not aligned, nor are others to it

  bool is_constant() const { return kind == LineKind::constant; }
};

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Characters, not bytes.
std::size_t width_of(std::string_view utf8) {
  return utf8.size() - static_cast<std::size_t>(std::count_if(utf8.begin(), utf8.end(), continues_character));
}

/// Where the character at `offset` stands on a screen; counts from 0.
std::size_t column_of(std::string_view line, std::size_t offset) {
  std::size_t column = 0;
  for (const char c : line.substr(0, offset)) {
    if (c == '\t') {
      column += tab_width - column % tab_width;
    } else if (!continues_character(c)) {
      ++column;
    }
  }
  return column;
}

std::string_view without_trailing_blanks(std::string_view text) {
  return text.substr(0, text.find_last_not_of(" \t\v\f") + 1);
}

/// Takes the lines of a source apart and gives each its normal form, not yet aligned to others.
class LineFormatter {
 public:
  explicit LineFormatter(std::string_view text) : text_(text), index_(text), lexer_(text) {}

  std::vector<FormattedLine> run() {
    while (!lexer_.at_end()) {
      ++line_;
      read_statement(lexer_, statement_);
      format_line();
    }
    return std::move(lines_);
  }

 private:
  void format_line() {
    std::size_t start = index_.start_of(line_);
    const std::size_t length = index_.line(line_).size();
    std::string_view written = text_.substr(start, length);
    if (line_ == 1 && written.substr(0, byte_order_mark.size()) == byte_order_mark) {
      written.remove_prefix(byte_order_mark.size());
      start += byte_order_mark.size();
    }
    const std::size_t code_end = statement_.tokens.back().offset - start;
    const std::string_view comment = without_trailing_blanks(written.substr(code_end));
    std::optional<std::string> code = statement_text(statement_, text_);
    if (!code) {
      add(LineKind::untouched, std::string(written));
      end_of_commented_code_.reset();
    } else if (statement_.tokens.size() == 1) {
      add_comment_or_blank(written, code_end, comment);
    } else {
      add_code(*std::move(code));
      FormattedLine& line = lines_.back();
      line.comment = comment;
      line.is_long = line.name.size() + width_of(line.code) > longest_aligned_code;
      end_of_commented_code_.reset();
      if (!comment.empty() && !line.is_long) {
        end_of_commented_code_ = column_of(written, statement_.tokens.rbegin()[1].end() - start);
      }
    }
  }

  void add_comment_or_blank(std::string_view written, std::size_t offset, std::string_view comment) {
    const std::size_t column = column_of(written, offset);
    if (comment.empty()) {
      add(LineKind::blank, "");
      end_of_commented_code_.reset();
    } else if (end_of_commented_code_ && column >= *end_of_commented_code_ && column > indentation) {
      add(LineKind::continuation, "");
    } else {
      add(LineKind::comment, std::string(column == 0 ? 0 : indentation, ' '));
      end_of_commented_code_.reset();
    }
    lines_.back().comment = comment;
  }

  void add_code(std::string code) {
    for (std::size_t i = 0; i < statement_.label_count; ++i) {
      add(LineKind::code, std::string(statement_.label(i).text(text_)) + ":");
    }
    if (statement_.kind == StatementKind::constant) {
      add(LineKind::constant, std::move(code));
      lines_.back().name = statement_.name.text(text_);
    } else if (statement_.kind == StatementKind::directive) {
      add(LineKind::code, std::move(code));
    } else if (statement_.kind == StatementKind::instruction) {
      add(LineKind::code, std::string(indentation, ' ') + code);
    }
  }

  void add(LineKind kind, std::string code) {
    FormattedLine line;
    line.kind = kind;
    line.source_line = line_;
    line.code = std::move(code);
    lines_.push_back(std::move(line));
  }

  std::string_view text_;
  LineIndex index_;
  Lexer lexer_;
  Statement statement_;
  std::size_t line_ = 0;
  std::vector<FormattedLine> lines_;
  /// The column behind the code of the line before, or before its continuations, if that has a comment.
  std::optional<std::size_t> end_of_commented_code_;
};

using Lines = std::vector<FormattedLine>;

/// Keeps one blank line of several, and none at either end. The first line stays where it is if it cannot be read: what
/// makes it so could mean something else at the start of the text (a byte order mark).
Lines without_surplus_blank_lines(Lines lines) {
  Lines kept;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].kind != LineKind::blank) {
      kept.push_back(std::move(lines[i]));
      continue;
    }
    const bool is_last_of_several = i + 1 < lines.size() && lines[i + 1].kind != LineKind::blank;
    const bool is_between = !kept.empty() || (is_last_of_several && lines[i + 1].kind == LineKind::untouched);
    if (is_last_of_several && is_between) kept.push_back(std::move(lines[i]));
  }
  return kept;
}

/// Calls `align` for each longest run of lines for which `belongs` holds.
template <typename Belongs, typename Align>
void for_each_block(Lines& lines, Belongs belongs, Align align) {
  for (auto first = lines.begin(); first != lines.end();) {
    first = std::find_if(first, lines.end(), belongs);
    const auto last = std::find_if_not(first, lines.end(), belongs);
    align(first, last);
    first = last;
  }
}

bool is_comment_line(const FormattedLine& line) {
  return line.kind == LineKind::comment || line.kind == LineKind::continuation;
}

/// Writes the names of constants before their values, all `=` of a block below each other.
void align_constants(Lines& lines) {
  const auto belongs = [](const FormattedLine& line) { return line.is_constant() || is_comment_line(line); };
  for_each_block(lines, belongs, [](Lines::iterator first, Lines::iterator last) {
    std::size_t width = 0;
    for (auto line = first; line != last; ++line) {
      if (!line->is_long) width = std::max(width, line->name.size());
    }
    for (auto line = first; line != last; ++line) {
      if (!line->is_constant()) continue;
      const std::size_t blanks = line->is_long ? 0 : width - line->name.size();
      line->code = line->name + std::string(blanks, ' ') + " = " + line->code;
    }
  });
}

/// Fills up code before comments with blanks, so that all comments of a block are below each other.
void align_comments(Lines& lines) {
  const auto belongs = [](const FormattedLine& line) {
    return line.kind != LineKind::blank && line.kind != LineKind::untouched;
  };
  const auto takes_part = [](const FormattedLine& line) {
    return !line.comment.empty() && line.kind != LineKind::comment;
  };
  for_each_block(lines, belongs, [&](Lines::iterator first, Lines::iterator last) {
    std::size_t column = comment_column;
    for (auto line = first; line != last; ++line) {
      if (takes_part(*line) && !line->is_long) column = std::max(column, width_of(line->code) + comment_distance);
    }
    for (auto line = first; line != last; ++line) {
      if (takes_part(*line)) line->code.append(line->is_long ? comment_distance : column - width_of(line->code), ' ');
    }
  });
}

bool ends_all_lines_with_cr_lf(std::string_view text) {
  bool any = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') {
      any = true;
      ++i;
    } else if (text[i] == '\r' || text[i] == '\n') {
      return false;
    }
  }
  return any;
}

/// For each line of the source what it becomes.
std::vector<std::string> texts_of_source_lines(const Lines& lines, std::size_t line_count, std::string_view line_end) {
  std::vector<std::string> texts(line_count);
  for (const FormattedLine& line : lines) {
    std::string& text = texts[line.source_line - 1];
    text += line.code;
    text += line.comment;
    text += line_end;
  }
  return texts;
}

/// The lines of a text with their ends.
std::vector<std::string_view> whole_lines_of(std::string_view text) {
  const LineIndex index(text);
  std::vector<std::string_view> lines;
  for (std::size_t line = 1; line <= index.line_count(); ++line) {
    const std::size_t start = index.start_of(line);
    const std::size_t end = line < index.line_count() ? index.start_of(line + 1) : text.size();
    if (start != end) lines.push_back(text.substr(start, end - start));
  }
  return lines;
}

}  // namespace

Formatting formatting_of(std::string_view source) {
  const bool has_mark = source.substr(0, byte_order_mark.size()) == byte_order_mark;
  const std::string_view mark = has_mark ? byte_order_mark : std::string_view();
  const std::string text = std::string(mark) + to_utf8(source.substr(mark.size()));

  Lines lines = without_surplus_blank_lines(LineFormatter(text).run());
  align_constants(lines);
  align_comments(lines);

  const std::vector<std::string_view> before = whole_lines_of(source);
  std::vector<std::string> after =
      texts_of_source_lines(lines, before.size(), ends_all_lines_with_cr_lf(source) ? "\r\n" : "\n");
  if (has_mark) after.front().insert(0, byte_order_mark);

  Formatting formatting;
  for (std::size_t i = 0; i < before.size(); ++i) {
    formatting.text += after[i];
    if (after[i] != before[i]) formatting.edits.push_back({i + 1, std::move(after[i])});
  }
  for (const FormattedLine& line : lines) {
    if (line.kind == LineKind::untouched) formatting.untouched_lines.push_back(line.source_line);
  }
  return formatting;
}

std::string format_source(std::string_view source) {
  return formatting_of(source).text;
}

}  // namespace opentmcl::lang
