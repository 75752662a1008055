#pragma once

#include <cstdint>

#include "firmware/hal/time.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/tmcl/interrupt_controller.hpp"

namespace opentmcl {

/// Error flags of JC, CALL and CLE, as bits in the order of the words of CLE.
enum class ErrorFlag : std::uint8_t { timeout = 1, external_alarm = 2, deviation = 4, position = 8, shutdown = 16 };

/// What a TMCL program calculates with.
struct Registers {
  std::int32_t accumulator = 0;
  std::int32_t x = 0;
  std::uint8_t comparison = equal;  ///< of the last comparison, or of the last value read with 0
  std::uint8_t error_flags = 0;     ///< ErrorFlag bits

  // What a comparison can come to, as bits: a condition is a set of them.
  static constexpr std::uint8_t lower = 1;
  static constexpr std::uint8_t equal = 2;
  static constexpr std::uint8_t greater = 4;

  void set_comparison(std::int32_t left, std::int32_t right) {
    comparison = left < right ? lower : left == right ? equal : greater;
  }
};

/// State of the program: where it is, what it has called, whether it runs. It moves on only when the executor tells it.
class ProgramMachine {
 public:
  /// Numbers as global parameter 128 and command 135 show them.
  enum class Mode : std::uint8_t { stop = 0, run = 1, step = 2, reset = 3 };

  static constexpr std::uint8_t stack_size = maximum_open_calls;

  Registers registers;
  InterruptController interrupts;

  Mode mode() const { return mode_; }
  bool is_running() const { return mode_ != Mode::stop; }  // Mode::reset is over at once
  /// Runs, and nothing can come between two instructions: neither an interrupt nor the end of a single step.
  bool runs_undisturbed() const { return mode_ == Mode::run && !interrupts.is_active(); }
  /// Of the instruction to be executed next.
  std::uint16_t program_counter() const { return program_counter_; }
  bool is_waiting() const { return waiting_; }

  /// Continues at the present address.
  void run() { mode_ = Mode::run; }
  /// Starts anew at an address: no subroutine or interrupt routine is open, and interrupts that happened while no
  /// program ran are forgotten. The registers stay (docs/decisions/0030-starting-a-program.md).
  void run_from(std::uint16_t address);
  /// Executes one more instruction.
  void step() { mode_ = Mode::step; }
  /// The program counter stays, so that run() continues.
  void stop() { mode_ = Mode::stop; }
  /// Stops and clears program counter, stack, registers, flags and the interrupt context. Which interrupts are enabled,
  /// and their vectors, stay: hosts set them up before they start a program.
  void reset();

  /// An instruction is about to be executed: unless it says otherwise the one behind it comes next.
  void begin_instruction() { ++program_counter_; }
  /// It was executed: a single step is over.
  void finish_instruction() {
    if (mode_ == Mode::step) mode_ = Mode::stop;
  }

  void jump(std::uint16_t address) { program_counter_ = address; }
  /// Ignored when the stack is full.
  void call(std::uint16_t address);
  /// Ignored when the stack is empty.
  void return_from_subroutine();
  /// Stays at the instruction that is being executed, to execute it again.
  void hold() { --program_counter_; }

  /// Enters an interrupt routine; the context is kept until return_from_interrupt().
  void enter_interrupt(std::uint16_t vector);
  /// Ignored outside an interrupt routine.
  void return_from_interrupt();
  bool is_in_interrupt() const { return in_interrupt_; }

  // For who looks into a module from the board's side, such as a debugger of a virtual one.
  std::uint8_t depth() const { return depth_; }
  /// @param level of the subroutine, less than depth(); 0: the outermost
  std::uint16_t return_address(std::uint8_t level) const { return stack_[level]; }
  /// Where an open interrupt routine returns to.
  std::uint16_t interrupted_program_counter() const { return interrupted_.program_counter; }

  /// What else than time ends a WAIT: whether it is over has to be looked at again and again.
  enum class WaitsFor : std::uint8_t { time, motion_or_switch, reference_search };

  /// Begins a WAIT when none is under way. @param limit ends at begin + limit; `never` for no time limit
  void begin_wait(Microseconds now, Microseconds limit, WaitsFor event);
  WaitsFor waits_for() const { return waits_for_; }
  Microseconds wait_deadline() const { return wait_deadline_; }
  void end_wait() { waiting_ = false; }

 private:
  void close_routines();

  struct Context {
    Registers registers;
    std::uint16_t program_counter = 0;
    bool waiting = false;
    WaitsFor waits_for = WaitsFor::time;
    Microseconds wait_deadline = 0;
  };

  Mode mode_ = Mode::stop;
  std::uint16_t program_counter_ = 0;
  std::uint16_t stack_[stack_size] = {};
  std::uint8_t depth_ = 0;
  bool waiting_ = false;
  WaitsFor waits_for_ = WaitsFor::time;
  bool in_interrupt_ = false;
  Microseconds wait_deadline_ = 0;
  Context interrupted_;
};

}  // namespace opentmcl
