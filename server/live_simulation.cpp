#include "server/live_simulation.hpp"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <thread>
#include <utility>

#include "server/wake_up.hpp"

namespace opentmcl::server {

namespace {

/// Simulated time between two looks at the wall clock.
constexpr Microseconds simulation_step = 10 * one_millisecond;

/// A simulation that is slower than its speed asks for goes on from where it is, instead of hurrying after lost time
/// for ever.
constexpr std::chrono::milliseconds greatest_lag{50};

/// Most hosts send the next request as soon as they have the reply. To be woken takes longer than all the rest of an
/// answer, so the event loop is looked at this often, some 50 us, before it sleeps (docs/performance.md).
constexpr int looks_after_a_request = 64;

}  // namespace

LiveSimulation::LiveSimulation(boost::asio::io_context& events, VirtualModule& module,
                               std::vector<const RequestQueue*> requests, Options options, WallClock clock)
    : events_(events),
      module_(&module),
      requests_(std::move(requests)),
      duration_(options.duration),
      clock_(std::move(clock)),
      pace_(options.speed) {}

void LiveSimulation::start() {
  last_turn_ = clock_();
  pace_.anchor(last_turn_, module_->now());
  if (duration_) end_ = module_->now() + *duration_;
}

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

bool LiveSimulation::has_nothing_to_simulate() const {
  return pace_.is_maximum() && end_ == never && module_->next_turn() == never;
}

void LiveSimulation::take_step(Microseconds goal) {
  // Up to the firmware's next turn nothing needs to be looked at.
  const Microseconds step = std::max(module_->now() + simulation_step, module_->next_turn());
  module_->advance_to(std::min({goal, step, std::max(next_look(), module_->now() + 1)}));
  if (next_look() <= module_->now()) watcher_->look();
}

void LiveSimulation::advance(WallTime now) {
  last_turn_ = now;
  if (errand_) return run_errand(now);
  if (paused_) return;
  const Microseconds goal = std::min(pace_.simulated_at(now), end_);
  while (module_->now() < goal && !has_nothing_to_simulate()) {
    take_step(goal);
    if (module_->now() < goal && clock_() - now >= longest_slice) break;
  }
  serve_ports();
  if (module_->now() >= goal || pace_.is_maximum()) return;
  const WallTime after = clock_();
  if (after - pace_.wall_at(module_->now()) > greatest_lag) pace_.anchor(after, module_->now());
}

void LiveSimulation::serve(WallTime now) {
  has_served_ = true;
  if (paused_ && !errand_) return;
  // At maximum speed the present is where the simulation is.
  if (pace_.is_maximum()) {
    serve_ports();
  } else {
    advance(now);
  }
}

// ---- Control of time

void LiveSimulation::pause() {
  paused_ = true;
  end_errand(Outcome::given_up);
}

void LiveSimulation::resume() {
  end_errand(Outcome::given_up);
  paused_ = false;
  last_turn_ = clock_();
  pace_.anchor(last_turn_, module_->now());
}

void LiveSimulation::set_speed(double speed) {
  pace_ = Pace(speed);
  pace_.anchor(clock_(), module_->now());
}

void LiveSimulation::carry(VirtualModule& module) {
  end_errand(Outcome::given_up);
  module_ = &module;
  pace_.anchor(clock_(), module_->now());
}

void LiveSimulation::run_to(Goal goal, WallTime::duration limit, std::function<void(Outcome)> done) {
  last_turn_ = clock_();
  paused_ = true;
  errand_ = Errand{goal, last_turn_ + limit, std::move(done)};
  run_errand(last_turn_);
}

void LiveSimulation::run_errand(WallTime now) {
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
  const std::size_t waiting = waiting_requests();
  if (counts_turns && waiting > 0) {
    take_turn();
    if (waiting_requests() < waiting) return;
  }
  Microseconds end = std::min(goal.time, end_);
  if (counts_turns) end = std::min(end, module_->next_turn());
  // The firmware is busy, with its EEPROM for one: it is asked again.
  if (waiting > 0) end = std::min(end, module_->now() + one_millisecond);
  take_step(end);
  if (!counts_turns) serve_ports();
}

std::optional<LiveSimulation::Outcome> LiveSimulation::outcome_of(const Goal& goal) const {
  if (module_->now() >= std::min(goal.time, end_) || module_->turns() >= goal.turns) return Outcome::reached;
  if (goal.time == never && module_->next_turn() == never && waiting_requests() == 0) return Outcome::nothing_to_do;
  return std::nullopt;
}

void LiveSimulation::end_errand(Outcome outcome) {
  if (!errand_) return;
  const std::function<void(Outcome)> done = std::move(errand_->done);
  errand_.reset();
  done(outcome);
}

std::size_t LiveSimulation::waiting_requests() const {
  std::size_t count = 0;
  for (const RequestQueue* queue : requests_) count += queue->size();
  return count;
}

void LiveSimulation::take_turn() {
  module_->wake();
  module_->advance_to(module_->now());
}

void LiveSimulation::serve_ports() {
  // A turn that takes no request may still prepare for the next one, as the first after power-on does.
  constexpr int most_vain_turns = 2;
  int vain_turns = 0;
  std::size_t before = waiting_requests();
  if (before == 0) return;
  while (before > 0 && vain_turns < most_vain_turns) {
    take_turn();
    const std::size_t left = waiting_requests();
    vain_turns = left == before ? vain_turns + 1 : 0;
    before = left;
  }
  // After a request the firmware wants another turn, in case there are more. Given at once, that turn tells when it
  // really needs one, and a module that only waits for commands needs no timer.
  if (before == 0) take_turn();
}

WallTime LiveSimulation::next_turn() const {
  if (errand_) return last_turn_;
  if (paused_) return WallTime::max();
  // The firmware is busy, with its EEPROM for one: it is asked again.
  if (waiting_requests() > 0) return last_turn_ + shortest_turn;
  if (has_nothing_to_simulate()) return WallTime::max();
  const WallTime next = pace_.wall_at(std::min({module_->next_turn(), end_, next_look()}));
  if (pace_.is_maximum() || next == WallTime::max()) return next;
  return std::max(next, last_turn_ + shortest_turn);
}

}  // namespace opentmcl::server
