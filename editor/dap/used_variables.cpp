#include "editor/dap/used_variables.hpp"

#include <algorithm>
#include <iterator>

#include "firmware/spec/instructions.hpp"
#include "lang/operand_field.hpp"

namespace opentmcl::editor::dap {

namespace {

bool is_about_variables(const InstructionSpec& row, const Command& command) {
  return std::any_of(std::begin(row.operands), std::end(row.operands), [&](const OperandSpec& operand) {
    return operand.kind == OperandKind::bank &&
           lang::operand_value(command, operand) == static_cast<std::int32_t>(Bank::user_variables);
  });
}

}  // namespace

std::set<std::uint8_t> used_variables(const std::vector<Command>& commands, ModuleId module) {
  std::set<std::uint8_t> numbers;
  for (const Command& command : commands) {
    const InstructionSpec* const row = find_instruction(command.opcode, module);
    if (row == nullptr) continue;
    for (const OperandSpec& operand : row->operands) {
      const bool names_variable = operand.kind == OperandKind::variable ||
                                  (operand.kind == OperandKind::global_parameter && is_about_variables(*row, command));
      const std::int32_t number = lang::operand_value(command, operand);
      if (!names_variable || number < 0 || number >= static_cast<std::int32_t>(user_variable_count)) continue;
      numbers.insert(static_cast<std::uint8_t>(number));
    }
  }
  return numbers;
}

}  // namespace opentmcl::editor::dap
