#pragma once

#include <cstdint>
#include <span>

namespace opentmcl {

/// CRC-32 as in ISO-HDLC, Ethernet and zip: reflected polynomial EDB88320h, start and final XOR all ones.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

namespace crc32_detail {
inline constexpr std::uint8_t check[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
}
static_assert(crc32(crc32_detail::check) == 0xCBF43926, "the check value of the CRC catalogue");

}  // namespace opentmcl
