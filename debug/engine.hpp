// The debugger itself, without a face: the command line, the debug adapter and the browser are faces of it.
//
// One engine debugs one program in one module, from one thread. Whatever can take long asks `keep_going` every few
// milliseconds; from in there everything may be called that does not let the program go: a face can look after its own
// requests, add and remove breakpoints, and return false for a pause.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/program_transfer.hpp"
#include "debug/breakpoint.hpp"
#include "debug/call_stack.hpp"
#include "debug/program.hpp"
#include "debug/stop.hpp"
#include "debug/target.hpp"
#include "debug/value_expression.hpp"

namespace opentmcl::debug {

/// What a program that is let go is to do.
struct Motion {
  enum class Kind : std::uint8_t {
    run,           ///< until something stops it
    step,          ///< one instruction; into a subroutine
    step_over,     ///< one instruction; a subroutine that it calls to its end
    step_out,      ///< to the end of the subroutine or interrupt routine
    run_to,        ///< until it is at `address`
    reverse_step,  ///< back before the last instruction; twins only, as those that follow
    reverse_step_over,
    reverse_step_out,  ///< back to before the call
    reverse_run,       ///< back to the last breakpoint before
  };

  Kind kind = Kind::run;
  std::uint16_t address = 0;
  /// On the module's clock; nothing: no limit.
  std::optional<client::Duration> limit = {};
};

/// How far a motion is.
struct Underway {
  std::uint16_t address = 0;
  bool waiting = false;     ///< at a WAIT
  std::uint64_t steps = 0;  ///< of this motion
};

/// The registers as far as the module shows them.
struct RegisterValues {
  std::int32_t accumulator = 0;
  std::int32_t x = 0;
  std::uint16_t program_counter = 0;
  std::optional<InnerState> inner;  ///< none: not visible on a module
};

/// A routine that is open.
struct Frame {
  std::uint16_t address = 0;  ///< of the instruction that comes next in it
  bool is_interrupt = false;  ///< an interrupt routine
};

/// What stands in the module's memory where the program belongs.
struct MemoryComparison {
  bool readable = true;                  ///< false: code protection (global parameter 81) hides it
  bool writable = true;                  ///< false: code protection forbids a download
  std::vector<std::uint16_t> differing;  ///< addresses, rising; without meaning if not readable
  bool end_is_marked = true;             ///< as client::with_end_mark() does; without meaning if not readable

  bool is_same() const { return readable && differing.empty(); }
  /// A download would change nothing.
  bool is_loaded() const { return is_same() && end_is_marked; }
};

class Engine final : private ValueSource {
 public:
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// false: the motion is to end.
  using KeepGoing = std::function<bool(const Underway&)>;
  /// Of logpoints, without a line end.
  using Output = std::function<void(const std::string&)>;

  /// `target` must outlive this.
  Engine(Target& target, Program program, Output output = {});

  Target& target() { return target_; }
  const Program& program() const { return program_; }

  // ---- The program in the module

  /// Reads and compares. Errors: those of client::Client; interrupted.
  client::Result<MemoryComparison> compare(const client::Progress& progress);
  /// Stops what runs and sends what differs, all of it if the memory cannot be read. @return instructions sent, not
  /// counting the end mark.
  /// Errors: those of client::download; refused (code protection), with what to do.
  client::Result<std::size_t> download(const MemoryComparison& comparison, const client::Progress& progress);
  /// The program stands at its begin; hits are counted anew.
  client::Result<Stop> restart();
  /// Takes the program as it is. One that runs goes on until a motion; `ended` if it stands.
  client::Result<Stop> attach();
  /// Sets the program counter; a twin only. Error: usage.
  client::Result<Stop> jump(std::uint16_t address);
  /// Lets the program run and looks no more. @post the engine is at its end
  client::Result<void> detach();
  /// Stops program and motor.
  client::Result<void> stop_all();

  // ---- Breakpoints

  /// @return its number. Error: usage.
  client::Result<int> add(BreakpointRequest request);
  /// False: there is none.
  bool remove(int number);
  bool enable(int number, bool enabled);
  const std::map<int, Breakpoint>& breakpoints() const { return breakpoints_; }
  /// Trouble bits that stop a program when they happen. On a module they are asked for at every step, or look.
  void stop_at_troubles(std::uint8_t troubles);

  // ---- Motion

