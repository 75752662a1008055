#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lang/token.hpp"

namespace opentmcl::lang {

/// More code than this in one line, in bytes, is no TMCL; the limit keeps the memory a line needs in bounds. Comments
/// may be longer.
inline constexpr std::size_t maximum_line_length = 65536;

/// Splits a text into tokens, line by line. Never fails: what is no token of the language becomes one that says so.
///
/// Numbers: decimal with or without fraction and exponent, `$` hexadecimal, `%` binary. The last two are patterns of at
/// most 32 bits, so `$FFFFFFFF` is -1, as the conversion of the TMCL-IDE's own language has it. Comments: `//` and `;`
/// (the latter from other assemblers) to the end of the line. A byte order mark at the start is skipped.
class Lexer {
 public:
  /// Begins at `offset`, which may be in the middle of a line.
  explicit Lexer(std::string_view text, std::size_t offset = 0);

  bool at_end() const { return cursor_ == end_; }

  /// Replaces `tokens` by those of the next line. The last one is always `end_of_line`. A line that is too long is one
  /// token. Returns false if one of them `is_invalid`.
  bool read_line(Tokens& tokens);

 private:
  // Each of these reads one token that begins at the cursor.
  void read_other(Tokens& tokens);
  void read_directive(Tokens& tokens);
  void read_fraction(Tokens& tokens);
  void read_pattern(Tokens& tokens, unsigned bits_per_digit);

  void finish_malformed_number(Tokens& tokens, const char* start);
  bool goes_on_as_number() const;
  void skip_line_end();
  void add(Tokens& tokens, TokenKind kind, const char* start, const char* after, double number = 0,
           std::uint64_t packed = 0) const;
  void add_invalid(Tokens& tokens, TokenKind kind, const char* start, const char* after);

  const char* begin_;
  const char* cursor_;
  const char* end_;
  bool line_is_valid_ = true;
};

}  // namespace opentmcl::lang
