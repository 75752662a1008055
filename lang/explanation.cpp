#include "lang/explanation.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string_view>

#include "lang/instruction_table.hpp"
#include "lang/operand_field.hpp"
#include "lang/operand_kind.hpp"
#include "lang/operand_meaning.hpp"
#include "lang/table_rows.hpp"

namespace opentmcl::lang {
namespace {

void add_phrase(std::string& list, std::string_view phrase) {
  if (!list.empty()) list += ", ";
  list += phrase;
}

/// What the letters of the manuals' access columns say.
std::string describe(Access access) {
  std::string list;
  if (allows(access, Access::r)) add_phrase(list, "read");
  if (allows(access, Access::w)) add_phrase(list, "write");
  if (allows(access, Access::e)) add_phrase(list, "store and restore");
  if (allows(access, Access::a)) add_phrase(list, "stored when written");
  return list;
}

std::string with_unit(std::string text, Unit unit) {
  const std::string_view name = name_of(unit);
  if (!name.empty()) text.append(", ").append(name);
  return text;
}

template <class Row>
Explanation explain_parameter(const Row& row, const char* what, const ModuleDescription& module) {
  const ParameterColumn& column = row.in(module.id);
  const std::string number = std::to_string(static_cast<int>(row.number));
  Explanation explanation;
  explanation.title = std::string(row.symbol) + " = " + number;
  explanation.lines.push_back(std::string(what) + " " + number + " of the " + module.name + ": " + row.name);
  explanation.lines.emplace_back(row.description);
  explanation.lines.push_back("Range: " + with_unit(range_text(column.minimum, column.maximum), row.unit));
  const units::PhysicalScale scale = units::factory_scale(module);
  explanation.lines.push_back("Default: " + units::number_with_physical_value(row.unit, column.default_value, scale));
  explanation.lines.push_back("Access: " + describe(column.access));
  return explanation;
}

const char* describe(Where where) {
  switch (where) {
    case Where::direct_and_program:
      return "In programs and in direct mode.";
    case Where::program_only:
      return "In programs only.";
    case Where::direct_only:
      return "In direct mode only.";
  }
  return "";
}

/// As short as it can be read back.
std::string number_text(double number) {
  char text[32];
  const std::to_chars_result end = std::to_chars(text, text + sizeof text, number);
  return {text, end.ptr};
}

/// The range of what SAP and SGP write.
std::string range_of_value(const Command& command, const ModuleDescription& module) {
  if (command.opcode == static_cast<std::uint8_t>(Opcode::sap)) {
    const AxisParameterSpec* const row = find_axis_parameter(command.type, module);
    if (row == nullptr) return {};
    return std::string(row->name) + ": " + range_text(row->in(module.id).minimum, row->in(module.id).maximum);
  }
  const bool sets_module = command.opcode == static_cast<std::uint8_t>(Opcode::sgp) &&
                           static_cast<Bank>(command.motor) == Bank::module_settings;
  const GlobalParameterSpec* const row = sets_module ? find_module_setting(command.type, module) : nullptr;
  if (row == nullptr) return {};
  return std::string(row->name) + ": " + range_text(row->in(module.id).minimum, row->in(module.id).maximum);
}

std::optional<Explanation> explain_global_parameter(const Command& command, const ModuleDescription& module) {
  switch (static_cast<Bank>(command.motor)) {
    case Bank::module_settings:
      if (const GlobalParameterSpec* const row = find_module_setting(command.type, module))
        return explain(*row, module);
      break;
    case Bank::interrupt_settings:
      if (const InterruptSpec* const row = find_interrupt(command.type, module)) return explain(*row);
      break;
    case Bank::user_variables: {
      Explanation explanation;
      explanation.title = "user variable " + std::to_string(command.type);
      explanation.lines.emplace_back(command.type < stored_user_variable_count
                                         ? "Can be stored in the EEPROM with STGP."
                                         : "Cannot be stored in the EEPROM.");
      return explanation;
    }
    case Bank::customer:
      break;
  }
  return std::nullopt;
}

std::optional<Explanation> explain_number(const OperandSpec& operand, const Command& command,
                                          const ModuleDescription& module, const units::PhysicalScale& scale) {
  const std::int32_t value = operand_value(command, operand);
  const std::string text = units::number_with_physical_value(unit_of_operand(operand, command, module), value, scale);
  const std::string range = operand.kind == OperandKind::value ? range_of_value(command, module) : std::string();
  if (text == std::to_string(value) && range.empty()) return std::nullopt;
  Explanation explanation;
  explanation.title = text;
  if (!range.empty()) explanation.lines.push_back(range);
  return explanation;
}

}  // namespace

std::string name_of_operand_kind(OperandKind kind) {
  return names_of(kind).words;
}

std::string describe_operand(const OperandSpec& operand, const ModuleDescription& module) {
  std::string text = name_of_operand_kind(operand.kind) + ": ";
  if (takes_words(operand.kind)) {
    std::string words;
    const KeywordSet set = keywords_of(operand.kind);
    for (std::size_t i = 0; i < set.count; ++i) {
      if (set.words[i].value != set.excluded) add_phrase(words, set.words[i].word);
    }
    return text + words;
  }
  const std::string motors = range_text(0, module.axis_count - 1);
  if (operand.kind == OperandKind::motor) return text + motors;
  if (operand.kind == OperandKind::motor_group) return text + motors + "; anything with COORD";
  if (operand.kind == OperandKind::motor_or_all) return text + motors + "; 255 copies from or to the EEPROM";
  text += range_text(operand.minimum, operand.maximum);
  if (operand.kind == OperandKind::velocity) text = with_unit(text, Unit::internal_velocity);
  if (operand.kind == OperandKind::position) text = with_unit(text, Unit::microsteps);
  if (operand.kind == OperandKind::ticks) text += " times 10 ms; -1 takes the accumulator";
  return text;
}

Explanation explain(const InstructionSpec& instruction, const ModuleDescription& module) {
  Explanation explanation;
  explanation.title = instruction.mnemonic;
  explanation.lines.emplace_back(instruction.description);
  for (std::size_t i = 0; i < operand_count(instruction); ++i) {
    const OperandSpec& operand = instruction.operands[i];
    explanation.title += (i == 0 ? " " : ", ") + name_of_operand_kind(operand.kind);
    explanation.lines.push_back("- " + describe_operand(operand, module));
  }
  explanation.lines.emplace_back(describe(instruction.where));
  if (!contains(instruction.modules, module.id)) {
    explanation.lines.push_back("Not available on the " + lang::describe(module) + ".");
  }
  return explanation;
}

Explanation explain(const FunctionSpec& function) {
  return {std::string(function.name) + "(number)", {function.description}};
}

Explanation explain(const Keyword& word, OperandKind kind) {
  return {std::string(word.word) + " = " + std::to_string(word.value),
          {name_of_operand_kind(kind) + ": " + word.description}};
}

Explanation explain(const Symbol& symbol) {
  if (symbol.kind == SymbolKind::label) {
    return {std::string(symbol.name) + ":", {"label, address " + number_text(symbol.value)}};
  }
  return {std::string(symbol.name) + " = " + number_text(symbol.value), {"constant"}};
}

Explanation explain(const AxisParameterSpec& parameter, const ModuleDescription& module) {
  return explain_parameter(parameter, "axis parameter", module);
}

Explanation explain(const GlobalParameterSpec& parameter, const ModuleDescription& module) {
  return explain_parameter(parameter, "global parameter", module);
}

Explanation explain(const InterruptSpec& interrupt) {
  const std::string number = std::to_string(static_cast<int>(interrupt.number));
  Explanation explanation;
  explanation.title = std::string(interrupt.symbol) + " = " + number;
  explanation.lines.push_back("interrupt " + number + ": " + interrupt.name);
  if (interrupt.setting == InterruptSetting::period) {
    explanation.lines.push_back("Global parameter " + number + " of bank 3: period in ms, 0 off");
  }
  if (interrupt.setting == InterruptSetting::edge) {
    explanation.lines.push_back("Global parameter " + number + " of bank 3: 0 off, 1 rising, 2 falling, 3 both edges");
  }
  return explanation;
}

Explanation explain(const IoPortSpec& port) {
  Explanation explanation;
  explanation.title = "port " + std::to_string(port.port) + " of bank " + std::to_string(static_cast<int>(port.bank));
  explanation.lines.emplace_back(port.description);
  explanation.lines.push_back("Range: " + with_unit(range_text(port.minimum, port.maximum), port.unit));
  explanation.lines.push_back("Access: " + describe(port.access));
  return explanation;
}

std::optional<Explanation> explain_operand(const OperandSpec& operand, const Command& command,
                                           const ModuleDescription& module, const units::PhysicalScale& scale) {
  switch (operand.kind) {
    case OperandKind::axis_parameter:
      if (const AxisParameterSpec* const row = find_axis_parameter(command.type, module)) return explain(*row, module);
      return std::nullopt;
    case OperandKind::global_parameter:
      return explain_global_parameter(command, module);
    case OperandKind::interrupt:
      if (const InterruptSpec* const row = find_interrupt(command.type, module)) return explain(*row);
      return std::nullopt;
    case OperandKind::port:
      if (const IoPortSpec* const row = find_port(command.type, command.motor, module)) return explain(*row);
      return std::nullopt;
    default:
      return explain_number(operand, command, module, scale);
  }
}

}  // namespace opentmcl::lang
