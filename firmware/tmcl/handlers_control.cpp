#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

namespace {

constexpr bool protects_against_writing(std::int32_t protection) {
  return (protection & 2) != 0;
}

/// Type byte of command 135.
enum class ApplicationStatus : std::uint8_t {
  memory_pointer = 0,
  program_counter = 1,
  accumulator = 2,
  x_register = 3
};

/// State in the top byte, where hosts look for it, then the wait flag, then a 16-bit address
/// (docs/decisions/0011-application-status.md).
constexpr std::int32_t pack_status(ProgramMachine::Mode mode, bool waiting, std::uint16_t address) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(mode) << 24 | (waiting ? 1U : 0U) << 16 | address);
}

/// Writes `digits` decimal digits.
void put_decimal(std::uint8_t* text, unsigned number, unsigned digits) {
  while (digits > 0) {
    text[--digits] = static_cast<std::uint8_t>('0' + number % 10);
    number /= 10;
  }
}

}  // namespace

Outcome Handlers::stop_application(Executor& executor, const Command& command) {
  parts(executor).machine.stop();
  return done(command);
}

Outcome Handlers::run_application(Executor& executor, const Command& command) {
  constexpr std::uint8_t from_current_address = 0;
  if (command.type == from_current_address) {
    parts(executor).machine.run();
    return done(command);
  }
  if (!is_jump_target(executor, command.value)) return with_status(Status::invalid_value, command);
  parts(executor).machine.run_from(static_cast<std::uint16_t>(command.value));
  return done(command);
}

Outcome Handlers::step_application(Executor& executor, const Command& command) {
  parts(executor).machine.step();
  return done(command);
}

Outcome Handlers::reset_application(Executor& executor, const Command& command) {
  parts(executor).machine.reset();
  return done(command);
}

Outcome Handlers::enter_download_mode(Executor& executor, const Command& command) {
  if (!is_jump_target(executor, command.value)) return with_status(Status::invalid_value, command);
  if (protects_against_writing(parts(executor).global_parameters[GlobalParameter::code_protection])) {
    return with_status(Status::eeprom_write_protected, command);
  }
  // A program that changes under its own feet would do anything: it stops.
  parts(executor).machine.stop();
  parts(executor).memory.begin_download();
  executor.download_mode_ = true;
  executor.download_address_ = static_cast<std::uint16_t>(command.value);
  return done(command);
}

Outcome Handlers::exit_download_mode(Executor& executor, const Command& command) {
  if (!executor.download_mode_) return done(command);
  if (parts(executor).memory.end_download() == ProgramMemory::Access::busy) {
    return {Status::ok, 0, Outcome::Form::busy};
  }
  executor.download_mode_ = false;
  return done(command);
}

/// Special reply: the instruction behind the host address, then the sum of all of them. A program that is protected
/// against reading reads as zeros (docs/decisions/0007-special-replies.md).
Outcome Handlers::read_program_memory(Executor& executor, const Command& command) {
  if (!is_jump_target(executor, command.value)) return with_status(Status::invalid_value, command);
  Command instruction;
  if (parts(executor).memory.read(static_cast<std::uint16_t>(command.value), instruction) ==
      ProgramMemory::Access::busy) {
    return {Status::ok, 0, Outcome::Form::busy};
  }
  if (parts(executor).global_parameters.hides_program()) instruction = {};
  std::uint8_t* bytes = executor.special_reply_;
  bytes[0] = instruction.opcode;
  bytes[1] = instruction.type;
  bytes[2] = instruction.motor;
  put_int32(bytes + 3, instruction.value);
  auto sum = static_cast<unsigned>(parts(executor).global_parameters[GlobalParameter::serial_host_address]);
  for (std::size_t i = 0; i < 7; ++i) sum += bytes[i];
  bytes[7] = static_cast<std::uint8_t>(sum);
  return {Status::ok, 0, Outcome::Form::special};
}

Outcome Handlers::get_application_status(Executor& executor, const Command& command) {
  const ProgramMachine& machine = parts(executor).machine;
  Outcome outcome = done(command);
  switch (static_cast<ApplicationStatus>(command.type)) {
    case ApplicationStatus::memory_pointer:
      outcome.value = pack_status(machine.mode(), machine.is_waiting(), executor.download_address_);
      break;
    case ApplicationStatus::program_counter:
      outcome.value = pack_status(machine.mode(), machine.is_waiting(), machine.program_counter());
      break;
    case ApplicationStatus::accumulator:
      outcome.value = machine.registers.accumulator;
      break;
    case ApplicationStatus::x_register:
      outcome.value = machine.registers.x;
      break;
  }
  return outcome;
}

/// Type 0: eight characters such as "1161V147" in place of the usual bytes, without checksum. Type 1: type number in
/// the upper, version in the lower half of the value.
Outcome Handlers::get_firmware_version(Executor& executor, const Command& command) {
  const ModuleDescription& module = parts(executor).description;
  constexpr std::uint8_t as_text = 0;
  if (command.type != as_text) {
    return {Status::ok,
            static_cast<std::int32_t>(static_cast<std::uint32_t>(module.type_number) << 16 |
                                      static_cast<std::uint32_t>(module.firmware_major) << 8 | module.firmware_minor),
            Outcome::Form::normal};
  }
  std::uint8_t* text = executor.special_reply_;
  put_decimal(text, module.type_number, 4);
  text[4] = 'V';
  put_decimal(text + 5, module.firmware_major, 1);
  put_decimal(text + 6, module.firmware_minor, 2);
  return {Status::ok, 0, Outcome::Form::special};
}

Outcome Handlers::restore_factory_settings(Executor& executor, const Command& command) {
  if (parts(executor).global_parameters.is_locked()) return with_status(Status::eeprom_locked, command);
  executor.restore_factory_settings();
  return {Status::ok, command.value, Outcome::Form::silent};
}

Outcome Handlers::request_position_reached(Executor& executor, const Command& command) {
  constexpr std::uint8_t next_only = 0;
  if ((command.value & 1) == 0) {
    executor.position_report_ = Executor::PositionReport::none;
  } else {
    executor.position_report_ =
        command.type == next_only ? Executor::PositionReport::next_move : Executor::PositionReport::every_move;
  }
  executor.reported_move_ = false;
  return done(command);
}

/// The line it came from is the module's affair, which also knows whether that line can be text.
Outcome Handlers::enter_ascii_mode(Executor&, const Command& command) {
  return {Status::ok, command.value, Outcome::Form::mode_change};
}

Outcome Handlers::software_reset(Executor& executor, const Command& command) {
  executor.wants_restart_ = true;
  return done(command);
}

Outcome Handlers::user_function(Executor& executor, const Command& command) {
  const Extensions& extensions = parts(executor).extensions;
  const auto number = static_cast<std::size_t>(command.opcode - static_cast<std::uint8_t>(Opcode::uf0));
  const Extensions::UserFunction function = extensions.user_functions[number];
  return function != nullptr ? function(extensions.context, command) : invalid_command(executor, command);
}

Outcome Handlers::invalid_command(Executor&, const Command& command) {
  return with_status(Status::invalid_command, command);
}

Outcome Handlers::wrong_type(Executor&, const Command& command) {
  return with_status(Status::wrong_type, command);
}

Outcome Handlers::invalid_value(Executor&, const Command& command) {
  return with_status(Status::invalid_value, command);
}

Outcome Handlers::not_available(Executor&, const Command& command) {
  return with_status(Status::command_not_available, command);
}

}  // namespace opentmcl
