// Commands that show and change values.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "debug/assignment.hpp"
#include "debug/console/console.hpp"
#include "debug/console/place.hpp"
#include "debug/inner_state_text.hpp"
#include "debug/mistake.hpp"
#include "debug/typed_text.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::Result;
using nlohmann::ordered_json;

namespace {

Error only_on_a_twin(std::string_view what) {
  return mistake(std::string(what) + " can only be seen in a twin (port sim:pd1161 or sim:tmcm1110)");
}

}  // namespace

void Console::show_value(const std::string& name, const Result<double>& value) {
  if (options_.json) {
    ordered_json event{{"event", "value"}, {"expression", name}};
    constexpr double exact = 9007199254740992;  // 2^53
    if (value && std::abs(*value) < exact && *value == std::floor(*value)) {
      event["value"] = static_cast<std::int64_t>(*value);
    } else if (value) {
      event["value"] = *value;
    } else {
      event["error"] = value.error().message;
    }
    surroundings_.print(event.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  } else {
    print_line(fmt::format("{} = {}", name, value ? value_text(*value) : "<" + value.error().message + ">"));
  }
}

Console::Done Console::print_value(std::string_view arguments) {
  if (arguments.empty()) return mistake("expected an expression, such as A, VAR(3) or GAP 1, 0");
  const Result<double> value = engine_.evaluate(arguments);
  if (!value) return value.error();
  show_value(std::string(arguments), value);
  return Outcome::done;
}

Console::Done Console::examine(std::string_view arguments) {
  constexpr unsigned usual_count = 10;
  unsigned count = usual_count;
  std::string_view where = arguments;
  if (const std::size_t blank = arguments.rfind(' '); blank != std::string_view::npos) {
    const std::string_view last = arguments.substr(blank + 1);
    count = number_in<unsigned>(last).value_or(0);
    if (count == 0) return mistake("expected a count, not " + lang::in_quotes(last));
    where = trimmed(arguments.substr(0, blank));
  }
  const bool goes_on = where.empty() && listed_until_;
  Result<std::uint16_t> begin = goes_on ? Result<std::uint16_t>(*listed_until_) : place_or_here(where);
  if (!begin) return begin.error();
  const unsigned capacity = engine_.program().module().program_capacity;
  unsigned address = *begin;
  for (; address < capacity && count > 0; ++address, --count) {
    const auto place = static_cast<std::uint16_t>(address);
    const Result<Command> command = client::read_instruction(engine_.target().client(), place);
    if (!command) return command.error();
    const bool is_here = place == engine_.stop().address;
    print_line(fmt::format("{} {:5}  {:24} {}", is_here ? "=>" : "  ", address, engine_.program().name_of(place),
                           engine_.program().text_of(*command)));
  }
  listed_until_ = address < capacity ? std::optional(static_cast<std::uint16_t>(address)) : std::nullopt;
  // An empty line goes on where this ends.
  last_line_ = listed_until_ ? "x" : "";
  return Outcome::done;
}

Console::Done Console::set(std::string_view arguments) {
  const std::size_t sign = arguments.find('=');
  if (sign == std::string_view::npos) return mistake("expected WHAT = EXPRESSION, such as: set VAR(3) = 7");
  const std::string_view subject = trimmed(arguments.substr(0, sign));
  const Result<double> value = engine_.evaluate(trimmed(arguments.substr(sign + 1)));
  if (!value) return value.error();
  const Result<void> done = debug::assign(engine_, subject, *value);
  if (!done) return done.error();
  return Outcome::done;
}

Console::Done Console::send(std::string_view arguments) {
  const Result<std::int32_t> value = engine_.execute(arguments);
  if (!value) return value.error();
  show_value(std::string(arguments), static_cast<double>(*value));
  return Outcome::done;
}

Console::Done Console::measure(std::string_view arguments) {
  TwinPowers* const twin = engine_.target().twin();
  if (twin == nullptr) return only_on_a_twin("quantities of the bench");
  const Result<std::string> text = twin->quantity(arguments);
  if (!text) return text.error();
  print_line(*text);
  return Outcome::done;
}

Console::Done Console::display(std::string_view arguments) {
  if (!arguments.empty()) {
    const Result<double> value = engine_.evaluate(arguments);
    if (!value && value.error().kind == ErrorKind::usage) return value.error();
    displays_.emplace(++last_display_, arguments);
    show_value(fmt::format("{}: {}", last_display_, arguments), value);
    return Outcome::done;
  }
  show_displays();
  return Outcome::done;
}

Console::Done Console::undisplay(std::string_view arguments) {
  const auto number = number_in<int>(arguments);
  if (!number || displays_.erase(*number) == 0) {
    return mistake("there is no display " + lang::in_quotes(arguments));
  }
  return Outcome::done;
}

void Console::show_displays() {
  for (const auto& [number, text] : displays_) show_value(fmt::format("{}: {}", number, text), engine_.evaluate(text));
}

Console::Done Console::info(std::string_view arguments) {
  struct Subject {
    std::string_view name;
    Done (Console::*show)();
  };
  constexpr Subject subjects[] = {{"registers", &Console::info_registers},
                                  {"breakpoints", &Console::info_breakpoints},
                                  {"variables", &Console::info_variables},
                                  {"program", &Console::info_program},
                                  {"signals", &Console::info_signals}};
  for (const Subject& subject : subjects) {
    if (!arguments.empty() && subject.name.starts_with(arguments)) return (this->*subject.show)();
  }
  return mistake("expected registers, breakpoints, variables, program or signals behind info");
}

Console::Done Console::info_registers() {
  const Result<RegisterValues> registers = engine_.registers();
  if (!registers) return registers.error();
  print_line(fmt::format("A            {}", registers->accumulator));
  print_line(fmt::format("X            {}", registers->x));
  print_line(
      fmt::format("PC           {} ({})", registers->program_counter, listing_.place(registers->program_counter)));
  const std::string depth = fmt::format("{}{}", engine_.frames().size() - 1,
                                        engine_.frames_are_whole() ? "" : " or more: not all of it was seen");
  print_line("stack depth  " + depth);
  if (!registers->inner) {
    print_line("flags        not visible on a module");
    print_line("interrupts   not visible on a module");
    return Outcome::done;
  }
  const InnerState& inner = *registers->inner;
  print_line(fmt::format("comparison   {}", name_of(inner.comparison)));
  print_line(fmt::format("error flags  {}", names_of_error_flags(inner.error_flags)));
  print_line(fmt::format("interrupts   {}{}", names_of_interrupts(inner.enabled_interrupts),
                         inner.interrupted ? "; in a routine" : ""));
  return Outcome::done;
}

Console::Done Console::info_variables() {
  unsigned shown = 0;
  for (unsigned number = 0; number < user_variable_count; ++number) {
    const Result<std::int32_t> value = engine_.variable(static_cast<std::uint8_t>(number));
    if (!value) return value.error();
    if (*value == 0) continue;
    ++shown;
    print_line(fmt::format("VAR({}) = {}", number, *value));
  }
  print_line(fmt::format("{} of {} user variables are not 0", shown, user_variable_count));
  return Outcome::done;
}

Console::Done Console::info_signals() {
  TwinPowers* const twin = engine_.target().twin();
  if (twin == nullptr) return only_on_a_twin("signals");
  for (const std::string_view name : twin->quantity_names()) {
    const Result<std::string> text = twin->quantity(name);
    if (!text) return text.error();
    print_line(*text);
  }
  return Outcome::done;
}

Console::Done Console::info_program() {
  const Program& program = engine_.program();
  print_line(fmt::format("{}: {} of {} instructions of a {}", program.file_name(0), program.size(),
                         program.module().program_capacity, program.module().name));
  for (const lang::Label& label : program.labels()) print_line(fmt::format("{:6}  {}", label.address, label.name));
  return Outcome::done;
}

Console::Done Console::backtrace(std::string_view) {
  const std::vector<Frame> frames = engine_.frames();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    print_line(fmt::format("#{}  {}{}", i, listing_.place(frames[i].address),
                           frames[i].is_interrupt ? "   (interrupt routine)" : ""));
  }
  if (!engine_.frames_are_whole()) print_line("there may be more: not all of the program's steps were seen");
  return Outcome::done;
}

