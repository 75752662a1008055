#include "scenario/scenario_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "firmware/module/module.hpp"
#include "firmware/wire/datagram.hpp"
#include "scenario/recording_format.hpp"

namespace opentmcl::scenario {
namespace {

void write(twin::World& world, const Assignment& assignment) {
  assignment.quantity->write(world, assignment.value);
}

/// What the module answers, as a host at its USB port hears it; nothing while it is busy with its EEPROM.
std::optional<Reply> answer(VirtualModule& module, const Command& command) {
  constexpr std::uint8_t any_address = 1;
  Datagram bytes;
  const Module::Handling handling =
      module.module().handle(encode(Request{any_address, command}), hal::PortKind::usb, module.now(), bytes);
  module.wake();
  if (handling == Module::Handling::busy) return std::nullopt;
  return handling == Module::Handling::answered ? decode_reply(bytes) : Reply{};
}

}  // namespace

ScenarioRun::ScenarioRun(const Scenario& scenario, const VirtualModule& module, Listener listener)
    : begin_(module.now()),
      listener_(std::move(listener)),
      next_look_(begin_),
      end_(scenario.duration == 0 ? never : begin_ + scenario.duration) {
  for (const Event& event : scenario.events) {
    if (event.at) timed_.push_back({&event, begin_ + *event.at});
    if (event.when) waiting_.push_back({&event});
  }
  for (const Expectation& expectation : scenario.expectations) {
    expectations_.push_back({&expectation, begin_ + (expectation.at ? *expectation.at : *expectation.by)});
  }
}

bool ScenarioRun::looks_regularly() const {
  const auto waits = [](const WaitingEvent& waiting) { return !waiting.is_over; };
  const auto may_come = [](const OpenExpectation& open) { return open.is_open && open.expectation->by; };
  return !ramps_.empty() || !commands_.empty() || std::any_of(waiting_.begin(), waiting_.end(), waits) ||
         std::any_of(expectations_.begin(), expectations_.end(), may_come);
}

Microseconds ScenarioRun::next_act() const {
  if (ended_) return never;
  Microseconds next = looks_regularly() ? std::min(next_look_, end_) : end_;
  for (const TimedEvent& timed : timed_) next = std::min(next, timed.next);
  for (const PulseEnd& pulse : pulses_) next = std::min(next, pulse.time);
  for (const OpenExpectation& open : expectations_) {
    if (open.is_open) next = std::min(next, open.due);
  }
  return next;
}

void ScenarioRun::act(VirtualModule& module) {
  const Microseconds now = module.now();
  const bool is_look = now >= next_look_;
  if (is_look) next_look_ += ((now - next_look_) / look_interval + 1) * look_interval;

  move(module.world(), now);
  if (is_look) send_pending(module);
  for (TimedEvent& timed : timed_) {
    if (timed.next > now) continue;
    happen(*timed.event, module, now);
    timed.next = timed.event->every == 0 ? never : timed.next + timed.event->every;
  }
  for (WaitingEvent& waiting : waiting_) {
    if (is_look) wait_for(waiting, module, now);
  }
  for (OpenExpectation& open : expectations_) {
    if (open.is_open && (open.due <= now || (is_look && open.expectation->by))) check(open, module, now);
  }
  if (now >= end_) ended_ = true;
  if (ended_) report(Report::Kind::end, end_place_, now, "the end");
}

/// Pulses end and ramps move.
void ScenarioRun::move(twin::World& world, Microseconds now) {
  for (const PulseEnd& pulse : pulses_) {
    if (pulse.time <= now) write(world, pulse.former);
  }
  std::erase_if(pulses_, [now](const PulseEnd& pulse) { return pulse.time <= now; });
  for (const Ramp& ramp : ramps_) {
    const double share = std::min(1.0, static_cast<double>(now - ramp.begin) / static_cast<double>(ramp.duration));
    const double value = ramp.from + (ramp.end.value - ramp.from) * share;
    const bool is_whole = ramp.end.quantity->kind != twin::Quantity::Kind::real;
    write(world, {ramp.end.quantity, share == 1 ? ramp.end.value : is_whole ? std::round(value) : value});
  }
  std::erase_if(ramps_, [now](const Ramp& ramp) { return now - ramp.begin >= ramp.duration; });
}

/// What a quantity goes back to: a pulse that begins while another one is under way prolongs it.
double ScenarioRun::value_without_pulse(const twin::Quantity& quantity, const twin::World& world) const {
  for (const PulseEnd& pulse : pulses_) {
    if (pulse.former.quantity == &quantity) return pulse.former.value;
  }
  return quantity.read(world);
}

void ScenarioRun::happen(const Event& event, VirtualModule& module, Microseconds now) {
  twin::World& world = module.world();
  if (!event.note.empty()) report(Report::Kind::note, event.place, now, event.note);
  // Who says something new about a quantity ends what was under way.
  const auto take_over = [this](const Assignment& assignment) {
    const auto is_same = [&assignment](const twin::Quantity* quantity) { return quantity == assignment.quantity; };
    std::erase_if(ramps_, [&](const Ramp& ramp) { return is_same(ramp.end.quantity); });
    std::erase_if(pulses_, [&](const PulseEnd& pulse) { return is_same(pulse.former.quantity); });
  };
  for (const Assignment& assignment : event.set) {
    take_over(assignment);
    write(world, assignment);
  }
  for (const Assignment& assignment : event.pulse) {
    const double former = value_without_pulse(*assignment.quantity, world);
    take_over(assignment);
    pulses_.push_back({{assignment.quantity, former}, now + event.lasting});
    write(world, assignment);
  }
  for (const Assignment& assignment : event.ramp) {
    take_over(assignment);
    ramps_.push_back({assignment, assignment.quantity->read(world), now, std::max(event.over, Microseconds{1})});
  }
  if (event.power_cycle) module.power_cycle();
  for (const HostCommand& command : event.send) commands_.push_back({&command, event.place});
  if (!event.send.empty()) send_pending(module);
  if (event.end) {
    ended_ = true;
    end_place_ = event.place;
  }
}

void ScenarioRun::wait_for(WaitingEvent& waiting, VirtualModule& module, Microseconds now) {
  if (waiting.is_over) return;
  if (!waiting.event->when->holds(module.world())) {
    waiting.true_since = never;
    waiting.has_happened = false;
    return;
  }
  if (waiting.true_since == never) waiting.true_since = now;
  if (waiting.has_happened || now - waiting.true_since < waiting.event->held_for) return;
  waiting.has_happened = true;
  waiting.is_over = !waiting.event->repeat;
  happen(*waiting.event, module, now);
}

/// Commands wait for each other while the module is busy.
void ScenarioRun::send_pending(VirtualModule& module) {
  while (!commands_.empty()) {
    const PendingCommand pending = commands_.front();
    const std::optional<Reply> reply = answer(module, pending.command->command);
    if (!reply) return;
    commands_.pop_front();
    if (reply->status == Status::ok || reply->status == Status::command_loaded) continue;
    ++failures_;
    report(Report::Kind::failed, pending.place, module.now(),
           pending.command->text + " was answered with status " + std::to_string(static_cast<int>(reply->status)));
  }
}

void ScenarioRun::check(OpenExpectation& open, VirtualModule& module, Microseconds now) {
  const Expectation& expectation = *open.expectation;
  if (expectation.answer_to) {
    open.is_open = false;
    check_answer(expectation, module, now);
    return;
  }
  const bool holds = expectation.that->holds(module.world());
  if (!holds && expectation.by && now < open.due) return;
  open.is_open = false;
  if (!holds) ++failures_;
  report(holds ? Report::Kind::met : Report::Kind::failed, expectation.place, now,
         expectation.that->text + "; " + expectation.that->values(module.world()));
}

void ScenarioRun::check_answer(const Expectation& expectation, VirtualModule& module, Microseconds now) {
  const std::optional<Reply> reply = answer(module, expectation.answer_to->command);
  const std::string& command = expectation.answer_to->text;
  const bool is_met = reply && reply->status == Status::ok && reply->value == expectation.is;
  if (!is_met) ++failures_;
  std::string found = "nothing, the module is busy";
  if (reply) found = std::to_string(reply->value);
  if (reply && reply->status != Status::ok) found = "status " + std::to_string(static_cast<int>(reply->status));
  report(is_met ? Report::Kind::met : Report::Kind::failed, expectation.place, now,
         command + " is " + std::to_string(expectation.is) + "; the answer is " + found);
}

void ScenarioRun::finish(const VirtualModule& module) {
  for (OpenExpectation& open : expectations_) {
    if (!open.is_open) continue;
    open.is_open = false;
    ++failures_;
    report(Report::Kind::failed, open.expectation->place, module.now(), "the run ended before this was looked at");
  }
  ended_ = true;
}

void ScenarioRun::report(Report::Kind kind, Place place, Microseconds now, std::string text) {
  if (listener_) listener_({kind, place, now - begin_, std::move(text)});
}

}  // namespace opentmcl::scenario
