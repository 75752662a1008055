#pragma once

#include <cstdint>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/diagnostic.hpp"
#include "lang/expression.hpp"
#include "lang/statement.hpp"

namespace opentmcl::lang {

/// SCO and GCO with this motor copy coordinates between RAM and EEPROM. Source: S0 3.7.24.
inline constexpr int all_motors = 255;

/// Warns of what can be written in an instruction but will be refused by the module: operands out of their range,
/// motors, axis and global parameters it lacks or does not let this instruction access, values they do not take.
/// `statement` is what `command` was made of, all its operands written or optional.
void check_command(const InstructionSpec& instruction, const Command& command, const ModuleDescription& module,
                   const Statement& statement, const Scope& scope, DiagnosticList& diagnostics);

}  // namespace opentmcl::lang
