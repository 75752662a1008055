// The field of an instruction that holds an operand.
#pragma once

#include <cstdint>

#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::lang {

/// The number an instruction carries for an operand.
constexpr std::int32_t operand_value(const Command& command, const OperandSpec& operand) {
  switch (operand.field) {
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

/// @param value one the field can hold: 0…255 unless it is Field::value
constexpr void set_operand_value(Command& command, const OperandSpec& operand, std::int32_t value) {
  switch (operand.field) {
    case Field::type:
      command.type = static_cast<std::uint8_t>(value);
      break;
    case Field::motor:
      command.motor = static_cast<std::uint8_t>(value);
      break;
    case Field::value:
      command.value = value;
      break;
    case Field::none:
      break;
  }
}

}  // namespace opentmcl::lang
