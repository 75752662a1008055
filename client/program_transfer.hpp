// Programs into a module and out of it. Source: PD-1161 manual 3.7.53, commands 132 to 134.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "client/client.hpp"

namespace opentmcl::client {

/// Told how many of how many instructions have been transferred; false ends the transfer (error: interrupted).
using Progress = std::function<bool(std::size_t done, std::size_t total)>;

/// The mark that TMCL-IDE writes behind a program: no program can hold this opcode.
inline constexpr Command end_mark{};
static_assert(end_mark.opcode == 0);

/// A program as a module's memory of `capacity` instructions is to hold it: with the mark behind it if there is room.
/// Without one, what is read back goes on with what an earlier, longer program has left
/// (docs/decisions/0078-end-mark.md).
std::vector<Command> with_end_mark(std::vector<Command> program, std::size_t capacity);

/// Stops the running program and writes `program` from `address` on. However it ends, the module is out of download
/// mode again when it can still be reached. A whole program wants its end mark with it.
Result<void> download(Client& client, const std::vector<Command>& program, std::uint16_t address,
                      const Progress& progress);

/// Reads one instruction.
Result<Command> read_instruction(Client& client, std::uint16_t address);

/// Reads the program from address 0 to its end: to the first place whose opcode no program can hold, be it the end mark
/// or memory nobody has written; `capacity` instructions at most, which is also
/// the total `progress` is told. Error: refused when the program is protected against reading, or when there is none.
Result<std::vector<Command>> read_program(Client& client, std::uint16_t capacity, const Progress& progress);

/// Reads the program back and compares. Error: protocol, naming the first difference.
Result<void> verify(Client& client, const std::vector<Command>& program, std::uint16_t address,
                    const Progress& progress);

}  // namespace opentmcl::client
