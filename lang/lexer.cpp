#include "lang/lexer.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

/// In this order: what a name can go on with is last.
enum class CharacterClass : std::uint8_t { other, blank, line_end, sign, name, digit };

struct CharacterTable {
  CharacterClass classes[256];
  TokenKind signs[256];  // of CharacterClass::sign
};

consteval CharacterTable make_character_table() {
  CharacterTable table{};
  for (int c = 0; c < 128; ++c) {
    const char character = static_cast<char>(c);
    if (starts_name(character)) table.classes[c] = CharacterClass::name;
    if (is_digit(character)) table.classes[c] = CharacterClass::digit;
  }
  for (const char blank : {' ', '\t', '\v', '\f'}) {
    table.classes[static_cast<unsigned char>(blank)] = CharacterClass::blank;
  }
  for (const char end : {'\n', '\r'}) table.classes[static_cast<unsigned char>(end)] = CharacterClass::line_end;
  const auto sign = [&](char character, TokenKind kind) {
    table.classes[static_cast<unsigned char>(character)] = CharacterClass::sign;
    table.signs[static_cast<unsigned char>(character)] = kind;
  };
  sign(',', TokenKind::comma);
  sign(':', TokenKind::colon);
  sign('=', TokenKind::equals);
  sign('+', TokenKind::plus);
  sign('-', TokenKind::minus);
  sign('*', TokenKind::star);
  sign('^', TokenKind::caret);
  sign('(', TokenKind::open);
  sign(')', TokenKind::close);
  return table;
}

constexpr CharacterTable character_table = make_character_table();

CharacterClass class_of(char c) {
  return character_table.classes[static_cast<unsigned char>(c)];
}

bool is_name_or_digit(char c) {
  return class_of(c) >= CharacterClass::name;
}

/// Whether a comment begins at `at`, which is not `end`.
bool is_comment(const char* at, const char* end) {
  return *at == ';' || (*at == '/' && at + 1 != end && at[1] == '/');
}

/// Most comments end within this many characters; they are searched in pieces of it, because a text may have only one
/// of the two characters that end lines.
constexpr std::ptrdiff_t comment_piece = 128;

const char* find_character(const char* at, const char* end, char character) {
  const void* const found = std::memchr(at, character, static_cast<std::size_t>(end - at));
  return found == nullptr ? end : static_cast<const char*>(found);
}

const char* find_line_end(const char* at, const char* end) {
  while (at != end) {
    const char* const piece_end = end - at > comment_piece ? at + comment_piece : end;
    const char* const found = find_character(at, find_character(at, piece_end, '\n'), '\r');
    if (found != piece_end) return found;
    at = piece_end;
  }
  return end;
}

/// Value of a digit in base 16, or 16 for what is none.
unsigned digit_value(char c) {
  if (is_digit(c)) return static_cast<unsigned>(c - '0');
  const char upper = to_upper(c);
  return upper >= 'A' && upper <= 'F' ? static_cast<unsigned>(upper - 'A') + 10U : 16U;
}

/// Up to 15 digits are exact in a double, and fit a 64-bit integer.
constexpr std::ptrdiff_t exact_digits = 15;

}  // namespace

Lexer::Lexer(std::string_view text, std::size_t offset)
    : begin_(text.data()), cursor_(text.data() + offset), end_(text.data() + text.size()) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (offset == 0 && text.substr(0, byte_order_mark.size()) == byte_order_mark) cursor_ += byte_order_mark.size();
}

bool Lexer::read_line(Tokens& tokens) {
  tokens.clear();
  line_is_valid_ = true;
  // The cursor of the common tokens is a local variable, which the compiler can keep in a register.
  const char* at = cursor_;
  const char* const line = at;
  const char* const end = static_cast<std::size_t>(end_ - at) > maximum_line_length ? at + maximum_line_length : end_;
  while (at < end) {
    if (class_of(*at) == CharacterClass::blank) {
      ++at;
      continue;
    }
    const char* const start = at;
    switch (class_of(*at)) {
      case CharacterClass::name: {
        // Packed here, where each character is read anyway, and not again for each of the tables it is looked up in.
        std::uint64_t packed = 0;
        do packed = pack(packed, *at);
        while (++at != end && is_name_or_digit(*at));
        const bool fits = static_cast<std::size_t>(at - start) <= packed_name_size;
        add(tokens, TokenKind::name, start, at, 0, fits ? packed : 0);
        continue;
      }
      case CharacterClass::sign:
        add(tokens, character_table.signs[static_cast<unsigned char>(*start)], start, ++at);
        continue;
      case CharacterClass::digit: {
        std::uint64_t integer = 0;
        for (; at != end_ && is_digit(*at); ++at) integer = integer * 10 + static_cast<std::uint64_t>(*at - '0');
        const bool ends_here = at == end_ || (*at != '.' && class_of(*at) != CharacterClass::name);
        if (ends_here && at - start <= exact_digits) {
          add(tokens, TokenKind::number, start, at, static_cast<double>(integer));
          continue;
        }
        cursor_ = start;
        read_fraction(tokens);
        at = cursor_;
        continue;
      }
      case CharacterClass::other:
        if (is_comment(at, end_)) break;
        cursor_ = start;
        read_other(tokens);
        at = cursor_;
        continue;
      case CharacterClass::blank:
      case CharacterClass::line_end:
        break;
    }
    break;
  }
  if (at >= end && at != end_ && class_of(*at) != CharacterClass::line_end) {
    tokens.clear();
    at = find_line_end(at, end_);
    add_invalid(tokens, TokenKind::line_too_long, line, at);
  }
  add(tokens, TokenKind::end_of_line, at, at);
  const bool is_at_end = at == end_ || class_of(*at) == CharacterClass::line_end;
  cursor_ = is_at_end ? at : find_line_end(at, end_);
  skip_line_end();
  return line_is_valid_;
}

