#include "firmware/spec/io_ports.hpp"
#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

namespace {

/// What the executor needs of the port table: the strings stay out of the firmware.
struct PortRow {
  IoBank bank;
  std::uint8_t port;
  IoLine line;
  std::uint8_t index;
  Access access;
  Modules modules;
};

struct PortRows {
  PortRow rows[io_port_count];
};

consteval PortRows make_port_rows() {
  PortRows result{};
  for (std::size_t i = 0; i < io_port_count; ++i) {
    const IoPortSpec& row = io_ports[i];
    result.rows[i] = {row.bank, row.port, row.line, row.index, row.access, row.modules};
  }
  return result;
}

constexpr PortRows port_rows = make_port_rows();

/// Bits of all general purpose inputs or outputs a module has.
consteval std::uint32_t line_mask(ModuleId module, IoLine line) {
  std::uint32_t mask = 0;
  for (const IoPortSpec& row : io_ports) {
    if (row.line == line && contains(row.modules, module)) mask |= 1U << row.index;
  }
  return mask;
}

constexpr std::uint32_t input_masks[module_count] = {line_mask(ModuleId::tmcm1110, IoLine::input),
                                                     line_mask(ModuleId::pd1161, IoLine::input)};
constexpr std::uint32_t output_masks[module_count] = {line_mask(ModuleId::tmcm1110, IoLine::output),
                                                      line_mask(ModuleId::pd1161, IoLine::output)};

bool is_bank(std::uint8_t bank) {
  return bank <= static_cast<std::uint8_t>(IoBank::digital_outputs);
}

const PortRow* find_port(ModuleId module, std::uint8_t bank, std::uint8_t port) {
  for (const PortRow& row : port_rows.rows) {
    if (static_cast<std::uint8_t>(row.bank) == bank && row.port == port && contains(row.modules, module)) return &row;
  }
  return nullptr;
}

}  // namespace

Outcome Handlers::set_axis_parameter(Executor& executor, const Command& command) {
  return with_status(parts(executor).axis_parameters.set(command.type, command.value), command);
}

Outcome Handlers::get_axis_parameter(Executor& executor, const Command& command) {
  Outcome outcome = result(command.value);
  outcome.status = parts(executor).axis_parameters.get(command.type, outcome.value);
  return outcome;
}

Outcome Handlers::store_axis_parameter(Executor& executor, const Command& command) {
  const bool is_locked = parts(executor).global_parameters.is_locked();
  return with_status(parts(executor).axis_parameters.store(command.type, is_locked), command);
}

Outcome Handlers::restore_axis_parameter(Executor& executor, const Command& command) {
  return with_status(parts(executor).axis_parameters.restore(command.type), command);
}

Outcome Handlers::accumulator_to_axis_parameter(Executor& executor, const Command& command) {
  return with_status(parts(executor).axis_parameters.set(command.type, registers(executor).accumulator), command);
}

Status Handlers::set_global(Executor& executor, std::uint8_t number, std::uint8_t bank, std::int32_t value) {
  GlobalParameterAccess& globals = parts(executor).global_parameters;
  if (bank != static_cast<std::uint8_t>(Bank::module_settings)) {
    const Extensions& extensions = parts(executor).extensions;
    const bool is_extension = bank == static_cast<std::uint8_t>(Bank::customer) && extensions.set_variable != nullptr;
    return is_extension ? extensions.set_variable(extensions.context, number, value) : globals.set(number, bank, value);
  }
  switch (static_cast<GlobalParameter>(number)) {
    case GlobalParameter::tick_timer: {
      const Status status = globals.check(number, Access::w, value);
      // The timer is a difference: where it reads `value` now it read 0 that many milliseconds ago.
      if (status == Status::ok) {
        executor.tick_timer_zero_ = executor.now_ - static_cast<Microseconds>(value) * one_millisecond;
      }
      return status;
    }
    case GlobalParameter::random_number: {
      const Status status = globals.check(number, Access::w, value);
      if (status == Status::ok) executor.random_state_ = static_cast<std::uint32_t>(value) | 1U << 31;
      return status;
    }
    case GlobalParameter::code_protection: {
      const bool was_hidden = globals.hides_program();
      const Status status = globals.set(number, bank, value);
      // Who lifts the protection against reading must not find the program.
      if (status == Status::ok && was_hidden && !globals.hides_program()) {
        parts(executor).machine.stop();
        parts(executor).memory.erase();
      }
      return status;
    }
    default:
      return globals.set(number, bank, value);
  }
}

Outcome Handlers::set_global_parameter(Executor& executor, const Command& command) {
  return with_status(set_global(executor, command.type, command.motor, command.value), command);
}

Outcome Handlers::accumulator_to_global_parameter(Executor& executor, const Command& command) {
  return with_status(set_global(executor, command.type, command.motor, registers(executor).accumulator), command);
}

