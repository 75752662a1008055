// The file TMCL-IDE writes and loads: eight bytes an instruction, opcode, type, motor, value with the most significant
// byte first, and the low byte of the sum of these seven.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/wire/datagram.hpp"

namespace opentmcl::lang {

inline constexpr std::size_t program_file_record_size = 8;

std::vector<std::uint8_t> to_program_file(const std::vector<Command>& commands);

struct ProgramFileResult {
  std::optional<std::vector<Command>> commands;
  std::string error;  ///< what was expected and what was found, if there are no commands
};

ProgramFileResult from_program_file(const std::vector<std::uint8_t>& bytes);

}  // namespace opentmcl::lang
