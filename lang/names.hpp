// Names in TMCL sources: letters, digits and underscores, a digit never first, the case of letters without meaning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace opentmcl::lang {

constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

constexpr bool starts_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

constexpr bool continues_name(char c) {
  return starts_name(c) || is_digit(c);
}

constexpr char to_upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

constexpr bool equal_ignoring_case(std::string_view left, std::string_view right) {
  if (left.size() != right.size()) return false;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (to_upper(left[i]) != to_upper(right[i])) return false;
  }
  return true;
}

inline constexpr std::size_t packed_name_size = 8;

/// A name of at most `packed_name_size` characters as one number: equal exactly if the names are equal ignoring case.
/// 0 for longer names.
constexpr std::uint64_t packed_name(std::string_view name) {
  if (name.size() > packed_name_size) return 0;
  std::uint64_t packed = 0;
  // Clearing bit 5 makes letters upper case, and keeps digits and the underscore distinct from them and each other.
  for (const char c : name) packed = packed << 8 | (static_cast<unsigned char>(c) & 0xDFU);
  return packed;
}

/// Whether two names are equal ignoring case. Only for names: other characters would be mixed up, see `packed_name`.
constexpr bool is_same_name(std::string_view left, std::string_view right) {
  if (left.size() != right.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    difference |= static_cast<unsigned char>(left[i]) ^ static_cast<unsigned char>(right[i]);
  }
  return (difference & 0xDFU) == 0;
}

/// Equal for names that are equal ignoring case. Eight characters a step, because this is done for every name of a
/// source.
constexpr std::uint32_t hash_of_name(std::string_view name) {
  constexpr std::uint64_t multiplier = 0x9E3779B97F4A7C15U;
  std::uint64_t hash = name.size();
  while (!name.empty()) {
    const std::string_view step = name.substr(0, packed_name_size);
    hash = (hash ^ packed_name(step)) * multiplier;
    hash ^= hash >> 32;
    name.remove_prefix(step.size());
  }
  return static_cast<std::uint32_t>(hash);
}

}  // namespace opentmcl::lang
