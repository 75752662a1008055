// What the number of an operand stands for: for comments, hovers and hints beside it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/spec/parameter_rows.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::lang {

/// What an operand measures: of the last one of "SAP 4, 0, 1000" the unit of axis parameter 4, of those of WAIT ten
/// milliseconds. `operand` belongs to the instruction `command` is. Unit::none for what the module lacks.
Unit unit_of_operand(const OperandSpec& operand, const Command& command, const ModuleDescription& module);

/// The name the tables have for what an operand chooses, an axis or global parameter, a port or an interrupt: "maximum
/// positioning speed". Empty for all other operands, and for what the module lacks.
std::string_view name_of_operand(const OperandSpec& operand, const Command& command, const ModuleDescription& module);

/// "1...2047", or the number alone where there is but one
std::string range_text(std::int32_t minimum, std::int32_t maximum);

}  // namespace opentmcl::lang
