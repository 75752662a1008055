#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lang/source.hpp"

namespace opentmcl::editor::lsp {

/// What a client counts in a line.
enum class PositionEncoding : std::uint8_t { utf8, utf16 };

/// Both count from 0.
struct Position {
  std::size_t line = 0;
  std::size_t character = 0;

  friend constexpr bool operator==(const Position&, const Position&) = default;
};

/// Places in a text as the protocol names them, and as offsets. A line that is not UTF-8, as in a Latin-1 file that
/// the editor has converted, has a character for each byte.
class TextIndex {
 public:
  /// `text` must outlive the index.
  TextIndex(std::string_view text, PositionEncoding encoding) : text_(text), lines_(text), encoding_(encoding) {}

  std::string_view text() const { return text_; }
  std::size_t line_count() const { return lines_.line_count(); }

  /// Fast for rising offsets.
  Position position_of(std::size_t offset) const;
  /// Behind the end of a line, its end; behind the last line, the end of the text; within a character, its beginning.
  std::size_t offset_of(Position position) const;

  /// Length in what the client counts.
  std::size_t units(std::string_view piece, bool piece_is_utf8) const;
  /// Where line `line` begins, which counts from 0.
  std::size_t start_of(std::size_t line) const { return lines_.start_of(line + 1); }
  /// Without its end; counts from 0.
  std::string_view line(std::size_t line) const { return lines_.line(line + 1); }

 private:
  std::size_t line_of(std::size_t offset) const;

  std::string_view text_;
  lang::LineIndex lines_;
  PositionEncoding encoding_;

  /// The place asked for last: from there it is not far to the next one.
  struct Remembered {
    Position position;
    std::size_t offset = 0;
    bool is_utf8 = false;
    bool is_valid = false;
  };
  mutable Remembered last_;
};

}  // namespace opentmcl::editor::lsp
