// From an opcode to its handler and to what is checked before it runs: fields out of range never reach a handler.
// Derived from the instruction table, once for each module. Order and status codes of the checks: motor first (4),
// then type (3), then value (4).
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/lookup.hpp"
#include "firmware/tmcl/outcome.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

class Executor;

inline constexpr RowIndex instruction_rows =
    make_row_index(instructions, [](const InstructionSpec& row) { return row.opcode; });

constexpr std::size_t row_of(Opcode opcode) {
  return instruction_rows[static_cast<std::uint8_t>(opcode)];
}

/// Motor byte of instructions that work on all motors or on the EEPROM copy (SCO, GCO).
inline constexpr std::uint8_t all_motors = 255;

/// What an instruction can change.
enum class Reach : std::uint8_t {
  module,   ///< anything
  program,  ///< registers, user variables and the flow of the program; and it cannot fail once its fields are right
};

struct DispatchEntry {
  using Handler = Outcome (*)(Executor&, const Command&);

  Handler handler;
  std::int32_t minimum_value;
  std::uint32_t value_range;  ///< maximum - minimum, so that one comparison does
  Status in_direct_mode;      ///< ok, or why the instruction cannot be used there
  Status in_program;
  std::uint8_t maximum_motor;
  bool takes_all_motors;
  std::uint8_t maximum_type;
  std::int16_t excluded_type;  ///< a type within the range that does not exist, or -1
  Reach reach;

  constexpr Status check_fields(const Command& command) const {
    if (command.motor > maximum_motor && !(takes_all_motors && command.motor == all_motors)) {
      return Status::invalid_value;
    }
    if (command.type > maximum_type || command.type == excluded_type) return Status::wrong_type;
    if (static_cast<std::uint32_t>(command.value) - static_cast<std::uint32_t>(minimum_value) > value_range) {
      return Status::invalid_value;
    }
    return Status::ok;
  }
};

/// The entries of one module by opcode; opcodes that it lacks have one that refuses.
struct DispatchTable {
  DispatchEntry entries[instruction_count + 1];
  std::uint8_t by_opcode[256];

  constexpr const DispatchEntry& operator[](std::uint8_t opcode) const { return entries[by_opcode[opcode]]; }
};

extern const DispatchTable dispatch_tables[module_count];

/// An instruction of a program: looked up and checked, ready to be executed as often as wanted.
struct DecodedInstruction {
  DispatchEntry::Handler handler;  ///< of the instruction, or one that refuses it
  Command command;
};

/// @param reach of the instruction; that of a refused one is Reach::module
DecodedInstruction decode(const DispatchTable& table, const Command& command, Reach& reach);

}  // namespace opentmcl
