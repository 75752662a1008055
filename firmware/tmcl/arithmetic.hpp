// The operations of CALC, CALCX and the instructions on user variables. 32-bit two's complement that wraps; a division
// by zero leaves the left operand as it is (docs/decisions/0009-arithmetic.md).
#pragma once

#include <cstdint>

#include "firmware/spec/parameter_rows.hpp"

namespace opentmcl {

/// Type byte of the calculation instructions; the words are in `operation_words`.
enum class Operation : std::uint8_t {
  add = 0,
  subtract = 1,
  multiply = 2,
  divide = 3,
  modulo = 4,
  bitwise_and = 5,
  bitwise_or = 6,
  bitwise_xor = 7,
  bitwise_not = 8,
  load = 9,
  swap = 10,
  compare = 11,
};

/// Operations 0 to 9. NOT inverts `right`, LOAD returns it.
constexpr std::int32_t calculate(Operation operation, std::int32_t left, std::int32_t right) {
  const auto a = static_cast<std::uint32_t>(left);
  const auto b = static_cast<std::uint32_t>(right);
  switch (operation) {
    case Operation::add:
      return static_cast<std::int32_t>(a + b);
    case Operation::subtract:
      return static_cast<std::int32_t>(a - b);
    case Operation::multiply:
      return static_cast<std::int32_t>(a * b);
    case Operation::divide:
      if (right == 0) return left;
      return right == -1 ? static_cast<std::int32_t>(0 - a) : left / right;
    case Operation::modulo:
      if (right == 0) return left;
      return right == -1 ? 0 : left % right;
    case Operation::bitwise_and:
      return left & right;
    case Operation::bitwise_or:
      return left | right;
    case Operation::bitwise_xor:
      return left ^ right;
    case Operation::bitwise_not:
      return ~right;
    case Operation::load:
      return right;
    default:
      return left;
  }
}

}  // namespace opentmcl
