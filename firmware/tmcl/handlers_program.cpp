#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

namespace {

/// Conditions of JC and CALL on the last comparison, in the order of `condition_words`: what it may have come to. The
/// error flags follow, in the order of ErrorFlag.
constexpr std::uint8_t conditions[] = {
    Registers::equal,                       // ZE
    Registers::lower | Registers::greater,  // NZ
    Registers::equal,                       // EQ
    Registers::lower | Registers::greater,  // NE
    Registers::greater,                     // GT
    Registers::greater | Registers::equal,  // GE
    Registers::lower,                       // LT
    Registers::lower | Registers::equal,    // LE
};
constexpr std::uint8_t first_error_condition = sizeof conditions;

enum class WaitEvent : std::uint8_t {
  ticks = 0,
  position = 1,
  reference_switch = 2,
  limit_switch = 3,
  reference_search = 4
};

constexpr ProgramMachine::WaitsFor awaited_by(WaitEvent event) {
  using WaitsFor = ProgramMachine::WaitsFor;
  if (event == WaitEvent::ticks) return WaitsFor::time;
  return event == WaitEvent::reference_search ? WaitsFor::reference_search : WaitsFor::motion_or_switch;
}

/// One tick of WAIT is 10 ms (PD-1161 manual 3.7.22).
constexpr Microseconds tick = 10 * one_millisecond;

/// WAIT takes its operand from the accumulator when it is -1.
constexpr std::int32_t from_accumulator = -1;

}  // namespace

Outcome Handlers::calculate_accumulator(Executor& executor, const Command& command) {
  std::int32_t& accumulator = registers(executor).accumulator;
  const auto operation = static_cast<Operation>(command.type);
  const std::int32_t operand = operation == Operation::bitwise_not ? accumulator : command.value;
  accumulator = calculate(operation, accumulator, operand);
  return done(command);
}

/// NOT inverts and LOAD fills the X register; all others work on the accumulator (PD-1161 manual 3.7.28).
Outcome Handlers::calculate_x(Executor& executor, const Command& command) {
  Registers& r = registers(executor);
  const auto operation = static_cast<Operation>(command.type);
  switch (operation) {
    case Operation::bitwise_not:
      r.x = ~r.x;
      break;
    case Operation::load:
      r.x = r.accumulator;
      break;
    case Operation::swap: {
      const std::int32_t accumulator = r.accumulator;
      r.accumulator = r.x;
      r.x = accumulator;
      break;
    }
    default:
      r.accumulator = calculate(operation, r.accumulator, r.x);
      break;
  }
  return done(command);
}

Outcome Handlers::compare(Executor& executor, const Command& command) {
  registers(executor).set_comparison(registers(executor).accumulator, command.value);
  return done(command);
}

bool Handlers::condition_holds(const Registers& r, std::uint8_t condition) {
  if (condition < first_error_condition) return (r.comparison & conditions[condition]) != 0;
  return (r.error_flags >> (condition - first_error_condition) & 1) != 0;
}

bool Handlers::is_jump_target(Executor& executor, std::int32_t address) {
  return address < parts(executor).memory.capacity();  // the table keeps it from being negative
}

Outcome Handlers::jump(Executor& executor, const Command& command) {
  parts(executor).machine.jump(static_cast<std::uint16_t>(command.value));
  return done(command);
}

Outcome Handlers::jump_conditional(Executor& executor, const Command& command) {
  return condition_holds(registers(executor), command.type) ? jump(executor, command) : done(command);
}

Outcome Handlers::call(Executor& executor, const Command& command) {
  parts(executor).machine.call(static_cast<std::uint16_t>(command.value));
  return done(command);
}

Outcome Handlers::call_conditional(Executor& executor, const Command& command) {
  return condition_holds(registers(executor), command.type) ? call(executor, command) : done(command);
}

Outcome Handlers::return_from_subroutine(Executor& executor, const Command& command) {
  parts(executor).machine.return_from_subroutine();
  return done(command);
}

