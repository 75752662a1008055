// Commands that let the program go, and what is shown when it stands again.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "debug/console/console.hpp"
#include "debug/console/place.hpp"
#include "debug/mistake.hpp"
#include "debug/typed_text.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::Result;
using nlohmann::ordered_json;

namespace {

const char* word_of(Stop::Reason reason) {
  switch (reason) {
    case Stop::Reason::entry:
      return "entry";
    case Stop::Reason::step:
      return "step";
    case Stop::Reason::breakpoint:
      return "breakpoint";
    case Stop::Reason::change:
      return "change";
    case Stop::Reason::signal:
      return "signal";
    case Stop::Reason::trouble:
      return "trouble";
    case Stop::Reason::pause:
      return "pause";
    case Stop::Reason::limit:
      return "limit";
    case Stop::Reason::ended:
      return "ended";
    case Stop::Reason::beginning:
      return "beginning";
  }
  return "";
}

/// What a person is told besides the place; empty: the place says it.
std::string sentence_of(const Stop& stop) {
  std::string numbers;
  for (const int number : stop.breakpoints) numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", number);
  const std::string description = stop.description.empty() ? "" : ": " + stop.description;
  switch (stop.reason) {
    case Stop::Reason::entry:
    case Stop::Reason::step:
      return "";
    case Stop::Reason::breakpoint:
    case Stop::Reason::change:
    case Stop::Reason::signal:
      return fmt::format("breakpoint {}{}", numbers, description);
    case Stop::Reason::trouble:
      return stop.description;
    case Stop::Reason::pause:
      return stop.waiting ? "paused in a WAIT" : "paused";
    case Stop::Reason::limit:
      return "not done within the time limit";
    case Stop::Reason::ended:
      return "the program has ended";
    case Stop::Reason::beginning:
      return "the beginning of the history";
  }
  return "";
}

Result<unsigned> count_in(std::string_view text) {
  if (text.empty()) return 1U;
  const unsigned count = number_in<unsigned>(text).value_or(0);
  if (count > 0) return count;
  return mistake("expected a count from 1 on, not " + lang::in_quotes(text));
}

}  // namespace

