#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "units/physical_value.hpp"

namespace opentmcl::lang {

/// An instruction in mnemonic form, "MVP ABS, 0, 1000", or why it has none.
struct DisassembledInstruction {
  std::optional<std::string> text;
  std::string reason;  ///< if there is no text
};

/// Inverse of the assembler: what it gives for the text is `command` again. There is no text for opcodes without a
/// mnemonic in this module, for numbers in fields the instruction does not use, and for numbers where only words have a
/// meaning.
DisassembledInstruction disassemble_instruction(const Command& command, const ModuleDescription& module);

/// What an instruction is about, as a comment beside it says it: "maximum positioning speed = 35.8 rpm", "digital
/// output 1", "500 ms". Empty where its words say it all.
std::string instruction_comment(const Command& command, const ModuleDescription& module,
                                const units::PhysicalScale& scale);

struct Inexpressible {
  std::size_t address;
  Command command;
  std::string reason;
};

struct Disassembly {
  /// Source that assembles, without appending STOP, to the same program; a comment where an instruction has no text. It
  /// says which module it is for (lang/module_comment.hpp).
  std::string text;
  std::vector<Inexpressible> problems;  ///< if any, the text is for reading only
};

enum class Comments : std::uint8_t { none, meanings };

/// Addresses within the program (or just behind it) that instructions jump to become labels `L_n`. Physical values in
/// comments begin with the module's factory settings and follow the program (`follow`). The text is formatted.
Disassembly disassemble(const std::vector<Command>& commands, const ModuleDescription& module,
                        Comments comments = Comments::meanings);

}  // namespace opentmcl::lang
