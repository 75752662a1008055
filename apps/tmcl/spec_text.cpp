#include <fmt/format.h>

#include <string_view>

#include "apps/tmcl/spec_json.hpp"
#include "apps/tmcl/spec_words.hpp"
#include "lang/operand_kind.hpp"

namespace opentmcl::app {

namespace {

std::string names_of(Modules set) {
  std::string names;
  for (const ModuleDescription& module : modules) {
    if (contains(set, module.id)) names += fmt::format("{}{}", names.empty() ? "" : ", ", module.name);
  }
  return names;
}

/// "MVP ABS|REL|COORD, motor_group, position"
std::string form_of(const InstructionSpec& instruction) {
  std::string form = instruction.mnemonic == nullptr ? "-" : instruction.mnemonic;
  const char* separator = " ";
  for (const OperandSpec& operand : instruction.operands) {
    if (operand.kind == OperandKind::none) continue;
    form += separator;
    separator = ", ";
    const KeywordSet keywords = keywords_of(operand.kind);
    if (keywords.count == 0) form += lang::names_of(operand.kind).identifier;
    const char* bar = "";
    for (std::size_t i = 0; i < keywords.count; ++i) {
      if (keywords.words[i].value == keywords.excluded) continue;
      form += fmt::format("{}{}", bar, keywords.words[i].word);
      bar = "|";
    }
  }
  return form;
}

template <class Row, std::size_t count>
std::string parameters_text(std::string_view title, const Row (&table)[count]) {
  std::string text = fmt::format("\n{}\n", title);
  for (const Row& row : table) {
    text += fmt::format("{:4}  {}: {}\n", static_cast<unsigned>(row.number), row.symbol, row.description);
    for (const ModuleDescription& module : modules) {
      const ParameterColumn& column = row.in(module.id);
      if (column.access == Access::none) continue;
      text += fmt::format("        {}: {}, {} to {}, default {}{}{}\n", module.name, letters_of(column.access),
                          column.minimum, column.maximum, column.default_value, row.unit == Unit::none ? "" : "; ",
                          name_of(row.unit));
    }
  }
  return text;
}

}  // namespace

std::string spec_as_text() {
  std::string text = "Modules\n";
  for (const ModuleDescription& module : modules) {
    text += fmt::format("  {} (firmware V{}.{:02}), {} instructions\n", module.name, module.firmware_major,
                        module.firmware_minor, module.program_capacity);
  }
  text += "\nInstructions\n";
  for (const InstructionSpec& row : instructions) {
    text += fmt::format("{:4}  {}: {} ({}; {})\n", static_cast<unsigned>(row.opcode), form_of(row), row.description,
                        name_of(row.where), names_of(row.modules));
  }
  text += parameters_text("Axis parameters", axis_parameters);
  text += parameters_text("Global parameters, bank 0", global_parameters);
  text += "\nInterrupts\n";
  for (const InterruptSpec& row : interrupts) {
    text += fmt::format("{:4}  {}: {} ({})\n", static_cast<unsigned>(row.number), row.symbol, row.name,
                        names_of(row.modules));
  }
  text += "\nStatus codes\n";
  for (const StatusSpec& row : status_codes) {
    text += fmt::format("{:4}  {}: {}\n", static_cast<unsigned>(row.code), row.name, row.description);
  }
  text += "\nI/O ports: bank, port\n";
  for (const IoPortSpec& row : io_ports) {
    text += fmt::format("  {}, {:3}  {}: {} ({}, {})\n", static_cast<unsigned>(row.bank), row.port, row.symbol,
                        row.description, letters_of(row.access), names_of(row.modules));
  }
  return text;
}

}  // namespace opentmcl::app