Console::Done Console::list(std::string_view arguments) {
  constexpr std::size_t usual_count = 10;
  const Program& program = engine_.program();
  const auto has_breakpoint = [this](std::uint16_t address) {
    return std::any_of(engine_.breakpoints().begin(), engine_.breakpoints().end(), [&](const auto& entry) {
      const BreakpointRequest& request = entry.second.request;
      return entry.second.enabled && request.kind == BreakpointRequest::Kind::address && request.address == address;
    });
  };
  std::uint16_t middle = engine_.stop().address;
  if (arguments.empty() && listed_until_) {
    middle = *listed_until_;
  } else if (!arguments.empty()) {
    const Result<std::uint16_t> wanted = place(arguments);
    if (!wanted) return wanted.error();
    middle = *wanted;
  }
  const bool goes_on = arguments.empty() && listed_until_;
  const std::vector<std::string> lines =
      listing_.lines(middle, goes_on ? 0 : usual_count / 2, usual_count, engine_.stop().address, has_breakpoint);
  if (lines.empty()) return examine(arguments);
  for (const std::string& line : lines) print_line(line);
  // An empty line goes on where this ends.
  const auto line = program.line_of(middle);
  const std::size_t first = goes_on || line->line <= usual_count / 2 ? line->line : line->line - usual_count / 2;
  listed_until_ = program.address_of(line->file, first + usual_count);
  last_line_ = listed_until_ ? "list" : "";
  return Outcome::done;
}

}  // namespace opentmcl::debug
