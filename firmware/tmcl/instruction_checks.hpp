// What is checked before an instruction is executed, derived from the instruction table: fields out of range never
// reach a handler. Order and status codes: motor first (4), then type (3), then value (4).
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/lookup.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

inline constexpr RowIndex instruction_rows =
    make_row_index(instructions, [](const InstructionSpec& row) { return row.opcode; });

constexpr std::size_t row_of(Opcode opcode) {
  return instruction_rows[static_cast<std::uint8_t>(opcode)];
}

/// Motor byte of instructions that work on all motors or on the EEPROM copy (SCO, GCO).
inline constexpr std::uint8_t all_motors = 255;

struct InstructionCheck {
  enum class Motor : std::uint8_t { any, motor, motor_or_all };

  Modules modules;
  Where where;
  Motor motor;
  std::uint8_t maximum_type;
  std::int16_t excluded_type;  ///< or -1
  std::int32_t minimum_value;
  std::int32_t maximum_value;
};

struct InstructionChecks {
  InstructionCheck rows[instruction_count];
};

consteval InstructionChecks make_instruction_checks() {
  InstructionChecks checks{};
  for (std::size_t row = 0; row < instruction_count; ++row) {
    const InstructionSpec& spec = instructions[row];
    InstructionCheck check{spec.modules,  spec.where,   InstructionCheck::Motor::any, 255, -1,
                           int32_minimum, int32_maximum};
    for (const OperandSpec& operand : spec.operands) {
      switch (operand.field) {
        case Field::type:
          check.maximum_type = static_cast<std::uint8_t>(operand.maximum);
          check.excluded_type = static_cast<std::int16_t>(keywords_of(operand.kind).excluded);
          break;
        case Field::motor:
          if (operand.kind == OperandKind::motor) check.motor = InstructionCheck::Motor::motor;
          if (operand.kind == OperandKind::motor_or_all) check.motor = InstructionCheck::Motor::motor_or_all;
          break;
        case Field::value:
          check.minimum_value = operand.minimum;
          check.maximum_value = operand.maximum;
          break;
        case Field::none:
          break;
      }
    }
    checks.rows[row] = check;
  }
  return checks;
}

inline constexpr InstructionChecks instruction_checks = make_instruction_checks();

constexpr Status check_fields(const InstructionCheck& check, const Command& command, std::uint8_t axis_count) {
  if (check.motor != InstructionCheck::Motor::any && command.motor >= axis_count &&
      (check.motor != InstructionCheck::Motor::motor_or_all || command.motor != all_motors)) {
    return Status::invalid_value;
  }
  if (command.type > check.maximum_type || command.type == check.excluded_type) return Status::wrong_type;
  if (command.value < check.minimum_value || command.value > check.maximum_value) return Status::invalid_value;
  return Status::ok;
}

}  // namespace opentmcl