Outcome Handlers::get_global_parameter(Executor& executor, const Command& command) {
  Outcome outcome = result(command.value);
  const Extensions& extensions = parts(executor).extensions;
  if (command.motor == static_cast<std::uint8_t>(Bank::customer) && extensions.get_variable != nullptr) {
    outcome.status = extensions.get_variable(extensions.context, command.type, outcome.value);
    return outcome;
  }
  outcome.status = parts(executor).global_parameters.get(command.type, command.motor, outcome.value);
  if (outcome.status != Status::ok || command.motor != static_cast<std::uint8_t>(Bank::module_settings)) return outcome;
  const ProgramMachine& machine = parts(executor).machine;
  switch (static_cast<GlobalParameter>(command.type)) {
    case GlobalParameter::application_status:
      outcome.value = static_cast<std::int32_t>(machine.mode());
      break;
    case GlobalParameter::download_mode:
      outcome.value = executor.download_mode_ ? 1 : 0;
      break;
    case GlobalParameter::program_counter:
      // A program that asks finds the address of the instruction that asks.
      outcome.value = machine.program_counter() - (executor.source_ == Executor::Source::program ? 1 : 0);
      break;
    case GlobalParameter::tick_timer: {
      const Microseconds elapsed = executor.now_ - executor.tick_timer_zero_;
      outcome.value = static_cast<std::int32_t>(elapsed / one_millisecond & int32_maximum);
      break;
    }
    case GlobalParameter::random_number:
      // xorshift32: a good spread from three shifts, and never 0.
      executor.random_state_ ^= executor.random_state_ << 13;
      executor.random_state_ ^= executor.random_state_ >> 17;
      executor.random_state_ ^= executor.random_state_ << 5;
      outcome.value = static_cast<std::int32_t>(executor.random_state_ & static_cast<std::uint32_t>(int32_maximum));
      break;
    default:
      break;
  }
  return outcome;
}

Outcome Handlers::store_global_parameter(Executor& executor, const Command& command) {
  return with_status(parts(executor).global_parameters.store(command.type, command.motor), command);
}

Outcome Handlers::restore_global_parameter(Executor& executor, const Command& command) {
  return with_status(parts(executor).global_parameters.restore(command.type, command.motor), command);
}

Outcome Handlers::set_output(Executor& executor, const Command& command) {
  if (!is_bank(command.motor)) return with_status(Status::invalid_value, command);
  const ModuleId module = parts(executor).description.id;
  const PortRow* row = find_port(module, command.motor, command.type);
  if (row == nullptr || !allows(row->access, Access::w)) return with_status(Status::wrong_type, command);

  if (row->line == IoLine::all_outputs) {
    const std::int32_t value = command.value == -1 ? registers(executor).accumulator : command.value;
    // -1 takes whatever the accumulator holds; its bits beyond the outputs mean nothing.
    if (command.value != -1 && (value < 0 || value > 255)) return with_status(Status::invalid_value, command);
    const std::uint32_t mask = output_masks[static_cast<std::size_t>(module)];
    executor.set_outputs((executor.outputs_ & ~mask) | (static_cast<std::uint32_t>(value) & mask));
    return done(command);
  }
  if (command.value != 0 && command.value != 1) return with_status(Status::invalid_value, command);
  // Bank 0, port 0 of the PD-1161 reads IN0 and writes the pull-up resistors.
  const std::uint32_t pin = row->line == IoLine::output ? 1U << row->index : bit(hal::OutputPin::pull_ups);
  executor.set_outputs(command.value != 0 ? executor.outputs_ | pin : executor.outputs_ & ~pin);
  return done(command);
}

Outcome Handlers::get_input(Executor& executor, const Command& command) {
  if (!is_bank(command.motor)) return with_status(Status::invalid_value, command);
  const ModuleId module = parts(executor).description.id;
  const PortRow* row = find_port(module, command.motor, command.type);
  if (row == nullptr) return with_status(Status::wrong_type, command);

  const auto module_index = static_cast<std::size_t>(module);
  hal::Analog& analog = parts(executor).analog;
  Outcome outcome = result(command.value);
  switch (row->line) {
    case IoLine::input:
      outcome.value = static_cast<std::int32_t>(parts(executor).pins.inputs() >> row->index & 1);
      break;
    case IoLine::all_inputs:
      outcome.value = static_cast<std::int32_t>(parts(executor).pins.inputs() & input_masks[module_index]);
      break;
    case IoLine::encoder_null:
      outcome.value = (parts(executor).pins.inputs() & bit(hal::InputPin::encoder_null)) != 0 ? 1 : 0;
      break;
    case IoLine::output:
      outcome.value = static_cast<std::int32_t>(executor.outputs_ >> row->index & 1);
      break;
    case IoLine::all_outputs:
      outcome.value = static_cast<std::int32_t>(executor.outputs_ & output_masks[module_index]);
      break;
    case IoLine::pull_ups:
      outcome.value = (executor.outputs_ & bit(hal::OutputPin::pull_ups)) != 0 ? 1 : 0;
      break;
    case IoLine::analog:
      outcome.value = analog.read(hal::AnalogInput::ain0);
      break;
    case IoLine::supply_voltage:
      outcome.value = analog.read(hal::AnalogInput::supply_voltage);
      break;
    case IoLine::temperature:
      outcome.value = analog.read(hal::AnalogInput::temperature);
      break;
    case IoLine::motor_supply_counts:
      outcome.value = analog.read(hal::AnalogInput::supply_counts);
      break;
    case IoLine::logic_supply_counts:
      outcome.value = analog.read(hal::AnalogInput::logic_supply);
      break;
  }
  return outcome;
}

}  // namespace opentmcl
