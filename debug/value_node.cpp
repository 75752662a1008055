// The value of an expression.

#include "debug/value_node.hpp"

#include <cmath>
#include <string>

#include "debug/mistake.hpp"
#include "lang/instruction_table.hpp"
#include "lang/operand_field.hpp"

namespace opentmcl::debug {

using client::Result;
using Node = ValueExpression::Node;

namespace {

bool is_truth(double value) {
  return value != 0;
}

Result<double> widened(const Result<std::int32_t>& value) {
  if (!value) return value.error();
  return static_cast<double>(*value);
}

}  // namespace

Result<double> Node::evaluate(ValueSource& source) const {
  switch (operation) {
    case Operation::number:
      return number;
    case Operation::accumulator:
      return widened(source.accumulator());
    case Operation::x_register:
      return widened(source.x_register());
    case Operation::program_counter:
      return widened(source.program_counter());
    case Operation::read:
      return evaluate_read(source);
    default:
      return evaluate_operation(source);
  }
}

Result<double> Node::evaluate_read(ValueSource& source) const {
  Command command;
  // A user variable is a global parameter of its bank.
  const InstructionSpec& row = read != nullptr ? *read : *lang::find_mnemonic("GGP");
  command.opcode = static_cast<std::uint8_t>(row.opcode);
  if (read == nullptr) {
    lang::set_operand_value(command, row.operands[1], static_cast<std::int32_t>(Bank::user_variables));
  }
  for (std::size_t i = 0; i < operands.size(); ++i) {
    Result<double> value = operands[i]->evaluate(source);
    if (!value) return value;
    const OperandSpec& operand = row.operands[i];
    if (*value != std::floor(*value) || *value < operand.minimum || *value > operand.maximum) {
      return mistake(std::string(row.mnemonic) + " takes whole numbers from " + std::to_string(operand.minimum) +
                     " to " + std::to_string(operand.maximum) + " there, not " + value_text(*value));
    }
    lang::set_operand_value(command, operand, static_cast<std::int32_t>(*value));
  }
  return widened(source.read(command));
}

Result<double> Node::evaluate_operation(ValueSource& source) const {
  Result<double> first = operands[0]->evaluate(source);
  if (!first) return first;
  const double left = *first;
  if (operation == Operation::both && !is_truth(left)) return 0.0;
  if (operation == Operation::either && is_truth(left)) return 1.0;
  double right = 0;
  if (operands.size() > 1) {
    Result<double> second = operands[1]->evaluate(source);
    if (!second) return second;
    right = *second;
  }
  double value = 0;
  switch (operation) {
    case Operation::function:
      value = function->apply(left);
      break;
    case Operation::negate:
      value = -left;
      break;
    case Operation::invert:
      value = is_truth(left) ? 0 : 1;
      break;
    case Operation::power:
      value = std::pow(left, right);
      break;
    case Operation::multiply:
      value = left * right;
      break;
    case Operation::divide:
      if (right == 0) return mistake("division by zero");
      value = left / right;
      break;
    case Operation::add:
      value = left + right;
      break;
    case Operation::subtract:
      value = left - right;
      break;
    case Operation::less:
      value = left < right ? 1 : 0;
      break;
    case Operation::at_most:
      value = left <= right ? 1 : 0;
      break;
    case Operation::equal:
      value = left == right ? 1 : 0;
      break;
    case Operation::unequal:
      value = left != right ? 1 : 0;
      break;
    case Operation::at_least:
      value = left >= right ? 1 : 0;
      break;
    case Operation::greater:
      value = left > right ? 1 : 0;
      break;
    default:  // both and either, undecided by their left sides
      value = is_truth(right) ? 1 : 0;
      break;
  }
  if (!std::isfinite(value)) return mistake("the expression has no finite value");
  return value;
}

}  // namespace opentmcl::debug