void Lexer::read_other(Tokens& tokens) {
  switch (*cursor_) {
    case '$':
      return read_pattern(tokens, 4);
    case '%':
      return read_pattern(tokens, 1);
    case '.':
      return read_fraction(tokens);
    case '#':
      return read_directive(tokens);
    default:
      break;
  }
  const char* const start = cursor_++;
  if (*start == '/') return add(tokens, TokenKind::slash, start, cursor_);
  while (cursor_ != end_ && (static_cast<unsigned char>(*start) & 0xC0U) == 0xC0U &&
         (static_cast<unsigned char>(*cursor_) & 0xC0U) == 0x80U) {
    ++cursor_;
  }
  add_invalid(tokens, TokenKind::unexpected_character, start, cursor_);
}

void Lexer::read_directive(Tokens& tokens) {
  const char* const start = cursor_;
  const char* last = start;
  for (; cursor_ != end_ && class_of(*cursor_) != CharacterClass::line_end && !is_comment(cursor_, end_); ++cursor_) {
    if (class_of(*cursor_) != CharacterClass::blank) last = cursor_;
  }
  add(tokens, TokenKind::directive, start, last + 1);
}

void Lexer::read_fraction(Tokens& tokens) {
  const char* const start = cursor_;
  double number = 0;
  const auto [after, error] = std::from_chars(start, end_, number);
  if (error == std::errc::invalid_argument) return finish_malformed_number(tokens, start);
  cursor_ = after;
  if (goes_on_as_number()) return finish_malformed_number(tokens, start);
  if (error != std::errc()) return add_invalid(tokens, TokenKind::number_too_large, start, cursor_);
  add(tokens, TokenKind::number, start, cursor_, number);
}

void Lexer::read_pattern(Tokens& tokens, unsigned bits_per_digit) {
  const char* const start = cursor_;
  const unsigned base = 1U << bits_per_digit;
  std::uint64_t pattern = 0;
  bool too_large = false;
  for (++cursor_; cursor_ != end_ && digit_value(*cursor_) < base; ++cursor_) {
    pattern = pattern << bits_per_digit | digit_value(*cursor_);
    too_large = too_large || pattern > UINT32_MAX;
    pattern &= UINT32_MAX;
  }
  if (cursor_ == start + 1 || goes_on_as_number()) return finish_malformed_number(tokens, start);
  if (too_large) return add_invalid(tokens, TokenKind::number_too_large, start, cursor_);
  add(tokens, TokenKind::number, start, cursor_, static_cast<std::int32_t>(static_cast<std::uint32_t>(pattern)));
}

void Lexer::finish_malformed_number(Tokens& tokens, const char* start) {
  if (cursor_ == start) ++cursor_;
  while (goes_on_as_number()) ++cursor_;
  add_invalid(tokens, TokenKind::malformed_number, start, cursor_);
}

bool Lexer::goes_on_as_number() const {
  return cursor_ != end_ && (*cursor_ == '.' || is_name_or_digit(*cursor_));
}

void Lexer::skip_line_end() {
  if (cursor_ == end_) return;
  const bool carriage_return = *cursor_ == '\r';
  ++cursor_;
  if (carriage_return && cursor_ != end_ && *cursor_ == '\n') ++cursor_;
}

void Lexer::add(Tokens& tokens, TokenKind kind, const char* start, const char* after, double number,
                std::uint64_t packed) const {
  tokens.push_back(
      {kind, static_cast<std::uint32_t>(start - begin_), static_cast<std::uint32_t>(after - start), number, packed});
}

void Lexer::add_invalid(Tokens& tokens, TokenKind kind, const char* start, const char* after) {
  line_is_valid_ = false;
  add(tokens, kind, start, after);
}

}  // namespace opentmcl::lang
