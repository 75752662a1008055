// What the words of a source mean, told from the tables: for hovers, completions and help on operands.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/interrupts.hpp"
#include "firmware/spec/io_ports.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/expression.hpp"
#include "lang/symbol_table.hpp"
#include "units/physical_value.hpp"

namespace opentmcl::lang {

struct Explanation {
  std::string title;               ///< as it could stand in a source: "SAP axis parameter, motor, value"
  std::vector<std::string> lines;  ///< a sentence or an item of a list each
};

/// What an operand is called: "axis parameter".
std::string name_of_operand_kind(OperandKind kind);

/// An operand, and what it may be: "velocity: -2047...2047", "mvp mode: ABS, REL, COORD".
std::string describe_operand(const OperandSpec& operand, const ModuleDescription& module);

Explanation explain(const InstructionSpec& instruction, const ModuleDescription& module);
Explanation explain(const FunctionSpec& function);
Explanation explain(const Keyword& word, OperandKind kind);
/// The value, and of a label how the module counts it.
Explanation explain(const Symbol& symbol);

Explanation explain(const AxisParameterSpec& parameter, const ModuleDescription& module);
/// Of bank 0.
Explanation explain(const GlobalParameterSpec& parameter, const ModuleDescription& module);
Explanation explain(const InterruptSpec& interrupt);
Explanation explain(const IoPortSpec& port);

/// What the number of an operand of `command` stands for: the parameter it chooses, or with `scale` what it is
/// physically and in which range it may be. None where the number says it all.
std::optional<Explanation> explain_operand(const OperandSpec& operand, const Command& command,
                                           const ModuleDescription& module, const units::PhysicalScale& scale);

}  // namespace opentmcl::lang
