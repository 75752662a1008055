// What a ValueExpression is inside: the tree that was made of its text.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "client/error.hpp"
#include "debug/program.hpp"
#include "debug/value_expression.hpp"
#include "firmware/spec/instructions.hpp"
#include "lang/expression.hpp"

namespace opentmcl::debug {

enum class Operation : std::uint8_t {
  number,
  accumulator,
  x_register,
  program_counter,
  read,
  function,
  negate,
  invert,
  power,
  multiply,
  divide,
  add,
  subtract,
  less,
  at_most,
  equal,
  unequal,
  at_least,
  greater,
  both,
  either,
};

struct ValueExpression::Node {
  Operation operation = Operation::number;
  double number = 0;                             ///< of number
  const lang::FunctionSpec* function = nullptr;  ///< of function
  const InstructionSpec* read = nullptr;         ///< of read; nullptr: VAR
  std::vector<std::unique_ptr<Node>> operands = {};

  client::Result<double> evaluate(ValueSource& source) const;

 private:
  client::Result<double> evaluate_read(ValueSource& source) const;
  client::Result<double> evaluate_operation(ValueSource& source) const;
};

/// The tree of a text (debug/value_expression.hpp has its grammar). Error: usage, with the place in the text.
client::Result<std::unique_ptr<ValueExpression::Node>> parse_value(std::string_view text, const Program& program);

}  // namespace opentmcl::debug
