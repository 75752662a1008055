#include "server/live_simulation.hpp"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <thread>
#include <utility>

#include "server/wake_up.hpp"

namespace opentmcl::server {

namespace {

/// Most hosts send the next request as soon as they have the reply. To be woken takes longer than all the rest of an
/// answer, so the event loop is looked at this often, some 50 us, before it sleeps (docs/performance.md).
constexpr int looks_after_a_request = 64;

Follower::Options follower_options(const LiveSimulation::Options& options) {
  return {.speed = options.speed,
          .duration = options.duration,
          .turn = LiveSimulation::shortest_turn,
          .slice = LiveSimulation::longest_slice};
}

}  // namespace

LiveSimulation::LiveSimulation(boost::asio::io_context& events, VirtualModule& module,
                               std::vector<const RequestQueue*> requests, Options options, WallClock clock)
    : events_(events),
      module_(&module),
      clock_(std::move(clock)),
      follower_(module, std::move(requests), follower_options(options), clock_) {}

void LiveSimulation::run() {
  const auto keep_running = boost::asio::make_work_guard(events_);
  WakeUp wake_up(events_);
  start();
  while (true) {
    const WallTime next = next_turn();
    const WallTime now = next == WallTime::max() ? WallTime{} : clock_();
    if (next <= now) {
      advance(now);
      events_.poll();
    } else {
      wake_up.no_later_than(next);
      if (!handles_event_soon()) events_.run_one();
    }
    if (after_turn_) after_turn_();
    if (stopped_ || is_finished()) return;
  }
}

bool LiveSimulation::handles_event_soon() {
  if (!has_served_) return false;
  has_served_ = false;
  for (int look = 0; look < looks_after_a_request; ++look) {
    if (events_.poll_one() > 0) return true;
    std::this_thread::yield();
  }
  return false;
}

void LiveSimulation::advance(WallTime now) {
  if (errand_) return run_errand(now);
  if (!paused_) follower_.advance(now);
}

void LiveSimulation::serve(WallTime now) {
  has_served_ = true;
  if (errand_) return run_errand(now);
  if (!paused_) follower_.serve(now);
}

WallTime LiveSimulation::next_turn() const {
  if (errand_) return errand_->last_turn;
  return paused_ ? WallTime::max() : follower_.next_turn();
}

// ---- Control of time

void LiveSimulation::pause() {
  paused_ = true;
  end_errand(Outcome::given_up);
}

void LiveSimulation::resume() {
  end_errand(Outcome::given_up);
  paused_ = false;
  follower_.follow_from_here();
  follower_.serve_ports();
}

void LiveSimulation::carry(VirtualModule& module) {
  end_errand(Outcome::given_up);
  module_ = &module;
  follower_.carry(module);
}

void LiveSimulation::run_to(Goal goal, WallTime::duration limit, std::function<void(Outcome)> done) {
  const WallTime now = clock_();
  paused_ = true;
  errand_ = Errand{goal, now, now + limit, std::move(done)};
  run_errand(now);
}

void LiveSimulation::run_errand(WallTime now) {
  errand_->last_turn = now;
  const Goal goal = errand_->goal;
  std::optional<Outcome> outcome = outcome_of(goal);
  while (!outcome) {
    take_step_towards(goal);
    outcome = outcome_of(goal);
    const WallTime wall = clock_();
    if (!outcome && wall >= errand_->give_up) outcome = Outcome::out_of_time;
    if (wall - now >= longest_slice) break;
  }
  if (outcome) end_errand(*outcome);
}

void LiveSimulation::take_step_towards(const Goal& goal) {
  const bool counts_turns = goal.turns != Goal{}.turns;
  const std::size_t waiting = follower_.waiting_requests();
  if (counts_turns && waiting > 0) {
    follower_.take_turn();
    if (follower_.waiting_requests() < waiting) return;
  }
  Microseconds end = std::min(goal.time, follower_.end());
  if (counts_turns) end = std::min(end, module_->next_turn());
  // The firmware is busy, with its EEPROM for one: it is asked again.
  if (waiting > 0) end = std::min(end, module_->now() + one_millisecond);
  follower_.take_step(end);
  if (!counts_turns) follower_.serve_ports();
}

std::optional<LiveSimulation::Outcome> LiveSimulation::outcome_of(const Goal& goal) const {
  if (module_->now() >= std::min(goal.time, follower_.end()) || module_->turns() >= goal.turns) return Outcome::reached;
  if (goal.time == never && module_->next_turn() == never && follower_.waiting_requests() == 0)
    return Outcome::nothing_to_do;
  return std::nullopt;
}

void LiveSimulation::end_errand(Outcome outcome) {
  if (!errand_) return;
  const std::function<void(Outcome)> done = std::move(errand_->done);
  errand_.reset();
  done(outcome);
}

}  // namespace opentmcl::server
