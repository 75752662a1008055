#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

/// Calculates `left` with `right`; SWAP exchanges them, COMP only sets the flags.
void Handlers::operate(Registers& r, std::uint8_t operation_code, std::int32_t& left, std::int32_t& right) {
  const auto operation = static_cast<Operation>(operation_code);
  switch (operation) {
    case Operation::swap: {
      const std::int32_t old_left = left;
      left = right;
      right = old_left;
      break;
    }
    case Operation::compare:
      r.set_comparison(left, right);
      break;
    default:
      left = calculate(operation, left, right);
      break;
  }
}

/// A register with the user variable the motor byte names. @param other the register
Outcome Handlers::with_variable(Executor& executor, const Command& command, std::int32_t& other,
                                bool variable_is_left) {
  GlobalParameterAccess& globals = parts(executor).global_parameters;
  std::int32_t variable = globals.variable(command.motor);
  if (variable_is_left) {
    operate(registers(executor), command.type, variable, other);
  } else {
    operate(registers(executor), command.type, other, variable);
  }
  globals.set_variable(command.motor, variable);
  return done(command);
}

/// The reply of CALCVV is the one the manual prints: value 0 (PD-1161 manual 3.7.36).
Outcome Handlers::variable_with_variable(Executor& executor, const Command& command) {
  GlobalParameterAccess& globals = parts(executor).global_parameters;
  const auto second = static_cast<std::uint8_t>(command.value);
  std::int32_t left = globals.variable(command.motor);
  std::int32_t right = globals.variable(second);
  operate(registers(executor), command.type, left, right);
  // Right first: of a variable with itself the result is what the left side says.
  globals.set_variable(second, right);
  globals.set_variable(command.motor, left);
  return {Status::ok, 0, Outcome::Form::normal};
}

Outcome Handlers::variable_with_accumulator(Executor& executor, const Command& command) {
  return with_variable(executor, command, registers(executor).accumulator, true);
}

Outcome Handlers::accumulator_with_variable(Executor& executor, const Command& command) {
  return with_variable(executor, command, registers(executor).accumulator, false);
}

Outcome Handlers::variable_with_x(Executor& executor, const Command& command) {
  return with_variable(executor, command, registers(executor).x, true);
}

Outcome Handlers::x_with_variable(Executor& executor, const Command& command) {
  return with_variable(executor, command, registers(executor).x, false);
}

/// NOT inverts the variable and ignores the value (PD-1161 manual 3.7.41); SWAP does not exist here.
Outcome Handlers::variable_with_value(Executor& executor, const Command& command) {
  GlobalParameterAccess& globals = parts(executor).global_parameters;
  std::int32_t variable = globals.variable(command.motor);
  const bool inverts = static_cast<Operation>(command.type) == Operation::bitwise_not;
  std::int32_t value = inverts ? variable : command.value;
  operate(registers(executor), command.type, variable, value);
  globals.set_variable(command.motor, variable);
  return done(command);
}

namespace {

/// An index outside 0…255 makes the instruction do nothing (PD-1161 manual 3.7.48).
constexpr bool is_variable(std::int32_t index) {
  return index >= 0 && index < static_cast<std::int32_t>(user_variable_count);
}

}  // namespace

Outcome Handlers::set_indexed_variable(Executor& executor, const Command& command) {
  const std::int32_t index = registers(executor).x;
  if (is_variable(index)) {
    parts(executor).global_parameters.set_variable(static_cast<std::uint8_t>(index), command.value);
  }
  return done(command);
}

Outcome Handlers::get_indexed_variable(Executor& executor, const Command& command) {
  const std::int32_t index = registers(executor).x;
  if (!is_variable(index)) return done(command);
  return result(parts(executor).global_parameters.variable(static_cast<std::uint8_t>(index)));
}

Outcome Handlers::accumulator_to_indexed_variable(Executor& executor, const Command& command) {
  const std::int32_t index = registers(executor).x;
  if (is_variable(index)) {
    parts(executor).global_parameters.set_variable(static_cast<std::uint8_t>(index), registers(executor).accumulator);
  }
  return done(command);
}

}  // namespace opentmcl
