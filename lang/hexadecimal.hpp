#pragma once

#include <cstdint>
#include <string>

#include "firmware/wire/datagram.hpp"

namespace opentmcl::lang {

/// Two digits.
inline std::string hexadecimal(std::uint8_t byte) {
  constexpr char digits[] = "0123456789ABCDEF";
  return {digits[byte >> 4U], digits[byte & 0xFU]};
}

/// The seven bytes of an instruction, value with the most significant byte first: "04 01 00 FF FF D8 F0".
inline std::string hexadecimal(const Command& command) {
  std::uint8_t value[4];
  put_int32(value, command.value);
  return hexadecimal(command.opcode) + " " + hexadecimal(command.type) + " " + hexadecimal(command.motor) + " " +
         hexadecimal(value[0]) + " " + hexadecimal(value[1]) + " " + hexadecimal(value[2]) + " " +
         hexadecimal(value[3]);
}

}  // namespace opentmcl::lang
