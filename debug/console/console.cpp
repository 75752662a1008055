// Finding the command that a line means, help, and completion.

#include "debug/console/console.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "debug/mistake.hpp"
#include "debug/typed_text.hpp"
#include "lang/diagnostic.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"
#include "lang/suggestion.hpp"

namespace opentmcl::debug {

using client::Result;
using nlohmann::ordered_json;

namespace {

constexpr ConsoleCommand commands[] = {
    {"break", "b", "[PLACE] [if EXPRESSION] [hits COUNT]", "stop before an instruction",
     "PLACE is a line (12), FILE:LINE, a label (Loop, Loop+2) or an address (*7); without one: here.\n"
     "EXPRESSION is looked at when the program is there: A > 100 && GAP(1, 0) < 500.\n"
     "COUNT says at which hit: 3, >= 3, % 10.",
     &Console::add_breakpoint, false},
    {"tbreak", "tb", "[PLACE] [if EXPRESSION] [hits COUNT]", "the same, once", "", &Console::add_temporary_breakpoint,
     false},
    {"log", "", "PLACE MESSAGE", "say something whenever the program is there, and go on",
     "Values stand in braces: log Loop position {GAP(1)}, A {A}", &Console::add_logpoint, false},
    {"watch", "", "EXPRESSION", "stop behind the instruction that changes a value",
     "On a module each step asks for the value.", &Console::add_watchpoint, false},
    {"signal", "", "CONDITION", "stop when a signal of the bench becomes true (twin)",
     "signal velocity > 500, signal left_switch; the conditions are those of scenarios, the names those of `info "
     "signals`.",
     &Console::add_signal, false},
    {"catch", "", "[stall] [deviation] [under-voltage]", "stop when one of these happens; none: do not", "",
     &Console::catch_troubles, false},
    {"delete", "d", "[NUMBER...]", "remove breakpoints; without a number all", "", &Console::delete_breakpoints, false},
    {"enable", "", "NUMBER...", "switch breakpoints on", "", &Console::enable_breakpoints, false},
    {"disable", "", "NUMBER...", "switch breakpoints off", "", &Console::disable_breakpoints, false},
    {"run", "r", "", "begin anew and go on", "", &Console::run, false},
    {"restart", "", "", "begin anew and stand before the first instruction",
     "A module's program counter, registers and flags are cleared (command 131); a twin's bench begins anew, too.",
     &Console::restart, false},
    {"continue", "c", "", "go on until something stops the program; Ctrl-C does", "", &Console::go_on, true},
    {"step", "s", "[COUNT]", "one instruction, into a subroutine", "", &Console::step, true},
    {"next", "n", "[COUNT]", "one instruction, over a subroutine", "", &Console::next, true},
    {"finish", "", "", "to the end of the subroutine or interrupt routine", "", &Console::finish, true},
    {"until", "u", "PLACE", "go on until the program is there", "", &Console::until, false},
    {"jump", "", "PLACE", "set the program counter (twin)", "", &Console::jump, false},
    {"animate", "", "[STEPS_PER_SECOND]", "step on and show each line; 2 a second unless told; Ctrl-C ends it", "",
     &Console::animate, false},
    {"reverse-step", "rs", "[COUNT]", "back before the last instruction (twin)", "", &Console::reverse_step, true},
    {"reverse-next", "rn", "[COUNT]", "the same, back over a subroutine (twin)", "", &Console::reverse_next, true},
    {"reverse-finish", "", "", "back to before the call of the subroutine (twin)", "", &Console::reverse_finish, true},
    {"reverse-continue", "rc", "", "back to the last breakpoint before (twin)", "", &Console::reverse_continue, true},
    {"print", "p", "EXPRESSION", "show a value: A, VAR(3), GAP(1, 0) * 2, or GAP 1, 0",
     "Registers are A, X and PC; reads GAP(parameter, motor), GGP(parameter, bank), GIO(port, bank), VAR(number).",
     &Console::print_value, false},
    {"x", "", "[PLACE] [COUNT]", "show instructions as they are in the module", "", &Console::examine, true},
    {"set", "", "WHAT = EXPRESSION", "change a value",
     "WHAT is A, X, VAR(3), GAP(4, 0), GGP(128, 0), GIO(0, 2) or, on a twin, a quantity: set supply_voltage = 12",
     &Console::set, false},
    {"send", "", "INSTRUCTION", "execute an instruction in direct mode: send MVP ABS, 0, 1000", "", &Console::send,
     false},
    {"measure", "", "QUANTITY", "show a quantity of the bench (twin): measure rotor.speed", "", &Console::measure,
     false},
    {"display", "", "[EXPRESSION]", "show a value at every stop; without one: now", "", &Console::display, false},
    {"undisplay", "", "NUMBER", "no longer", "", &Console::undisplay, false},
    {"info", "i", "registers|breakpoints|variables|program|signals", "show all of them", "", &Console::info, false},
    {"backtrace", "bt", "", "show the open subroutines and interrupt routines", "", &Console::backtrace, false},
    {"list", "l", "[PLACE]", "show the source, there or further on", "", &Console::list, true},
    {"help", "h", "[COMMAND]", "show this, or more about a command", "", &Console::help, false},
    {"quit", "q", "", "leave; program and motor of a module are stopped", "", &Console::quit, false},
    {"detach", "", "", "leave; the program runs on", "", &Console::detach, false},
};

/// The command that `name` means: the whole name, a short one, or the begin of only one.
Result<const ConsoleCommand*> find_command(std::string_view name) {
  std::string candidates;
  const ConsoleCommand* found = nullptr;
  lang::Suggestion suggestion(name);
  for (const ConsoleCommand& command : commands) {
    if (command.name == name || (!command.short_name.empty() && command.short_name == name)) return &command;
    suggestion.consider(command.name);
    if (!command.name.starts_with(name)) continue;
    candidates += fmt::format("{}{}", candidates.empty() ? "" : ", ", command.name);
    found = found == nullptr ? &command : found;
  }
  if (found == nullptr) {
    const std::string hint = suggestion.text();
    return mistake(fmt::format("there is no command {}{}; `help` lists them", lang::in_quotes(name),
                               hint.empty() ? "" : ": " + hint));
  }
  if (candidates != found->name) {
    return mistake(fmt::format("{} can mean {}", lang::in_quotes(name), candidates));
  }
  return found;
}

}  // namespace

std::vector<const ConsoleCommand*> console_commands() {
  std::vector<const ConsoleCommand*> all;
  for (const ConsoleCommand& command : commands) all.push_back(&command);
  return all;
}

Console::Console(Engine& engine, Surroundings surroundings, Options options)
    : engine_(engine),
      surroundings_(std::move(surroundings)),
      options_(options),
      listing_(engine.program(), options.colours && !options.json) {}

Console::Done Console::execute(std::string_view line) {
  std::string_view rest = trimmed(line);
  if (rest.starts_with('#')) return Outcome::done;
  const std::string repeated = last_line_;
  if (rest.empty()) rest = repeated;
  if (rest.empty()) return Outcome::done;
  std::string_view arguments = rest;
  const Result<const ConsoleCommand*> command = find_command(take_word(arguments));
  last_line_.clear();
  if (!command) return command.error();
  if ((*command)->repeats) last_line_ = rest;
  return (this->*(*command)->carry_out)(arguments);
}

void Console::print_line(const std::string& text) {
  if (options_.json) {
    surroundings_.print(
        ordered_json{{"event", "text"}, {"text", text}}.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  } else {
    surroundings_.print(text);
  }
}

void Console::show_output(const std::string& text) {
  if (options_.json) {
    surroundings_.print(ordered_json{{"event", "output"}, {"text", text}}.dump());
  } else {
    surroundings_.print(text);
  }
}

std::string Console::prompt() const {
  if (engine_.is_running()) return "(tmcl, running) ";
  return fmt::format("(tmcl {}{}) ", engine_.program().name_of(engine_.stop().address),
                     engine_.has_ended() ? ", ended" : "");
}

Console::Done Console::help(std::string_view arguments) {
  if (!arguments.empty()) {
    const Result<const ConsoleCommand*> command = find_command(arguments);
    if (!command) return command.error();
    const ConsoleCommand& row = **command;
    const std::string short_name = row.short_name.empty() ? "" : fmt::format(" ({})", row.short_name);
    print_line(fmt::format("{}{} {}\n  {}", row.name, short_name, row.arguments, row.summary));
    if (!row.details.empty()) print_line(std::string(row.details));
    return Outcome::done;
  }
  for (const ConsoleCommand& command : commands) {
    const std::string name = command.short_name.empty() ? std::string(command.name)
                                                        : fmt::format("{}, {}", command.name, command.short_name);
    print_line(fmt::format("{:22} {}", name, command.summary));
  }
  print_line("An empty line repeats a step or a listing. `help COMMAND` says more.");
  return Outcome::done;
}

Console::Done Console::quit(std::string_view) {
  return Outcome::quit;
}

Console::Done Console::detach(std::string_view) {
  if (steps_like_running(engine_.target())) {
    return mistake("a twin lives in this program: it ends with it; `quit` leaves");
  }
  return Outcome::detach;
}

std::vector<std::string> Console::completions(std::string_view line) const {
  const std::size_t last_blank = line.find_last_of(" \t(,{");
  const std::string_view word = last_blank == std::string_view::npos ? line : line.substr(last_blank + 1);
  std::vector<std::string> found;
  const auto consider = [&](std::string_view candidate) {
    if (candidate.size() >= word.size() && lang::equal_ignoring_case(candidate.substr(0, word.size()), word)) {
      found.emplace_back(candidate);
    }
  };
  const std::string_view before = trimmed(line.substr(0, line.size() - word.size()));
  if (before.empty()) {
    for (const ConsoleCommand& command : commands) consider(command.name);
    return found;
  }
  const Result<const ConsoleCommand*> command = find_command(before.substr(0, before.find_first_of(" \t")));
  if (!command) return found;
  const auto carry_out = (*command)->carry_out;
  if (carry_out == &Console::help) {
    for (const ConsoleCommand& each : commands) consider(each.name);
  } else if (carry_out == &Console::info) {
    for (const char* what : {"registers", "breakpoints", "variables", "program", "signals"}) consider(what);
  } else if (carry_out == &Console::catch_troubles) {
    for (const char* trouble : {"stall", "deviation", "under-voltage", "none"}) consider(trouble);
  } else {
    for (const lang::Label& label : engine_.program().labels()) consider(label.name);
    for (const char* name : {"A", "X", "PC", "VAR", "GAP", "GGP", "GIO"}) consider(name);
  }
  const bool takes_quantities =
      carry_out == &Console::add_signal || carry_out == &Console::measure || carry_out == &Console::set;
  if (TwinPowers* const twin = engine_.target().twin(); twin != nullptr && takes_quantities) {
    for (const std::string_view name : twin->quantity_names()) consider(name);
  }
  if (carry_out == &Console::send) {
    for (const InstructionSpec& row : instructions) {
      if (row.mnemonic != nullptr) consider(row.mnemonic);
    }
  }
  return found;
}

}  // namespace opentmcl::debug
