// Breakpoints of an engine, and whether the program meets one.

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "debug/engine.hpp"
#include "debug/troubles.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::Result;

Result<int> Engine::add(BreakpointRequest request) {
  if (request.kind == BreakpointRequest::Kind::address && request.address >= stops_at_.size()) {
    return Error{ErrorKind::usage,
                 "there is no address " + std::to_string(request.address) + ": the memory of a " +
                     target_.module().name + " ends at " + std::to_string(stops_at_.size() - 1),
                 {}};
  }
  Result<Breakpoint> made = make_breakpoint(std::move(request), program_, target_.twin());
  if (!made) return made.error();
  made->number = ++last_number_;
  // What it is now is no change. A running module is not asked: it is when it is looked at for the first time.
  if (made->signal) made->signal_held = made->signal->holds();
  breakpoints_.emplace(last_number_, std::move(*made));
  count_breakpoints();
  return last_number_;
}

bool Engine::remove(int number) {
  const bool existed = breakpoints_.erase(number) > 0;
  count_breakpoints();
  return existed;
}

bool Engine::enable(int number, bool enabled) {
  const auto found = breakpoints_.find(number);
  if (found == breakpoints_.end()) return false;
  found->second.enabled = enabled;
  count_breakpoints();
  return true;
}

void Engine::stop_at_troubles(std::uint8_t troubles) {
  trouble_filter_ = troubles;
}

void Engine::count_breakpoints() {
  std::fill(stops_at_.begin(), stops_at_.end(), std::uint8_t{0});
  unplaced_ = 0;
  for (const auto& [number, breakpoint] : breakpoints_) {
    if (!breakpoint.enabled) continue;
    if (breakpoint.request.kind == BreakpointRequest::Kind::address) {
      stops_at_[breakpoint.request.address] = 1;
    } else {
      ++unplaced_;
    }
  }
}

Result<std::uint8_t> Engine::troubles() {
  if (trouble_filter_ == 0) return std::uint8_t{0};
  if (const TwinPowers* const twin = target_.twin()) return twin->troubles();
  return troubles_of(target_.client(), target_.module(), trouble_filter_);
}

Result<void> Engine::begin_looking() {
  const Result<std::uint8_t> now = troubles();
  if (!now) return now.error();
  known_troubles_ = *now;
  for (auto& [number, breakpoint] : breakpoints_) {
    if (!breakpoint.enabled) continue;
    if (breakpoint.signal) breakpoint.signal_held = breakpoint.signal->holds();
    if (!breakpoint.watched) continue;
    const Result<double> value = breakpoint.watched->evaluate(*this);
    if (!value) return value.error();
    breakpoint.last_value = *value;
  }
  return {};
}

Result<Engine::Look> Engine::condition_of(const Breakpoint& breakpoint) {
  if (!breakpoint.condition) return Look{true, {}};
  const Result<double> value = breakpoint.condition->evaluate(*this);
  if (value) return Look{*value != 0, {}};
  // Of the user's making, such as a division by zero; a connection that is gone is another thing.
  if (value.error().kind == ErrorKind::usage || value.error().kind == ErrorKind::refused) {
    return Look{true, "its condition fails: " + value.error().message};
  }
  return value.error();
}

Result<Engine::Look> Engine::look_at(Breakpoint& breakpoint, bool at_instruction) {
  switch (breakpoint.request.kind) {
    case BreakpointRequest::Kind::address:
      if (!at_instruction || breakpoint.request.address != status_.program_counter) return Look{};
      return condition_of(breakpoint);
    case BreakpointRequest::Kind::change: {
      if (!at_instruction) return Look{};
      const Result<double> value = breakpoint.watched->evaluate(*this);
      if (!value) return value.error();
      const std::optional<double> before = std::exchange(breakpoint.last_value, *value);
      if (!before || *before == *value) return Look{};
      Result<Look> look = condition_of(breakpoint);
      if (look.ok() && look->hit) {
        look->description =
            breakpoint.request.subject + ": " + value_text(*before) + " -> " + value_text(*value) + look->description;
      }
      return look;
    }
    case BreakpointRequest::Kind::signal: {
      const bool holds = breakpoint.signal->holds();
      if (std::exchange(breakpoint.signal_held, holds) || !holds) return Look{};
      Result<Look> look = condition_of(breakpoint);
      if (look.ok() && look->hit) {
        look->description = breakpoint.request.subject + ": " + breakpoint.signal->values() + look->description;
      }
      return look;
    }
  }
  return Look{};
}

Result<std::optional<Stop>> Engine::met(bool at_instruction, bool counts) {
  if (trouble_filter_ != 0) {
    const Result<std::uint8_t> now = troubles();
    if (!now) return now.error();
    const auto fresh = static_cast<std::uint8_t>(*now & ~known_troubles_ & trouble_filter_);
    known_troubles_ = *now;
    if (fresh != 0) return std::optional(stand(Stop::Reason::trouble, names_of_troubles(fresh)));
  }
  const std::uint16_t address = status_.program_counter;
  const bool stops_here = at_instruction && address < stops_at_.size() && stops_at_[address] != 0;
  if (!stops_here && unplaced_ == 0) return std::optional<Stop>();

  Stop::Reason reason = Stop::Reason::signal;
  std::vector<int> numbers;
  std::string description;
  for (auto& [number, breakpoint] : breakpoints_) {
    if (!breakpoint.enabled) continue;
    Result<Look> look = look_at(breakpoint, at_instruction);
    if (!look) return look.error();
    if (!look->hit) continue;
    if (counts) {
      ++breakpoint.hits;
      if (breakpoint.hit_condition && !breakpoint.hit_condition->holds(breakpoint.hits)) continue;
    }
    if (breakpoint.log_message) {
      if (counts && output_) output_(breakpoint.log_message->fill_in(*this));
      continue;
    }
    numbers.push_back(number);
    if (!look->description.empty()) description += (description.empty() ? "" : "; ") + look->description;
    if (breakpoint.request.kind == BreakpointRequest::Kind::address) {
      reason = Stop::Reason::breakpoint;
    } else if (breakpoint.request.kind == BreakpointRequest::Kind::change && reason == Stop::Reason::signal) {
      reason = Stop::Reason::change;
    }
  }
  if (numbers.empty()) return std::optional<Stop>();
  if (counts) {
    for (const int number : numbers) {
      if (breakpoints_.at(number).request.temporary) remove(number);
    }
  }
  Stop stop = stand(reason, std::move(description));
  stop.breakpoints = stop_.breakpoints = std::move(numbers);
  return std::optional(std::move(stop));
}

}  // namespace opentmcl::debug
