// How an engine goes back: a twin can repeat its history up to any moment, and stepping through that finds the moment
// that is wanted.

#include <utility>

#include "debug/engine.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::ProgramStatus;
using client::Result;

namespace {

/// So many instructions can be stepped back without looking for them: 1 MiB.
constexpr std::size_t most_remembered = 1 << 16;

}  // namespace

void Engine::remember_moment() {
  const TwinPowers* const twin = target_.twin();
  if (twin == nullptr) return;
  if (recent_.size() == most_remembered) recent_.pop_front();
  recent_.push_back(twin->now());
}

Result<void> Engine::go_to(Moment moment, const KeepGoing& keep_going) {
  const std::uint16_t address = status_.program_counter;
  Result<void> gone = target_.twin()->go_to(moment, [&] { return keep_going({address, false, 0}); });
  if (!gone) return gone;
  while (!recent_.empty() && !(recent_.back() < moment)) recent_.pop_back();
  const Result<ProgramStatus> status = target_.status();
  if (!status) return status.error();
  status_ = *status;
  ended_ = status_.state == ProgramStatus::State::stopped;
  at_instruction_ = true;
  calls_.forget();
  return {};
}

Result<Stop> Engine::go_back(const Motion& motion, const KeepGoing& keep_going) {
  TwinPowers* const twin = target_.twin();
  if (twin == nullptr) {
    return Error{
        ErrorKind::usage,
        "a module does not go back in time; a twin does (port sim:" + std::string(target_.module().argument) + ")",
        {}};
  }
  const Moment now = twin->now();
  if (!(twin->beginning() < now)) return stand(Stop::Reason::beginning);
  std::optional<Stop> met_there;
  std::optional<Moment> goal;
  if (motion.kind == Motion::Kind::reverse_step && !recent_.empty()) {
    goal = recent_.back();
  } else {
    const Result<std::optional<Moment>> found = moment_before(motion, now, keep_going, met_there);
    if (!found) {
      // Back to where it was: nothing has happened.
      const KeepGoing to_the_end = [](const Underway&) { return true; };
      if (Result<void> returned = go_to(now, to_the_end); !returned) return returned.error();
      if (found.error().kind != ErrorKind::interrupted) return found.error();
      return stand(Stop::Reason::pause);
    }
    goal = *found;
  }
  const Moment destination = goal.value_or(twin->beginning());
  if (Result<void> gone = go_to(destination, keep_going); !gone) {
    if (gone.error().kind != ErrorKind::interrupted) return gone.error();
    const KeepGoing to_the_end = [](const Underway&) { return true; };
    if (Result<void> finished = go_to(destination, to_the_end); !finished) return finished.error();
  }
  if (!goal) return stand(Stop::Reason::beginning);
  if (!met_there) return stand(Stop::Reason::step);
  Stop stop = stand(met_there->reason, met_there->description);
  stop.breakpoints = stop_.breakpoints = met_there->breakpoints;
  return stop;
}

/// Steps through the history from its beginning. @return nothing if what is wanted is not in it
Result<std::optional<Moment>> Engine::moment_before(const Motion& motion, Moment now, const KeepGoing& keep_going,
                                                    std::optional<Stop>& met_there) {
  TwinPowers& twin = *target_.twin();
  const std::int64_t level_now = level();
  if (Result<void> begun = go_to(twin.beginning(), keep_going); !begun) return begun.error();
  if (motion.kind == Motion::Kind::reverse_run) {
    if (Result<void> looking = begin_looking(); !looking) return looking.error();
  }
  std::optional<Moment> found;
  unsigned steps = 0;
  while (!ended_) {
    const Moment here = twin.now();
    const bool is_candidate = motion.kind == Motion::Kind::reverse_step ||
                              (motion.kind == Motion::Kind::reverse_step_over && level() <= level_now) ||
                              (motion.kind == Motion::Kind::reverse_step_out && level() < level_now);
    if (at_instruction_ && is_candidate) found = here;
    const Result<bool> stepped = step_once();
    if (!stepped) return stepped.error();
    if (!(twin.now() < now)) break;
    if (motion.kind == Motion::Kind::reverse_run) {
      const Result<std::optional<Stop>> stop = met(*stepped, false);
      if (!stop) return stop.error();
      if (*stop) {
        found = twin.now();
        met_there = **stop;
      }
    }
    if (++steps % target_.steps_a_slice() == 0 && !keep_going({status_.program_counter, !at_instruction_, steps})) {
      return Error{ErrorKind::interrupted, "interrupted", {}};
    }
  }
  return found;
}

}  // namespace opentmcl::debug
