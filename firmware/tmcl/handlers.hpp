#pragma once

#include "firmware/tmcl/arithmetic.hpp"
#include "firmware/tmcl/dispatch.hpp"
#include "firmware/tmcl/executor.hpp"

namespace opentmcl {

/// One handler for each instruction, for hosts and programs alike. When a handler runs, the fields of the command have
/// passed DispatchEntry::check_fields(); `value` of the outcome starts as the value of the command, which is what a
/// reply carries when the instruction returns nothing of its own.
struct Handlers {
  // Motion: handlers_motion.cpp
  static Outcome rotate_right(Executor& executor, const Command& command);
  static Outcome rotate_left(Executor& executor, const Command& command);
  static Outcome motor_stop(Executor& executor, const Command& command);
  static Outcome move_to_position(Executor& executor, const Command& command);
  static Outcome reference_search(Executor& executor, const Command& command);
  static Outcome set_coordinate(Executor& executor, const Command& command);
  static Outcome get_coordinate(Executor& executor, const Command& command);
  static Outcome capture_coordinate(Executor& executor, const Command& command);
  static Outcome accumulator_to_coordinate(Executor& executor, const Command& command);
  static Outcome move_to_accumulator(Executor& executor, const Command& command);
  static Outcome rotate_left_accumulator(Executor& executor, const Command& command);
  static Outcome rotate_right_accumulator(Executor& executor, const Command& command);

  // Parameters and ports: handlers_parameters.cpp
  static Outcome set_axis_parameter(Executor& executor, const Command& command);
  static Outcome get_axis_parameter(Executor& executor, const Command& command);
  static Outcome store_axis_parameter(Executor& executor, const Command& command);
  static Outcome restore_axis_parameter(Executor& executor, const Command& command);
  static Outcome set_global_parameter(Executor& executor, const Command& command);
  static Outcome get_global_parameter(Executor& executor, const Command& command);
  static Outcome store_global_parameter(Executor& executor, const Command& command);
  static Outcome restore_global_parameter(Executor& executor, const Command& command);
  static Outcome accumulator_to_axis_parameter(Executor& executor, const Command& command);
  static Outcome accumulator_to_global_parameter(Executor& executor, const Command& command);
  static Outcome set_output(Executor& executor, const Command& command);
  static Outcome get_input(Executor& executor, const Command& command);

  // Calculation and program flow: handlers_program.cpp
  static Outcome calculate_accumulator(Executor& executor, const Command& command);
  static Outcome calculate_x(Executor& executor, const Command& command);
  static Outcome compare(Executor& executor, const Command& command);
  static Outcome jump_conditional(Executor& executor, const Command& command);
  static Outcome jump(Executor& executor, const Command& command);
  static Outcome call(Executor& executor, const Command& command);
  static Outcome call_conditional(Executor& executor, const Command& command);
  static Outcome return_from_subroutine(Executor& executor, const Command& command);
  static Outcome wait(Executor& executor, const Command& command);
  static Outcome stop(Executor& executor, const Command& command);
  static Outcome clear_error_flags(Executor& executor, const Command& command);
  static Outcome restart(Executor& executor, const Command& command);
  static Outcome decrement_and_jump(Executor& executor, const Command& command);
  static Outcome enable_interrupt(Executor& executor, const Command& command);
  static Outcome disable_interrupt(Executor& executor, const Command& command);
  static Outcome set_interrupt_vector(Executor& executor, const Command& command);
  static Outcome return_from_interrupt(Executor& executor, const Command& command);

  // User variables: handlers_variables.cpp
  static Outcome variable_with_variable(Executor& executor, const Command& command);
  static Outcome variable_with_accumulator(Executor& executor, const Command& command);
  static Outcome accumulator_with_variable(Executor& executor, const Command& command);
  static Outcome variable_with_x(Executor& executor, const Command& command);
  static Outcome x_with_variable(Executor& executor, const Command& command);
  static Outcome variable_with_value(Executor& executor, const Command& command);
  static Outcome set_indexed_variable(Executor& executor, const Command& command);
  static Outcome get_indexed_variable(Executor& executor, const Command& command);
  static Outcome accumulator_to_indexed_variable(Executor& executor, const Command& command);

  // Control commands: handlers_control.cpp
  static Outcome stop_application(Executor& executor, const Command& command);
  static Outcome run_application(Executor& executor, const Command& command);
  static Outcome step_application(Executor& executor, const Command& command);
  static Outcome reset_application(Executor& executor, const Command& command);
  static Outcome enter_download_mode(Executor& executor, const Command& command);
  static Outcome exit_download_mode(Executor& executor, const Command& command);
  static Outcome read_program_memory(Executor& executor, const Command& command);
  static Outcome get_application_status(Executor& executor, const Command& command);
  static Outcome get_firmware_version(Executor& executor, const Command& command);
  static Outcome restore_factory_settings(Executor& executor, const Command& command);
  static Outcome request_position_reached(Executor& executor, const Command& command);
  static Outcome enter_ascii_mode(Executor& executor, const Command& command);
  static Outcome software_reset(Executor& executor, const Command& command);

  /// UF0 to UF7: what the board makes of them.
  static Outcome user_function(Executor& executor, const Command& command);

  // Refusals, for what is known without looking at the state of the module: handlers_control.cpp
  static Outcome invalid_command(Executor& executor, const Command& command);
  static Outcome wrong_type(Executor& executor, const Command& command);
  static Outcome invalid_value(Executor& executor, const Command& command);
  /// Exists, but not in the present state of the module.
  static Outcome not_available(Executor& executor, const Command& command);

 private:
  // What several handlers share. Private members of the executor are reachable here and nowhere else.
  static Executor::Parts& parts(Executor& executor) { return executor.parts_; }
  static Registers& registers(Executor& executor) { return executor.parts_.machine.registers; }
  static Outcome done(const Command& command) { return {Status::ok, command.value, Outcome::Form::normal}; }
  static Outcome result(std::int32_t value) { return {Status::ok, value, Outcome::Form::result}; }
  static Outcome with_status(Status status, const Command& command) {
    return {status, command.value, Outcome::Form::normal};
  }
  static Outcome rotate(Executor& executor, const Command& command, std::int32_t velocity);
  static Outcome move(Executor& executor, const Command& command, std::int32_t operand);
  static Status set_global(Executor& executor, std::uint8_t number, std::uint8_t bank, std::int32_t value);
  static bool condition_holds(const Registers& registers, std::uint8_t condition);
  static bool is_jump_target(Executor& executor, std::int32_t address);
  static std::uint8_t interrupt_row(Executor& executor, std::uint8_t number);
  static void operate(Registers& registers, std::uint8_t operation, std::int32_t& left, std::int32_t& right);
  static Outcome with_variable(Executor& executor, const Command& command, std::int32_t& other, bool variable_is_left);
};

}  // namespace opentmcl
