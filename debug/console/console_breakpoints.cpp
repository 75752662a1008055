// Commands for breakpoints.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "debug/console/console.hpp"
#include "debug/console/place.hpp"
#include "debug/mistake.hpp"
#include "debug/troubles.hpp"
#include "debug/typed_text.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::debug {

using client::Error;
using client::Result;
using nlohmann::ordered_json;

namespace {

/// Where a word of its own begins, or npos.
std::size_t find_word(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const bool begins = at == 0 || text[at - 1] == ' ';
    const bool ends = at + word.size() == text.size() || text[at + word.size()] == ' ';
    if (begins && ends) return at;
  }
  return std::string_view::npos;
}

Result<std::vector<int>> numbers_in(std::string_view text) {
  std::vector<int> numbers;
  while (!text.empty()) {
    const std::string_view word = take_word(text);
    const auto number = number_in<int>(word);
    if (!number) return mistake("expected the number of a breakpoint, not " + lang::in_quotes(word));
    numbers.push_back(*number);
  }
  return numbers;
}

Error no_such_breakpoint(int number) {
  return mistake(fmt::format("there is no breakpoint {}; `info breakpoints` lists them", number));
}

}  // namespace

Result<std::uint16_t> Console::place(std::string_view text) const {
  if (text.empty()) return mistake("expected a place: a line (12), FILE:LINE, a label (Loop) or an address (*7)");
  return address_of_place(text, engine_.program(), engine_.stop().address);
}

Result<std::uint16_t> Console::place_or_here(std::string_view text) const {
  if (text.empty()) return engine_.stop().address;
  return place(text);
}

std::string Console::describe(const Breakpoint& breakpoint) const {
  const BreakpointRequest& request = breakpoint.request;
  std::string text;
  switch (request.kind) {
    case BreakpointRequest::Kind::address:
      text = listing_.place(request.address);
      break;
    case BreakpointRequest::Kind::change:
      text = "when " + request.subject + " changes";
      break;
    case BreakpointRequest::Kind::signal:
      text = "when " + request.subject;
      break;
  }
  if (!request.condition.empty()) text += ", if " + request.condition;
  if (breakpoint.hit_condition) text += ", hits " + breakpoint.hit_condition->text();
  if (breakpoint.is_logpoint()) text += ", says \"" + request.log_message + "\"";
  if (request.temporary) text += ", once";
  if (!breakpoint.enabled) text += ", disabled";
  return text;
}

Console::Done Console::added(Result<int> number) {
  if (!number) return number.error();
  const Breakpoint& breakpoint = engine_.breakpoints().at(*number);
  if (options_.json) {
    ordered_json event{{"event", "breakpoint"}, {"number", *number}, {"text", describe(breakpoint)}};
    if (breakpoint.request.kind == BreakpointRequest::Kind::address) event["address"] = breakpoint.request.address;
    surroundings_.print(event.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  } else {
    print_line(fmt::format("breakpoint {}: {}", *number, describe(breakpoint)));
  }
  return Outcome::done;
}

Console::Done Console::add_at_place(std::string_view arguments, bool temporary) {
  BreakpointRequest request;
  request.temporary = temporary;
  // What stands behind "if" may contain anything, also the word "hits": that is looked for from the right.
  if (const std::size_t hits = arguments.rfind(" hits "); hits != std::string_view::npos) {
    request.hit_condition = trimmed(arguments.substr(hits + std::string_view(" hits ").size()));
    arguments = arguments.substr(0, hits);
  } else if (arguments.starts_with("hits ")) {
    request.hit_condition = trimmed(arguments.substr(std::string_view("hits ").size()));
    arguments = {};
  }
  if (const std::size_t at = find_word(arguments, "if"); at != std::string_view::npos) {
    request.condition = trimmed(arguments.substr(at + 2));
    if (request.condition.empty()) return mistake("expected an expression behind 'if'");
    arguments = arguments.substr(0, at);
  }
  const Result<std::uint16_t> address = place_or_here(trimmed(arguments));
  if (!address) return address.error();
  request.address = *address;
  return added(engine_.add(std::move(request)));
}

Console::Done Console::add_breakpoint(std::string_view arguments) {
  return add_at_place(arguments, false);
}

Console::Done Console::add_temporary_breakpoint(std::string_view arguments) {
  return add_at_place(arguments, true);
}

Console::Done Console::add_logpoint(std::string_view arguments) {
  BreakpointRequest request;
  const Result<std::uint16_t> address = place(take_word(arguments));
  if (!address) return address.error();
  if (arguments.empty()) return mistake("expected a message behind the place");
  request.address = *address;
  request.log_message = arguments;
  return added(engine_.add(std::move(request)));
}

Console::Done Console::add_watchpoint(std::string_view arguments) {
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::change;
  request.subject = arguments;
  return added(engine_.add(std::move(request)));
}

Console::Done Console::add_signal(std::string_view arguments) {
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::signal;
  request.subject = arguments;
  return added(engine_.add(std::move(request)));
}

Console::Done Console::catch_troubles(std::string_view arguments) {
  std::uint8_t troubles = 0;
  constexpr Trouble all[] = {Trouble::stall, Trouble::deviation, Trouble::under_voltage};
  while (!arguments.empty()) {
    const std::string_view word = take_word(arguments);
    std::uint8_t wanted = 0;
    for (const Trouble trouble : all) {
      if (names_of_troubles(static_cast<std::uint8_t>(trouble)) == word) wanted = static_cast<std::uint8_t>(trouble);
    }
    if (wanted == 0 && word != "none") {
      return mistake("expected stall, deviation, under-voltage or none, not " + lang::in_quotes(word));
    }
    troubles = static_cast<std::uint8_t>(troubles | wanted);
  }
  engine_.stop_at_troubles(troubles);
  print_line(troubles == 0 ? "nothing is caught" : "caught: " + names_of_troubles(troubles));
  return Outcome::done;
}

Console::Done Console::delete_breakpoints(std::string_view arguments) {
  Result<std::vector<int>> numbers = numbers_in(arguments);
  if (!numbers) return numbers.error();
  if (numbers->empty()) {
    for (const auto& [number, breakpoint] : engine_.breakpoints()) numbers->push_back(number);
  }
  for (const int number : *numbers) {
    if (!engine_.remove(number)) return no_such_breakpoint(number);
  }
  return Outcome::done;
}

Console::Done Console::switch_breakpoints(std::string_view arguments, bool enabled) {
  const Result<std::vector<int>> numbers = numbers_in(arguments);
  if (!numbers) return numbers.error();
  if (numbers->empty()) return mistake("expected the numbers of breakpoints");
  for (const int number : *numbers) {
    if (!engine_.enable(number, enabled)) return no_such_breakpoint(number);
  }
  return Outcome::done;
}

Console::Done Console::enable_breakpoints(std::string_view arguments) {
  return switch_breakpoints(arguments, true);
}

Console::Done Console::disable_breakpoints(std::string_view arguments) {
  return switch_breakpoints(arguments, false);
}

Console::Done Console::info_breakpoints() {
  if (engine_.breakpoints().empty()) print_line("no breakpoints");
  for (const auto& [number, breakpoint] : engine_.breakpoints()) {
    print_line(fmt::format("{:3}  {}; {} hit{}", number, describe(breakpoint), breakpoint.hits,
                           breakpoint.hits == 1 ? "" : "s"));
  }
  return Outcome::done;
}

}  // namespace opentmcl::debug
