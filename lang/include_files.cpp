#include "lang/include_files.hpp"

#include <cstddef>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

void add_constant(std::string& text, const std::string& symbol, int value, const char* name) {
  text += symbol + " = " + std::to_string(value) + " // " + name + "\n";
}

template <typename Row>
void add_parameters(std::string& text, const Row* rows, std::size_t count, ModuleId module) {
  for (std::size_t i = 0; i < count; ++i) {
    if (rows[i].in(module).access == Access::none) continue;
    add_constant(text, rows[i].symbol, static_cast<int>(rows[i].number), rows[i].name);
  }
}

}  // namespace

std::string parameter_file(const ModuleDescription& module) {
  std::string text = "// Motors, axis parameters and global parameters of the " + describe(module) + "\n";
  for (int motor = 0; motor < module.axis_count; ++motor) {
    add_constant(text, "Motor" + std::to_string(motor), motor, "motor");
  }
  add_parameters(text, axis_parameters, axis_parameter_count, module.id);
  add_parameters(text, global_parameters, global_parameter_count, module.id);
  return text;
}

std::string interrupt_file(const ModuleDescription& module) {
  std::string text = "// Interrupts of the " + describe(module) + "\n";
  for (const InterruptSpec& row : interrupts) {
    if (contains(row.modules, module.id)) add_constant(text, row.symbol, static_cast<int>(row.number), row.name);
  }
  return text;
}

std::optional<std::string> built_in_file(std::string_view name, const ModuleDescription& module) {
  if (equal_ignoring_case(name, parameter_file_name)) return parameter_file(module);
  if (equal_ignoring_case(name, interrupt_file_name)) return interrupt_file(module);
  return std::nullopt;
}

}  // namespace opentmcl::lang
