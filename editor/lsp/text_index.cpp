#include "editor/lsp/text_index.hpp"

#include <algorithm>

namespace opentmcl::editor::lsp {
namespace {

bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Whether UTF-16 needs two units for the character that begins with `lead`.
bool is_pair(char lead) {
  return static_cast<unsigned char>(lead) >= 0xF0U;
}

}  // namespace

std::size_t TextIndex::units(std::string_view piece, bool piece_is_utf8) const {
  if (!piece_is_utf8) {
    // Each byte is a Latin-1 character; those above ASCII have two bytes in UTF-8.
    if (encoding_ == PositionEncoding::utf16) return piece.size();
    const auto high = std::count_if(piece.begin(), piece.end(), [](char c) { return (c & 0x80) != 0; });
    return piece.size() + static_cast<std::size_t>(high);
  }
  if (encoding_ == PositionEncoding::utf8) return piece.size();
  std::size_t count = 0;
  for (const char c : piece) count += is_continuation(c) ? 0U : is_pair(c) ? 2U : 1U;
  return count;
}

std::size_t TextIndex::line_of(std::size_t offset) const {
  std::size_t first = 0;
  std::size_t count = line_count();
  while (count > 1) {
    const std::size_t half = count / 2;
    if (start_of(first + half) <= offset)
      first += half, count -= half;
    else
      count = half;
  }
  return first;
}

Position TextIndex::position_of(std::size_t offset) const {
  offset = std::min(offset, text_.size());
  const std::size_t number = line_of(offset);
  const bool goes_on = last_.is_valid && last_.position.line == number && last_.offset <= offset;
  if (!goes_on) last_ = {{number, 0}, start_of(number), lang::is_utf8(line(number)), true};
  // The end of a line may be two bytes; in between there is no place.
  const std::size_t end = start_of(number) + line(number).size();
  const std::size_t behind = std::max(last_.offset, std::min(offset, end));
  last_.position.character += units(text_.substr(last_.offset, behind - last_.offset), last_.is_utf8);
  last_.offset = behind;
  return last_.position;
}

std::size_t TextIndex::offset_of(Position position) const {
  if (position.line >= line_count()) return text_.size();
  const std::string_view in = line(position.line);
  const bool utf8 = lang::is_utf8(in);
  std::size_t at = 0;
  std::size_t character = 0;
  while (at < in.size() && character < position.character) {
    std::size_t next = at + 1;
    while (utf8 && next < in.size() && is_continuation(in[next])) ++next;
    character += units(in.substr(at, next - at), utf8);
    if (character > position.character) break;
    at = next;
  }
  return start_of(position.line) + at;
}

}  // namespace opentmcl::editor::lsp
