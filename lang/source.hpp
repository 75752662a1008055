// The texts of one run of the assembler, and places in them. A text may end its lines with LF, CR LF or CR, the last
// one with nothing, and be UTF-8 or Latin-1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace opentmcl::lang {

/// Index into Sources.
using FileId = std::uint32_t;

/// A piece of a source text, in bytes.
struct Span {
  FileId file = 0;
  std::uint32_t offset = 0;
  std::uint32_t length = 0;

  friend constexpr bool operator==(const Span&, const Span&) = default;
};

struct SourceFile {
  std::string name;  ///< as the user would type it
  std::string text;
  bool is_built_in = false;  ///< made from the tables: there is no such file
};

/// All texts of one run together, in bytes. A thousand times the largest program; keeps memory in bounds.
inline constexpr std::size_t maximum_text_size = 64U << 20;

/// All texts of one run. References to a file stay valid while others are added and when the whole is moved.
class Sources {
 public:
  FileId add(std::string name, std::string text, bool is_built_in = false);

  std::size_t size() const { return files_.size(); }
  const SourceFile& operator[](FileId file) const { return files_[file]; }

  std::string_view text_of(Span span) const {
    return std::string_view(files_[span.file].text).substr(span.offset, span.length);
  }

 private:
  std::deque<SourceFile> files_;
};

/// Both count from 1. A column is a character, not a byte; a tab is one character.
struct Position {
  std::size_t line = 1;
  std::size_t column = 1;

  friend constexpr bool operator==(const Position&, const Position&) = default;
};

/// Where the lines of a text begin. Made only when somebody asks for lines: the assembler itself never does.
class LineIndex {
 public:
  explicit LineIndex(std::string_view text);

  std::size_t line_count() const { return starts_.size(); }
  Position position_of(std::size_t offset) const;
  /// Line `line` without its end; counts from 1.
  std::string_view line(std::size_t line) const;
  /// Offset of the first byte of a line.
  std::size_t start_of(std::size_t line) const { return starts_[line - 1]; }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

bool is_utf8(std::string_view text);

/// The text itself if it is UTF-8, else every byte of it as a Latin-1 character.
std::string to_utf8(std::string_view text);

}  // namespace opentmcl::lang
