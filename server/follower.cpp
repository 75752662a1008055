#include "server/follower.hpp"

#include <algorithm>

namespace opentmcl::server {

namespace {

/// Simulated time between two looks at the wall clock.
constexpr Microseconds simulation_step = 10 * one_millisecond;

/// What is slower than its speed asks for goes on from where it is, instead of hurrying after lost time for ever.
constexpr std::chrono::milliseconds greatest_lag{50};

}  // namespace

void Follower::start(std::chrono::microseconds ago) {
  last_turn_ = clock_() - ago;
  pace_.anchor(last_turn_, simulated_->now());
  if (options_.duration) end_ = simulated_->now() + *options_.duration;
}

void Follower::follow_from_here() {
  last_turn_ = clock_();
  pace_.anchor(last_turn_, simulated_->now());
}

void Follower::set_speed(double speed) {
  pace_ = Pace(speed);
  pace_.anchor(clock_(), simulated_->now());
}

void Follower::carry(Simulated& simulated) {
  simulated_ = &simulated;
  pace_.anchor(clock_(), simulated_->now());
}

bool Follower::has_nothing_to_simulate() const {
  return pace_.is_maximum() && end_ == never && simulated_->next_turn() == never;
}

void Follower::take_step(Microseconds goal) {
  // Up to its next turn nothing needs to be looked at.
  const Microseconds step = std::max(simulated_->now() + simulation_step, simulated_->next_turn());
  simulated_->advance_to(std::min({goal, step, std::max(next_look(), simulated_->now() + 1)}));
  if (next_look() <= simulated_->now()) watcher_->look();
}

void Follower::advance(WallTime now) {
  last_turn_ = now;
  const Microseconds goal = std::min(pace_.simulated_at(now), end_);
  while (simulated_->now() < goal && !has_nothing_to_simulate()) {
    take_step(goal);
    if (simulated_->now() < goal && clock_() - now >= options_.slice) break;
  }
  serve_ports();
  if (simulated_->now() >= goal || pace_.is_maximum()) return;
  const WallTime after = clock_();
  if (after - pace_.wall_at(simulated_->now()) > greatest_lag) pace_.anchor(after, simulated_->now());
}

void Follower::serve(WallTime now) {
  // At maximum speed the present is where the simulation is.
  if (pace_.is_maximum()) {
    serve_ports();
  } else {
    advance(now);
  }
}

std::size_t Follower::waiting_requests() const {
  std::size_t count = 0;
  for (const RequestQueue* queue : requests_) count += queue->size();
  return count;
}

void Follower::take_turn() {
  simulated_->wake();
  simulated_->advance_to(simulated_->now());
}

void Follower::serve_ports() {
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

WallTime Follower::next_turn() const {
  // The firmware is busy, with its EEPROM for one: it is asked again.
  if (waiting_requests() > 0) return last_turn_ + options_.turn;
  if (has_nothing_to_simulate()) return WallTime::max();
  const WallTime next = pace_.wall_at(std::min({simulated_->next_turn(), end_, next_look()}));
  if (pace_.is_maximum() || next == WallTime::max()) return next;
  return std::max(next, last_turn_ + options_.turn);
}

}  // namespace opentmcl::server
