// Commands and replies as lines of text: the ASCII mode. Source: PD-1161 manual 3.4; what it leaves open is in
// docs/decisions/0017-ascii-mode.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "firmware/spec/status_codes.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

inline constexpr char carriage_return = '\r';

/// How an address is written: 'A' for 1, 'B' for 2 and on in the order of ASCII, '?' for those past its printing
/// characters.
constexpr char ascii_address(std::uint8_t address) {
  constexpr std::uint8_t last_with_a_character = '~' - '@';
  return address <= last_with_a_character ? static_cast<char>('@' + address) : '?';
}

/// Reads a command such as "MVP ABS, 0, 50000": the line without address character and carriage return. Upper and lower
/// case are alike, spaces and tabs may stand between the parts.
/// @param command only meaningful when the result is ok; the module may still refuse it
/// @return ok, invalid_command (no such command, or operands missing or left over), wrong_type or invalid_value (an
///         operand that the field of the command, or the command itself, cannot take)
Status parse_ascii_command(std::string_view line, Command& command);

/// The longest reply: "BA 100 -2147483648" and a carriage return.
inline constexpr std::size_t longest_ascii_reply = 19;

/// Writes a reply, carriage return included. @param text room for longest_ascii_reply characters @return its length
std::size_t format_ascii_reply(const Reply& reply, char* text);

}  // namespace opentmcl
