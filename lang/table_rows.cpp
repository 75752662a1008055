#include "lang/table_rows.hpp"

#include "firmware/spec/lookup.hpp"
#include "firmware/spec/parameter_rows.hpp"

namespace opentmcl::lang {
namespace {

std::uint8_t row_in(const RowIndex& index, std::int32_t number) {
  return number < 0 || number > 255 ? no_row : index[static_cast<std::uint8_t>(number)];
}

}  // namespace

const AxisParameterSpec* find_axis_parameter(std::int32_t number, const ModuleDescription& module) {
  const std::uint8_t row = row_in(axis_parameter_rows, number);
  if (row == no_row || axis_parameters[row].in(module.id).access == Access::none) return nullptr;
  return &axis_parameters[row];
}

const GlobalParameterSpec* find_module_setting(std::int32_t number, const ModuleDescription& module) {
  const std::uint8_t row = row_in(global_parameter_rows, number);
  if (row == no_row || global_parameters[row].in(module.id).access == Access::none) return nullptr;
  return &global_parameters[row];
}

const InterruptSpec* find_interrupt(std::int32_t number, const ModuleDescription& module) {
  const std::uint8_t row = row_in(interrupt_rows, number);
  return row == no_row || !contains(interrupts[row].modules, module.id) ? nullptr : &interrupts[row];
}

const IoPortSpec* find_port(std::int32_t port, std::int32_t bank, const ModuleDescription& module) {
  for (const IoPortSpec& row : io_ports) {
    if (row.port == port && static_cast<std::int32_t>(row.bank) == bank && contains(row.modules, module.id)) {
      return &row;
    }
  }
  return nullptr;
}

}  // namespace opentmcl::lang
