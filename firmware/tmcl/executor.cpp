#include "firmware/tmcl/executor.hpp"

#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

namespace {

/// Out of line, so that the way to the handler stays a chain of jumps.
[[gnu::noinline]] Outcome refused(Status status, const Command& command) {
  return {status, command.value, Outcome::Form::normal};
}

}  // namespace

Outcome Executor::execute_direct(const Command& command, Microseconds now) {
  if (download_mode_ && !is_control_command(command.opcode)) return store_in_program(command);
  const DispatchEntry& entry = dispatch_[command.opcode];
  if (entry.in_direct_mode != Status::ok) return refused(entry.in_direct_mode, command);
  const Status status = entry.check_fields(command);
  if (status != Status::ok) return refused(status, command);
  source_ = Source::direct;
  now_ = now;
  return entry.handler(*this, command);
}

Outcome Executor::store_in_program(const Command& command) {
  if (download_address_ >= parts_.memory.capacity()) {
    return {Status::program_memory_full, command.value, Outcome::Form::normal};
  }
  if (parts_.memory.write(download_address_, command) == ProgramMemory::Access::busy) {
    return {Status::ok, 0, Outcome::Form::busy};
  }
  ++download_address_;
  return {Status::command_loaded, command.value, Outcome::Form::normal};
}

void Executor::restore_factory_settings() {
  if (parts_.global_parameters.hides_program()) {
    parts_.machine.stop();
    parts_.memory.erase();
  }
  wants_factory_reset_ = true;
  wants_restart_ = true;
}

bool Executor::is_report_wanted() {
  reported_move_ = false;
  if (position_report_ == PositionReport::none) return false;
  if (position_report_ == PositionReport::next_move) position_report_ = PositionReport::none;
  return true;
}

void Executor::set_outputs(std::uint32_t levels) {
  outputs_ = levels;
  parts_.pins.set_outputs(levels);
}

void Executor::note_axis_events(std::uint8_t events) {
  ProgramMachine& machine = parts_.machine;
  const auto happened = [events](AxisEvent event) { return (events & static_cast<std::uint8_t>(event)) != 0; };
  const auto set = [&machine](ErrorFlag flag) { machine.registers.error_flags |= static_cast<std::uint8_t>(flag); };
  if (happened(AxisEvent::deviation)) set(ErrorFlag::deviation);
  if (happened(AxisEvent::position_error)) set(ErrorFlag::position);
  if (happened(AxisEvent::driver_shutdown)) set(ErrorFlag::shutdown);
  if (!machine.is_running()) return;
  if (happened(AxisEvent::stall)) machine.interrupts.raise(row_of(Interrupt::stall_guard));
  if (happened(AxisEvent::deviation)) machine.interrupts.raise(row_of(Interrupt::deviation));
}

void Executor::note_supply_failure() {
  parts_.machine.stop();
  parts_.machine.registers.error_flags |= static_cast<std::uint8_t>(ErrorFlag::external_alarm);
}

void Executor::note_supply_return(bool starts_program) {
  if (!starts_program) return;
  parts_.machine.reset();
  parts_.machine.run_from(0);
  // So the program can tell a return of the supply from power-on.
  parts_.machine.registers.error_flags |= static_cast<std::uint8_t>(ErrorFlag::external_alarm);
}

InterruptController::Lines Executor::interrupt_lines() {
  InterruptController::Lines lines = 0;
  const auto set = [&lines](Interrupt interrupt, bool level) {
    if (level) lines |= InterruptController::bit(row_of(interrupt));
  };
  set(Interrupt::position_reached, parts_.axis.position_reached());
  set(Interrupt::stop_left, parts_.axis.left_switch_active());
  set(Interrupt::stop_right, parts_.axis.right_switch_active());
  constexpr std::size_t first_input = row_of(Interrupt::input_0);
  constexpr std::size_t last_input = row_of(Interrupt::input_5);
  const std::uint32_t inputs = parts_.pins.inputs();
  for (std::size_t row = first_input; row <= last_input; ++row) {
    if ((inputs >> (row - first_input) & 1) != 0) lines |= InterruptController::bit(row);
  }
  return lines;
}

/// @return when the next turn is needed
Microseconds Executor::run_program(Microseconds now) {
  ProgramMachine& machine = parts_.machine;

  if (machine.interrupts.is_active()) {
    machine.interrupts.observe(now, interrupt_lines(), parts_.global_parameters);
    std::uint16_t vector = 0;
    if (!machine.is_in_interrupt() && machine.interrupts.take(vector)) machine.enter_interrupt(vector);
  }

  if (machine.program_counter() >= parts_.memory.capacity()) {
    machine.stop();
    return never;
  }
  const DecodedInstruction* const instruction = parts_.memory.fetch(machine.program_counter());
  if (instruction == nullptr) return now + ParameterStore::poll_period;
  machine.begin_instruction();
  source_ = Source::program;
  now_ = now;
  const Outcome outcome = instruction->handler(*this, instruction->command);
  if (outcome.form == Outcome::Form::busy) {
    machine.hold();
    return now + ParameterStore::poll_period;
  }
  if (outcome.form == Outcome::Form::result && outcome.status == Status::ok) {
    machine.registers.accumulator = outcome.value;
    machine.registers.set_comparison(outcome.value, 0);
  }
  // The end marker of a download, erased memory and control commands: the program ends here. Any other error, such as a
  // value out of range, does not keep the program from going on (docs/decisions/0012-errors-in-programs.md).
  if (outcome.status == Status::invalid_command || outcome.status == Status::command_not_available) {
    machine.hold();
    machine.stop();
  }
  machine.finish_instruction();
  return turn_behind_instruction(now);
}

Microseconds Executor::turn_behind_instruction(Microseconds now) const {
  const ProgramMachine& machine = parts_.machine;
  if (!machine.is_running()) return never;
  if (!machine.is_waiting()) return now;
  Microseconds next = machine.wait_deadline();
  const bool has_to_look = machine.waits_for() != ProgramMachine::WaitsFor::time || machine.interrupts.is_active();
  if (has_to_look && now + wait_poll_period < next) next = now + wait_poll_period;
  return next;
}

Microseconds Executor::next_turn_without_change() const {
  const ProgramMachine& machine = parts_.machine;
  const bool only_watches = machine.is_running() && machine.is_waiting() && !machine.interrupts.is_active() &&
                            machine.waits_for() == ProgramMachine::WaitsFor::motion_or_switch;
  return only_watches ? machine.wait_deadline() : next_turn_;
}

}  // namespace opentmcl
