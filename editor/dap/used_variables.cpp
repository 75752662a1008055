#include "editor/dap/used_variables.hpp"

#include <algorithm>
#include <iterator>

#include "firmware/spec/instructions.hpp"

namespace opentmcl::editor::dap {

namespace {

std::int32_t number_in(Field field, const Command& command) {
  switch (field) {
    case Field::type:
      return command.type;
    case Field::motor:
      return command.motor;
    case Field::value:
      return command.value;
    case Field::none:
      break;
  }
  return 0;
}

bool is_about_variables(const InstructionSpec& row, const Command& command) {
  return std::any_of(std::begin(row.operands), std::end(row.operands), [&](const OperandSpec& operand) {
    return operand.kind == OperandKind::bank &&
           number_in(operand.field, command) == static_cast<std::int32_t>(Bank::user_variables);
  });
}

}  // namespace

std::set<std::uint8_t> used_variables(const std::vector<Command>& commands) {
  std::set<std::uint8_t> numbers;
  for (const Command& command : commands) {
    const auto row = std::find_if(std::begin(instructions), std::end(instructions), [&](const InstructionSpec& spec) {
      return static_cast<std::uint8_t>(spec.opcode) == command.opcode;
    });
    if (row == std::end(instructions)) continue;
    for (const OperandSpec& operand : row->operands) {
      const bool names_variable = operand.kind == OperandKind::variable ||
                                  (operand.kind == OperandKind::global_parameter && is_about_variables(*row, command));
      const std::int32_t number = number_in(operand.field, command);
      if (!names_variable || number < 0 || number >= static_cast<std::int32_t>(user_variable_count)) continue;
      numbers.insert(static_cast<std::uint8_t>(number));
    }
  }
  return numbers;
}

}  // namespace opentmcl::editor::dap