void Console::show_stop(const Stop& stop) {
  listed_until_.reset();
  const Program& program = engine_.program();
  if (options_.json) {
    ordered_json event{{"event", "stopped"}, {"reason", word_of(stop.reason)}, {"address", stop.address}};
    event["place"] = program.name_of(stop.address);
    if (const auto line = program.line_of(stop.address)) {
      event["file"] = program.file_name(line->file);
      event["line"] = line->line;
    }
    if (!stop.breakpoints.empty()) event["breakpoints"] = stop.breakpoints;
    if (!stop.description.empty()) event["description"] = stop.description;
    if (stop.waiting) event["waiting"] = true;
    if (TwinPowers* const twin = engine_.target().twin()) event["time"] = static_cast<double>(twin->now().time) / 1e6;
    surroundings_.print(event.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  } else {
    const std::string sentence = sentence_of(stop);
    print_line(fmt::format("{}{}{}", listing_.emphasised(sentence), sentence.empty() ? "" : ", at ",
                           listing_.place(stop.address)));
    const Result<Command> command = engine_.command_at(stop.address);
    if (command) print_line(listing_.current_line(stop.address, *command));
  }
  show_displays();
}

bool Console::goes_on(const Underway& underway) {
  if (surroundings_.show_progress && underway.waiting) {
    const auto command = engine_.command_at(underway.address);
    if (command) {
      surroundings_.show_progress(fmt::format("waiting at {}: {}   (Ctrl-C pauses)", listing_.place(underway.address),
                                              engine_.program().text_of(*command)));
      shows_progress_ = true;
    }
  }
  return !surroundings_.take_interruption();
}

Console::Done Console::move(Motion motion) {
  motion.limit = options_.limit;
  Result<Stop> stop = engine_.go(motion, [this](const Underway& underway) { return goes_on(underway); });
  if (shows_progress_) surroundings_.show_progress("");
  shows_progress_ = false;
  if (!stop) return stop.error();
  show_stop(*stop);
  if (stop->reason != Stop::Reason::limit) return Outcome::done;
  return Error{ErrorKind::timeout, "the program did not stop within the time limit; it is paused", {}};
}

Console::Done Console::move_repeatedly(Motion::Kind kind, std::string_view arguments) {
  const Result<unsigned> count = count_in(arguments);
  if (!count) return count.error();
  for (unsigned i = 1; i < *count; ++i) {
    Motion motion{kind, 0, options_.limit};
    const Result<Stop> stop = engine_.go(motion, [this](const Underway& underway) { return goes_on(underway); });
    if (!stop) return stop.error();
    if (stop->reason == Stop::Reason::step) continue;
    show_stop(*stop);
    return Outcome::done;
  }
  return move({kind, 0, {}});
}

Console::Done Console::restart(std::string_view) {
  const Result<Stop> stop = engine_.restart();
  if (!stop) return stop.error();
  show_stop(*stop);
  return Outcome::done;
}

Console::Done Console::run(std::string_view) {
  const Result<Stop> stop = engine_.restart();
  if (!stop) return stop.error();
  if (engine_.breakpoints().empty()) return move({Motion::Kind::run, 0, {}});
  for (const auto& [number, breakpoint] : engine_.breakpoints()) {
    const bool is_at_begin = breakpoint.enabled && breakpoint.request.kind == BreakpointRequest::Kind::address &&
                             breakpoint.request.address == stop->address && breakpoint.request.condition.empty() &&
                             breakpoint.request.hit_condition.empty() && !breakpoint.is_logpoint();
    if (!is_at_begin) continue;
    Stop there = *stop;
    there.reason = Stop::Reason::breakpoint;
    there.breakpoints = {number};
    if (breakpoint.request.temporary) engine_.remove(number);
    show_stop(there);
    return Outcome::done;
  }
  return move({Motion::Kind::run, 0, {}});
}

Console::Done Console::go_on(std::string_view) {
  return move({Motion::Kind::run, 0, {}});
}

Console::Done Console::step(std::string_view arguments) {
  return move_repeatedly(Motion::Kind::step, arguments);
}

Console::Done Console::next(std::string_view arguments) {
  return move_repeatedly(Motion::Kind::step_over, arguments);
}

Console::Done Console::finish(std::string_view) {
  return move({Motion::Kind::step_out, 0, {}});
}

Console::Done Console::until(std::string_view arguments) {
  const Result<std::uint16_t> address = place(arguments);
  if (!address) return address.error();
  return move({Motion::Kind::run_to, *address, {}});
}

Console::Done Console::jump(std::string_view arguments) {
  const Result<std::uint16_t> address = place(arguments);
  if (!address) return address.error();
  const Result<Stop> stop = engine_.jump(*address);
  if (!stop) return stop.error();
  show_stop(*stop);
  return Outcome::done;
}

Console::Done Console::reverse_step(std::string_view arguments) {
  return move_repeatedly(Motion::Kind::reverse_step, arguments);
}

Console::Done Console::reverse_next(std::string_view arguments) {
  return move_repeatedly(Motion::Kind::reverse_step_over, arguments);
}

Console::Done Console::reverse_finish(std::string_view) {
  return move({Motion::Kind::reverse_step_out, 0, {}});
}

Console::Done Console::reverse_continue(std::string_view) {
  return move({Motion::Kind::reverse_run, 0, {}});
}

Console::Done Console::animate(std::string_view arguments) {
  double speed = 2;
  if (!arguments.empty()) {
    const Result<double> wanted = engine_.evaluate(arguments);
    if (!wanted) return wanted.error();
    speed = *wanted;
  }
  constexpr double slowest = 0.01;
  constexpr double fastest = 1000;
  if (speed < slowest || speed > fastest) {
    return mistake("expected 0.01 to 1000 steps a second, not " + value_text(speed));
  }
  constexpr std::chrono::milliseconds longest_nap(50);
  const client::Duration begin = engine_.target().now();
  while (true) {
    const Result<Stop> stop = engine_.go({Motion::Kind::step, 0, options_.limit},
                                         [this](const Underway& underway) { return goes_on(underway); });
    if (!stop) return stop.error();
    show_stop(*stop);
    if (stop->reason != Stop::Reason::step) return Outcome::done;
    if (options_.limit && engine_.target().now() - begin >= *options_.limit) return Outcome::done;
    auto left = std::chrono::milliseconds(static_cast<std::int64_t>(1000 / speed));
    while (true) {
      if (surroundings_.take_interruption()) return Outcome::done;
      if (left.count() <= 0) break;
      const auto nap = std::min(left, longest_nap);
      surroundings_.sleep(nap);
      left -= nap;
    }
  }
}

}  // namespace opentmcl::debug
