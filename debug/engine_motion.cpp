// How an engine lets a program go forward.

#include <utility>

#include "debug/engine.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::ProgramStatus;
using client::Result;

namespace {

bool is_over(const Motion& motion, client::Duration begin, client::Duration now) {
  return motion.limit && now - begin >= *motion.limit;
}

}  // namespace

Stop Engine::stand(Stop::Reason reason, std::string description) {
  running_ = false;
  stop_ = Stop{reason, status_.program_counter, {}, std::move(description), !at_instruction_};
  return stop_;
}

std::int64_t Engine::level() const {
  const TwinPowers* const twin = target_.twin();
  return twin != nullptr ? static_cast<std::int64_t>(twin->depth()) : calls_.level();
}

bool Engine::needs_stepping(const Motion& motion) const {
  if (motion.kind != Motion::Kind::run || steps_like_running(target_) || unplaced_ > 0) return true;
  for (const auto& [number, breakpoint] : breakpoints_) {
    if (breakpoint.enabled) return true;
  }
  return false;
}

bool Engine::is_done(const Motion& motion, std::int64_t level_at_begin) const {
  switch (motion.kind) {
    case Motion::Kind::step:
      return true;
    case Motion::Kind::step_over:
      return level() <= level_at_begin;
    case Motion::Kind::step_out:
      return level() < level_at_begin;
    case Motion::Kind::run_to:
      return status_.program_counter == motion.address;
    default:
      return false;
  }
}

Result<void> Engine::halt() {
  const Result<ProgramStatus> status = target_.halt();
  if (!status) return status.error();
  status_ = *status;
  running_ = false;
  // A WAIT that was under way goes on with the next step.
  at_instruction_ = true;
  return {};
}

Result<bool> Engine::step_once() {
  const std::uint16_t before = status_.program_counter;
  if (before >= target_.module().program_capacity) {
    ended_ = true;
    return true;
  }
  const Result<Command> instruction = command_at(before);
  if (!instruction) return instruction.error();
  if (at_instruction_) remember_moment();
  const Result<ProgramStatus> status = target_.step(before, *instruction);
  if (!status) return status.error();
  status_ = *status;
  ended_ = status_.state == ProgramStatus::State::stopped;
  at_instruction_ = ended_ || status_.program_counter != before || can_jump(static_cast<Opcode>(instruction->opcode));
  if (at_instruction_ && !ended_) calls_.note(before, *instruction, status_.program_counter);
  return at_instruction_;
}

Result<Stop> Engine::go_forward(const Motion& motion, const KeepGoing& keep_going) {
  if (ended_) return Error{ErrorKind::usage, "the program has ended; restart it", {}};
  if (motion.kind == Motion::Kind::step_out && frames_are_whole() && !running_ && frames().size() == 1) {
    return Error{ErrorKind::usage, "no subroutine is open, so there is no way out", {}};
  }
  if (running_ && needs_stepping(motion)) {
    if (Result<void> halted = halt(); !halted) return halted.error();
  }
  if (Result<void> begun = begin_looking(); !begun) return begun.error();
  const std::int64_t level_at_begin = level();
  const client::Duration begin = target_.now();
  Underway underway;
  while (true) {
    if (!needs_stepping(motion)) {
      Result<std::optional<Stop>> stop = run_unseen(motion, begin, keep_going);
      if (!stop) return stop.error();
      if (*stop) return **std::move(stop);
    }
    for (unsigned i = 0; i < target_.steps_a_slice(); ++i) {
      const Result<bool> stepped = step_once();
      if (!stepped) return stepped.error();
      // What has happened may be why it has ended.
      const Result<std::optional<Stop>> stop = met(*stepped && !ended_, true);
      if (!stop) return stop.error();
      if (*stop) return **stop;
      if (ended_) return stand(Stop::Reason::ended);
      if (!*stepped) {
        target_.rest();
        break;
      }
      ++underway.steps;
      if (is_done(motion, level_at_begin)) return stand(Stop::Reason::step);
    }
    underway.address = status_.program_counter;
    underway.waiting = !at_instruction_;
    if (!keep_going(underway)) return stand(Stop::Reason::pause);
    if (is_over(motion, begin, target_.now())) return stand(Stop::Reason::limit);
  }
}

/// @return nothing when the program has to be stepped from now on
Result<std::optional<Stop>> Engine::run_unseen(const Motion& motion, client::Duration begin,
                                               const KeepGoing& keep_going) {
  if (!running_) {
    if (Result<void> runs = target_.let_run(); !runs) return runs.error();
  }
  running_ = true;
  calls_.forget();
  while (true) {
    target_.rest();
    const Result<ProgramStatus> status = target_.status();
    if (!status) return status.error();
    status_ = *status;
    at_instruction_ = true;
    ended_ = status_.state == ProgramStatus::State::stopped;
    const Result<std::optional<Stop>> trouble = met(false, true);
    if (!trouble) return trouble.error();
    if (ended_) return *trouble ? *trouble : std::optional(stand(Stop::Reason::ended));
    const bool goes_on = keep_going({status_.program_counter, false, 0});
    const bool in_time = !is_over(motion, begin, target_.now());
    if (!*trouble && goes_on && in_time && !needs_stepping(motion)) continue;
    if (Result<void> halted = halt(); !halted) return halted.error();
    if (*trouble) return std::optional(stand(Stop::Reason::trouble, (*trouble)->description));
    if (!goes_on) return std::optional(stand(Stop::Reason::pause));
    if (!in_time) return std::optional(stand(Stop::Reason::limit));
    return std::optional<Stop>();
  }
}

}  // namespace opentmcl::debug