Outcome Handlers::wait(Executor& executor, const Command& command) {
  ProgramMachine& machine = parts(executor).machine;
  Axis& axis = parts(executor).axis;
  const auto event = static_cast<WaitEvent>(command.type);
  std::int32_t ticks = command.value == from_accumulator ? registers(executor).accumulator : command.value;
  if (ticks < 0) ticks = 0;
  const bool has_limit = event == WaitEvent::ticks || ticks != 0;
  machine.begin_wait(executor.now_, has_limit ? static_cast<Microseconds>(ticks) * tick : never, awaited_by(event));

  bool happened = false;
  switch (event) {
    case WaitEvent::ticks:
      happened = executor.now_ >= machine.wait_deadline();
      break;
    case WaitEvent::position:
      happened = axis.position_reached();
      break;
    case WaitEvent::reference_switch:
      happened = is_high(parts(executor).pins.inputs(), hal::InputPin::home_switch);
      break;
    case WaitEvent::limit_switch:
      happened = axis.left_switch_active() || axis.right_switch_active();
      break;
    case WaitEvent::reference_search:
      happened = !parts(executor).reference_search.is_active();
      break;
  }
  if (!happened && executor.now_ >= machine.wait_deadline()) {
    registers(executor).error_flags |= static_cast<std::uint8_t>(ErrorFlag::timeout);
    happened = true;
  }
  if (happened) {
    machine.end_wait();
  } else {
    machine.hold();
  }
  return done(command);
}

Outcome Handlers::stop(Executor& executor, const Command& command) {
  // The program counter stays here: a program that is continued after its end ends again.
  parts(executor).machine.hold();
  parts(executor).machine.stop();
  return done(command);
}

Outcome Handlers::clear_error_flags(Executor& executor, const Command& command) {
  constexpr std::uint8_t all_flags = 0;
  Registers& r = registers(executor);
  r.error_flags = command.type == all_flags ? std::uint8_t{0}
                                            : static_cast<std::uint8_t>(r.error_flags & ~(1U << (command.type - 1)));
  return done(command);
}

Outcome Handlers::restart(Executor& executor, const Command& command) {
  ProgramMachine& machine = parts(executor).machine;
  const bool is_single_step = machine.mode() == ProgramMachine::Mode::step;
  machine.reset();
  if (is_single_step) {
    machine.step();
  } else {
    machine.run();
  }
  machine.jump(static_cast<std::uint16_t>(command.value));
  return done(command);
}

/// Jumps when the result is not zero (E-41); the number of the variable is in the type field (E-08).
Outcome Handlers::decrement_and_jump(Executor& executor, const Command& command) {
  GlobalParameterAccess& globals = parts(executor).global_parameters;
  const std::int32_t value = calculate(Operation::subtract, globals.variable(command.type), 1);
  globals.set_variable(command.type, value);
  return value != 0 ? jump(executor, command) : done(command);
}

std::uint8_t Handlers::interrupt_row(Executor& executor, std::uint8_t number) {
  return interrupt_row_in(parts(executor).description.id, number);
}

Outcome Handlers::enable_interrupt(Executor& executor, const Command& command) {
  const std::uint8_t row = interrupt_row(executor, command.type);
  if (row == no_row) return with_status(Status::wrong_type, command);
  parts(executor).machine.interrupts.enable(row);
  return done(command);
}

Outcome Handlers::disable_interrupt(Executor& executor, const Command& command) {
  const std::uint8_t row = interrupt_row(executor, command.type);
  if (row == no_row) return with_status(Status::wrong_type, command);
  parts(executor).machine.interrupts.disable(row);
  return done(command);
}

Outcome Handlers::set_interrupt_vector(Executor& executor, const Command& command) {
  const std::uint8_t row = interrupt_row(executor, command.type);
  if (row == no_row || command.type == static_cast<std::uint8_t>(Interrupt::global)) {
    return with_status(Status::wrong_type, command);
  }
  if (!is_jump_target(executor, command.value)) return with_status(Status::invalid_value, command);
  parts(executor).machine.interrupts.set_vector(row, static_cast<std::uint16_t>(command.value));
  return done(command);
}

/// From a host it is answered and has no effect: only the program that was interrupted can go back.
Outcome Handlers::return_from_interrupt(Executor& executor, const Command& command) {
  if (executor.source_ == Executor::Source::program) parts(executor).machine.return_from_interrupt();
  return done(command);
}

}  // namespace opentmcl
