#include "lang/operand_meaning.hpp"

#include <cstdint>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"
#include "firmware/spec/io_ports.hpp"
#include "lang/instruction_table.hpp"
#include "lang/table_rows.hpp"

namespace opentmcl::lang {
namespace {

Unit unit_of_global_parameter(const Command& command, const ModuleDescription& module) {
  switch (static_cast<Bank>(command.motor)) {
    case Bank::module_settings:
      if (const GlobalParameterSpec* const row = find_module_setting(command.type, module)) return row->unit;
      break;
    case Bank::interrupt_settings:
      if (const InterruptSpec* const row = find_interrupt(command.type, module)) {
        return row->setting == InterruptSetting::period ? Unit::milliseconds : Unit::none;
      }
      break;
    case Bank::customer:
    case Bank::user_variables:
      break;
  }
  return Unit::none;
}

std::string_view name_of_global_parameter(const Command& command, const ModuleDescription& module) {
  switch (static_cast<Bank>(command.motor)) {
    case Bank::module_settings:
      if (const GlobalParameterSpec* const row = find_module_setting(command.type, module)) return row->name;
      break;
    case Bank::interrupt_settings:
      if (const InterruptSpec* const row = find_interrupt(command.type, module)) return row->name;
      break;
    case Bank::customer:
    case Bank::user_variables:
      break;
  }
  return {};
}

/// The unit of what `SAP`, `SGP` and their like write.
Unit unit_of_value(const Command& command, const ModuleDescription& module) {
  switch (static_cast<Opcode>(command.opcode)) {
    case Opcode::sap:
      if (const AxisParameterSpec* const row = find_axis_parameter(command.type, module)) return row->unit;
      break;
    case Opcode::sgp:
      return unit_of_global_parameter(command, module);
    default:
      break;
  }
  return Unit::none;
}

bool moves_to_coordinate(const Command& command) {
  return command.opcode == static_cast<std::uint8_t>(Opcode::mvp) &&
         command.type == find_word(OperandKind::mvp_mode, "COORD");
}

}  // namespace

Unit unit_of_operand(const OperandSpec& operand, const Command& command, const ModuleDescription& module) {
  switch (operand.kind) {
    case OperandKind::velocity:
      return Unit::internal_velocity;
    case OperandKind::position:
      return moves_to_coordinate(command) ? Unit::none : Unit::microsteps;
    case OperandKind::ticks:
      // -1 takes the accumulator, and a time limit of 0 is none.
      return command.value <= 0 ? Unit::none : Unit::ten_milliseconds;
    case OperandKind::value:
      return unit_of_value(command, module);
    default:
      return Unit::none;
  }
}

std::string_view name_of_operand(const OperandSpec& operand, const Command& command, const ModuleDescription& module) {
  switch (operand.kind) {
    case OperandKind::axis_parameter:
      if (const AxisParameterSpec* const row = find_axis_parameter(command.type, module)) return row->name;
      break;
    case OperandKind::global_parameter:
      return name_of_global_parameter(command, module);
    case OperandKind::port:
      if (const IoPortSpec* const row = find_port(command.type, command.motor, module)) return row->description;
      break;
    case OperandKind::interrupt:
      if (const InterruptSpec* const row = find_interrupt(command.type, module)) return row->name;
      break;
    default:
      break;
  }
  return {};
}

std::string range_text(std::int32_t minimum, std::int32_t maximum) {
  if (minimum == maximum) return std::to_string(minimum);
  return std::to_string(minimum) + "..." + std::to_string(maximum);
}

}  // namespace opentmcl::lang
