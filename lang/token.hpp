#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace opentmcl::lang {

enum class TokenKind : std::uint8_t {
  name,
  number,
  comma,
  colon,
  equals,
  plus,
  minus,
  star,
  slash,
  caret,
  open,
  close,
  directive,    ///< # and all that follows it but the comment
  end_of_line,  ///< nothing, where the line or its comment ends
  // What is none of the language is last: see `is_invalid`.
  unexpected_character,  ///< one character, all bytes of it
  malformed_number,
  number_too_large,
  line_too_long,  ///< all of the line
};

/// Whether this is no token of the language.
constexpr bool is_invalid(TokenKind kind) {
  return kind >= TokenKind::unexpected_character;
}

/// A word or sign of a source; comments and blanks are none.
struct Token {
  TokenKind kind = TokenKind::end_of_line;
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
  double number = 0;         ///< of TokenKind::number
  std::uint64_t packed = 0;  ///< of TokenKind::name: its `packed_name`

  std::uint32_t end() const { return offset + length; }
  std::string_view text(std::string_view source) const { return source.substr(offset, length); }
};

using Tokens = std::vector<Token>;

}  // namespace opentmcl::lang
