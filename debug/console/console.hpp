#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/error.hpp"
#include "debug/console/listing.hpp"
#include "debug/engine.hpp"

namespace opentmcl::debug {

struct ConsoleCommand;

/// The debugger as a person types at it: takes one line after the other, as gdb would where TMCL allows it.
class Console {
 public:
  /// What is around it.
  struct Surroundings {
    /// Takes one line of output, without its end.
    std::function<void(const std::string&)> print;
    /// Whether the user wants what is going on to end; asking takes the wish away.
    std::function<bool()> take_interruption;
    /// Lets time pass on the wall.
    std::function<void(std::chrono::milliseconds)> sleep;
    /// Shows on a terminal what is going on, over what was shown before; empty: nowhere.
    std::function<void(const std::string&)> show_progress;
  };

  struct Options {
    bool colours = false;
    bool json = false;  ///< one object a line in place of text: docs/debugger.md
    /// How long a motion may take, on the module's clock.
    std::optional<client::Duration> limit = {};
  };

  /// `engine` must outlive this.
  Console(Engine& engine, Surroundings surroundings, Options options);

  /// What a line came to.
  enum class Outcome : std::uint8_t {
    done,
    quit,    ///< the user wants to leave; program and motor of a module are to stop
    detach,  ///< to leave, with the program running on
  };

  /// Errors: usage (what was typed), and all of Engine's.
  client::Result<Outcome> execute(std::string_view line);

  /// Where the program stands, as after each stop.
  void show_stop(const Stop& stop);
  /// A line of a logpoint or a scenario.
  void show_output(const std::string& text);

  /// "(tmcl Loop+2) "
  std::string prompt() const;

  /// Whole words that can stand in place of the last one of `line`, which ends where the cursor is.
  std::vector<std::string> completions(std::string_view line) const;

  // The commands; `arguments` is what stands behind the name.
  using Done = client::Result<Outcome>;
  Done add_breakpoint(std::string_view arguments);
  Done add_temporary_breakpoint(std::string_view arguments);
  Done add_logpoint(std::string_view arguments);
  Done add_watchpoint(std::string_view arguments);
  Done add_signal(std::string_view arguments);
  Done catch_troubles(std::string_view arguments);
  Done delete_breakpoints(std::string_view arguments);
  Done enable_breakpoints(std::string_view arguments);
  Done disable_breakpoints(std::string_view arguments);
  Done run(std::string_view arguments);
  Done restart(std::string_view arguments);
  Done go_on(std::string_view arguments);
  Done step(std::string_view arguments);
  Done next(std::string_view arguments);
  Done finish(std::string_view arguments);
  Done until(std::string_view arguments);
  Done jump(std::string_view arguments);
  Done animate(std::string_view arguments);
  Done reverse_step(std::string_view arguments);
  Done reverse_next(std::string_view arguments);
  Done reverse_finish(std::string_view arguments);
  Done reverse_continue(std::string_view arguments);
  Done print_value(std::string_view arguments);
  Done examine(std::string_view arguments);
  Done set(std::string_view arguments);
  Done send(std::string_view arguments);
  Done measure(std::string_view arguments);
  Done display(std::string_view arguments);
  Done undisplay(std::string_view arguments);
  Done info(std::string_view arguments);
  Done backtrace(std::string_view arguments);
  Done list(std::string_view arguments);
  Done help(std::string_view arguments);
  Done quit(std::string_view arguments);
  Done detach(std::string_view arguments);

 private:
  client::Result<std::uint16_t> place(std::string_view text) const;
  client::Result<std::uint16_t> place_or_here(std::string_view text) const;
  Done add_at_place(std::string_view arguments, bool temporary);
  Done switch_breakpoints(std::string_view arguments, bool enabled);
  Done move(Motion motion);
  Done move_repeatedly(Motion::Kind kind, std::string_view arguments);
  bool goes_on(const Underway& underway);
  Done added(client::Result<int> number);
  void show_displays();
  void show_value(const std::string& name, const client::Result<double>& value);
  Done info_registers();
  Done info_breakpoints();
  Done info_variables();
  Done info_signals();
  Done info_program();
  void print_line(const std::string& text);
  std::string describe(const Breakpoint& breakpoint) const;

  Engine& engine_;
  Surroundings surroundings_;
  Options options_;
  Listing listing_;
  std::map<int, std::string> displays_;
  int last_display_ = 0;
  std::string last_line_;  ///< an empty line repeats it, where that makes sense
  std::optional<std::uint16_t> listed_until_;
  bool shows_progress_ = false;
};

/// What one command is.
struct ConsoleCommand {
  std::string_view name;
  std::string_view short_name;  ///< that means it, whatever else begins so; may be empty
  std::string_view arguments;   ///< for its help
  std::string_view summary;
  std::string_view details;  ///< more lines for its own help; may be empty
  Console::Done (Console::*carry_out)(std::string_view arguments);
  bool repeats;  ///< an empty line does it again
};

std::vector<const ConsoleCommand*> console_commands();

}  // namespace opentmcl::debug
