#include "lang/text_encoding.hpp"

#include <algorithm>

namespace opentmcl::lang {

bool is_utf16(std::string_view text) {
  if (text.size() < 4) return false;
  const std::string_view mark = text.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF") return true;
  const auto are_letters = [&](std::size_t zero, std::size_t letter) {
    return text[zero] == '\0' && text[zero + 2] == '\0' && text[letter] != '\0' && text[letter + 2] != '\0';
  };
  return are_letters(1, 0) || are_letters(0, 1);
}

std::optional<std::size_t> find_control_character(std::string_view text) {
  const auto found = std::find_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < static_cast<unsigned char>(' ') && (c < '\t' || c > '\r');
  });
  if (found == text.end()) return std::nullopt;
  return static_cast<std::size_t>(found - text.begin());
}

}  // namespace opentmcl::lang
