#include "debug/module_target.hpp"

#include "debug/call_stack.hpp"
#include "firmware/spec/global_parameters.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::ProgramStatus;
using client::Result;
using State = client::ProgramStatus::State;

namespace {

/// A single step is one turn of the module's main loop, or several while the EEPROM is busy: 5 ms for a page.
constexpr int most_looks_at_a_step = 100;

constexpr auto state_number = static_cast<std::uint8_t>(GlobalParameter::application_status);
constexpr auto program_counter_number = static_cast<std::uint8_t>(GlobalParameter::program_counter);

}  // namespace

Result<void> ModuleTarget::control(Opcode opcode) {
  const Result<std::int32_t> done = client_.execute({static_cast<std::uint8_t>(opcode), 0, 0, 0});
  if (!done) return done.error();
  return {};
}

Result<std::uint16_t> ModuleTarget::program_counter() {
  const Result<std::int32_t> address = client_.global_parameter(program_counter_number, Bank::module_settings);
  if (!address) return address.error();
  return static_cast<std::uint16_t>(*address);
}

Result<State> ModuleTarget::state() {
  const Result<std::int32_t> state = client_.global_parameter(state_number, Bank::module_settings);
  if (!state) return state.error();
  return static_cast<State>(*state);
}

Result<ProgramStatus> ModuleTarget::status() {
  const Result<State> now = state();
  if (!now) return now.error();
  const Result<std::uint16_t> address = program_counter();
  if (!address) return address.error();
  return ProgramStatus{*now, false, *address};
}

Result<ProgramStatus> ModuleTarget::restart() {
  if (Result<void> stopped = control(Opcode::stop_application); !stopped) return stopped.error();
  if (Result<void> reset = control(Opcode::reset_application); !reset) return reset.error();
  return status();
}

Result<ProgramStatus> ModuleTarget::step(std::uint16_t address, const Command& instruction) {
  if (Result<void> stepped = control(Opcode::step_application); !stepped) return stepped.error();
  for (int look = 0; look < most_looks_at_a_step; ++look) {
    const Result<std::uint16_t> reached = program_counter();
    if (!reached) return reached.error();
    if (*reached != address) return ProgramStatus{State::running, false, *reached};
    // The step is still under way, as while the EEPROM is busy, or the program waits, ends or jumps here.
    const Result<State> now = state();
    if (!now) return now.error();
    if (*now != State::stepping) {
      // Perhaps it was executed between the two looks.
      const Result<std::uint16_t> end = program_counter();
      if (!end) return end.error();
      const auto opcode = static_cast<Opcode>(instruction.opcode);
      const bool stays = *end == address;
      const bool waits = stays && opcode == Opcode::wait;
      const bool has_ended = stays && !waits && !can_jump(opcode);
      return ProgramStatus{has_ended ? State::stopped : State::running, waits, *end};
    }
    rest();
  }
  return Error{ErrorKind::timeout,
               "the module does not come to the end of the instruction at address " + std::to_string(address) +
                   ": its EEPROM stays busy",
               {}};
}

void ModuleTarget::rest() {
  client_.transport().pause(std::chrono::milliseconds(5));
}

Result<void> ModuleTarget::let_run() {
  return control(Opcode::run_application);
}

Result<ProgramStatus> ModuleTarget::halt() {
  if (Result<void> stopped = control(Opcode::stop_application); !stopped) return stopped.error();
  return status();
}

Result<ProgramStatus> ModuleTarget::jump(std::uint16_t) {
  return Error{ErrorKind::usage,
               "no command sets a module's program counter without letting the program run; in a twin "
               "(port sim:pd1161) one can jump",
               {}};
}

}  // namespace opentmcl::debug
