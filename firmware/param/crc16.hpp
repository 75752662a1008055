#pragma once

#include <cstddef>
#include <cstdint>

namespace opentmcl {

/// CRC-16/CCITT-FALSE: polynomial 0x1021, start value 0xFFFF. Of "123456789" it is 0x29B1.
constexpr std::uint16_t crc16(const std::uint8_t* data, std::size_t length, std::uint16_t crc = 0xFFFF) {
  for (std::size_t i = 0; i < length; ++i) {
    crc = static_cast<std::uint16_t>(crc ^ data[i] << 8);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? crc << 1 ^ 0x1021 : crc << 1);
    }
  }
  return crc;
}

}  // namespace opentmcl
