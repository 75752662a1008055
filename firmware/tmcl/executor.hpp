#pragma once

#include <cstdint>

#include "firmware/hal/hal.hpp"
#include "firmware/motion/reference_search.hpp"
#include "firmware/param/axis_parameter_access.hpp"
#include "firmware/param/global_parameter_access.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/tmcl/dispatch.hpp"
#include "firmware/tmcl/extensions.hpp"
#include "firmware/tmcl/outcome.hpp"
#include "firmware/tmcl/program_machine.hpp"
#include "firmware/tmcl/program_memory.hpp"

namespace opentmcl {

/// Executes instructions, those of the host and those of the program by the same handlers. Only the context differs:
/// in a program, instructions that read set the accumulator and the flags.
class Executor {
 public:
  /// The parts of the module that instructions work on.
  struct Parts {
    const ModuleDescription& description;
    Axis& axis;
    ReferenceSearch& reference_search;
    AxisParameterAccess& axis_parameters;
    GlobalParameterAccess& global_parameters;
    ProgramMachine& machine;
    ProgramMemory& memory;
    ParameterStore& store;
    hal::Pins& pins;
    hal::Analog& analog;
    const Extensions& extensions;
  };

  explicit Executor(const Parts& parts)
      : parts_(parts), dispatch_(dispatch_tables[static_cast<std::size_t>(parts.description.id)]) {}

  /// One command of a host. In download mode it is stored instead, control commands excepted.
  Outcome execute_direct(const Command& command, Microseconds now);

  /// A short turn of the program: executes its next instruction if that has Reach::program and was executed before, so
  /// that it needs neither the EEPROM nor the time, and no other part has to look at its effect.
  /// @return false when there is no such instruction, and poll() has to look
  bool calculate() {
    ProgramMachine& machine = parts_.machine;
    if (!machine.runs_undisturbed()) return false;
    const DecodedInstruction* const instruction = parts_.memory.fetch_contained(machine.program_counter());
    if (instruction == nullptr) return false;
    machine.begin_instruction();
    instruction->handler(*this, instruction->command);
    return true;
  }

  /// One turn of the program: at most one instruction.
  void poll(Microseconds now) {
    if (parts_.machine.is_running()) next_turn_ = run_program(now);
  }
  /// When a running program needs the next turn, as poll() found.
  Microseconds next_turn() const { return next_turn_; }
  /// The same for a board that gives a turn whenever the motor reaches its target, leaves it, or a switch changes.
  Microseconds next_turn_without_change() const;
  /// How often a program looks whether the WAIT it is in is over.
  static constexpr Microseconds wait_poll_period = one_millisecond;

  /// The eight bytes behind the host address after an outcome with Form::special.
  const std::uint8_t* special_reply() const { return special_reply_; }

  /// Commands 137 and 255 want the module to restart when their reply is sent and the EEPROM is written.
  bool wants_restart() const { return wants_restart_; }

  /// Has the module restart with factory settings. A program that is protected against reading is erased first, since
  /// the protection (global parameter 81) is one of those settings.
  void restore_factory_settings();
  /// The restart is to find factory settings; true once.
  bool take_factory_reset() {
    const bool wanted = wants_factory_reset_;
    wants_factory_reset_ = false;
    return wanted;
  }

  bool is_in_download_mode() const { return download_mode_; }

  /// Target reached messages (command 138).
  enum class PositionReport : std::uint8_t { none, next_move, every_move };
  PositionReport position_report() const { return position_report_; }
  /// An MVP of a host was carried out since the last call; consumes a next_move request.
  bool take_reported_move() { return reported_move_ && is_report_wanted(); }

  /// Outputs low; the pull-up resistors of the switch inputs on, so that normally closed switches are seen
  /// (docs/decisions/0027-the-machine.md).
  static constexpr std::uint32_t power_on_outputs = bit(hal::OutputPin::pull_ups);
  void set_outputs(std::uint32_t levels);

  /// Tells the program what happened to the axis: error flags of JC, CALL and CLE, and the interrupts of stallGuard and
  /// deviation while it runs. @param events AxisEvent bits
  void note_axis_events(std::uint8_t events);
  /// No motor supply: the program stops.
  void note_supply_failure();
  /// The motor supply is back. @param starts_program from its begin, as after power-on
  void note_supply_return(bool starts_program);

  /// Global parameter 132 reads 0 at `now`.
  void reset_tick_timer(Microseconds now) { tick_timer_zero_ = now; }

 private:
  friend struct Handlers;

  enum class Source : std::uint8_t { direct, program };

  Microseconds run_program(Microseconds now);
  bool is_report_wanted();
  [[gnu::noinline]] Outcome store_in_program(const Command& command);
  InterruptController::Lines interrupt_lines();
  Microseconds turn_behind_instruction(Microseconds now) const;

  Parts parts_;
  const DispatchTable& dispatch_;
  Source source_ = Source::direct;
  Microseconds now_ = 0;
  Microseconds next_turn_ = never;
  std::uint32_t outputs_ = 0;
  Microseconds tick_timer_zero_ = 0;  ///< when the tick timer read 0
  std::uint32_t random_state_ = 1;
  std::uint16_t download_address_ = 0;
  bool download_mode_ = false;
  bool wants_restart_ = false;
  bool wants_factory_reset_ = false;
  bool reported_move_ = false;
  PositionReport position_report_ = PositionReport::none;
  std::uint8_t special_reply_[8] = {};
};

}  // namespace opentmcl
