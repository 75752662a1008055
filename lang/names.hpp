// Names in TMCL sources: letters, digits and underscores, a digit never first, the case of letters without meaning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
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

/// `packed` with one more character of a name.
constexpr std::uint64_t pack(std::uint64_t packed, char c) {
  // Clearing bit 5 makes letters upper case, and keeps digits and the underscore distinct from them and each other.
  return packed << 8 | (static_cast<unsigned char>(c) & 0xDFU);
}

/// A name of at most `packed_name_size` characters as one number: equal exactly if the names are equal ignoring case.
/// 0 for longer names.
constexpr std::uint64_t packed_name(std::string_view name) {
  if (name.size() > packed_name_size) return 0;
  std::uint64_t packed = 0;
  for (const char c : name) packed = pack(packed, c);
  return packed;
}

/// The next `packed_name_size` characters of a name as one number; equal exactly if they are equal ignoring case. Names
/// are read in such steps because this is done for every name of a source; the last step takes some of them again.
inline std::uint64_t characters_at(const char* name) {
  std::uint64_t characters = 0;
  std::memcpy(&characters, name, sizeof characters);
  return characters & 0xDFDFDFDFDFDFDFDFU;
}

/// Whether two names are equal ignoring case.
inline bool is_same_name(std::string_view left, std::string_view right) {
  if (left.size() != right.size()) return false;
  if (left.size() < packed_name_size) return packed_name(left) == packed_name(right);
  const std::size_t last = left.size() - packed_name_size;
  for (std::size_t at = 0; at < last; at += packed_name_size) {
    if (characters_at(left.data() + at) != characters_at(right.data() + at)) return false;
  }
  return characters_at(left.data() + last) == characters_at(right.data() + last);
}

/// Equal for names that are equal ignoring case.
inline std::uint32_t hash_of_name(std::string_view name) {
  constexpr std::uint64_t multiplier = 0x9E3779B97F4A7C15U;
  std::uint64_t hash = name.size();
  const auto mix = [&](std::uint64_t characters) {
    hash = (hash ^ characters) * multiplier;
    hash ^= hash >> 32;
  };
  if (name.size() < packed_name_size) {
    mix(packed_name(name));
  } else {
    const char* const last = name.data() + name.size() - packed_name_size;
    for (const char* at = name.data(); at < last; at += packed_name_size) mix(characters_at(at));
    mix(characters_at(last));
  }
  return static_cast<std::uint32_t>(hash * multiplier >> 32);
}

}  // namespace opentmcl::lang