  /// Lets the program go until something stops it. On a module a program without breakpoints runs by itself (command
  /// 129), any other one is stepped (command 130), and while it stands the motor does what it did.
  /// Errors: those of the target, usage (a motion that this target or place does not have).
  client::Result<Stop> go(const Motion& motion, const KeepGoing& keep_going);
  /// Where it stands.
  const Stop& stop() const { return stop_; }
  /// Whether the program was left running by attach().
  bool is_running() const { return running_; }
  /// Whether it has ended, so that only a restart lets it go again.
  bool has_ended() const { return ended_; }

  // ---- Values

  client::Result<RegisterValues> registers();
  /// Through CALC and CALCX in direct mode.
  client::Result<void> set_accumulator(std::int32_t value);
  client::Result<void> set_x(std::int32_t value);
  /// @param number 0…255
  client::Result<std::int32_t> variable(std::uint8_t number);
  client::Result<void> set_variable(std::uint8_t number, std::int32_t value);

  /// The innermost first.
  std::vector<Frame> frames();
  /// False: there may be more frames than could be seen.
  bool frames_are_whole() const;

  /// An expression (debug/value_expression.hpp), or an instruction that only reads: `GAP 1, 0`. Error: usage.
  client::Result<double> evaluate(std::string_view text);
  /// Any instruction that direct mode has: `MVP ABS, 0, 1000`. @return the value of the reply. Error: usage.
  client::Result<std::int32_t> execute(std::string_view instruction);
  /// Whether `text` begins with a mnemonic and is no call of a function.
  static bool is_instruction(std::string_view text);
  /// The instruction at an address of the module's memory.
  client::Result<Command> command_at(std::uint16_t address);

 private:
  // ValueSource
  client::Result<std::int32_t> accumulator() override;
  client::Result<std::int32_t> x_register() override;
  client::Result<std::int32_t> program_counter() override;
  client::Result<std::int32_t> read(const Command& command) override;

  client::Result<Command> parsed(std::string_view instruction) const;

  // ---- engine_motion.cpp
  client::Result<Stop> go_forward(const Motion& motion, const KeepGoing& keep_going);
  client::Result<Stop> go_back(const Motion& motion, const KeepGoing& keep_going);
  client::Result<std::optional<Stop>> run_unseen(const Motion& motion, client::Duration begin,
                                                 const KeepGoing& keep_going);
  bool needs_stepping(const Motion& motion) const;
  bool is_done(const Motion& motion, std::int64_t level) const;

  /// Tries one instruction. @return whether it is over
  client::Result<bool> step_once();
  client::Result<void> halt();
  Stop stand(Stop::Reason reason, std::string description = {});
  /// How deep in routines: of use as a difference only.
  std::int64_t level() const;

  // ---- engine_breakpoints.cpp
  /// What is so now is nothing that happens later.
  client::Result<void> begin_looking();
  /// What stops the program here. @param counts as a hit, and lets logpoints speak
  client::Result<std::optional<Stop>> met(bool at_instruction, bool counts);
  struct Look {
    bool hit = false;
    std::string description;
  };
  client::Result<Look> look_at(Breakpoint& breakpoint, bool at_instruction);
  client::Result<Look> condition_of(const Breakpoint& breakpoint);
  client::Result<std::uint8_t> troubles();
  void count_breakpoints();

  // ---- engine_history.cpp
  void remember_moment();
  client::Result<std::optional<Moment>> moment_before(const Motion& motion, Moment now, const KeepGoing& keep_going,
                                                      std::optional<Stop>& met_there);
  client::Result<void> go_to(Moment moment, const KeepGoing& keep_going);

  Target& target_;
  Program program_;
  Output output_;
  std::map<int, Breakpoint> breakpoints_;
  int last_number_ = 0;
  std::vector<std::uint8_t> stops_at_;  ///< by address: an enabled breakpoint
  std::size_t unplaced_ = 0;            ///< enabled breakpoints of other kinds
  std::uint8_t trouble_filter_ = 0;
  std::uint8_t known_troubles_ = 0;
  CallStack calls_;
  client::ProgramStatus status_;
  Stop stop_;
  bool running_ = false;                     ///< by itself
  bool ended_ = false;                       ///< and cannot go on
  bool at_instruction_ = true;               ///< the last step is over
  std::deque<Moment> recent_;                ///< before the latest instructions, of a twin
  std::map<std::uint16_t, Command> beyond_;  ///< instructions of the module behind the program
};

}  // namespace opentmcl::debug
