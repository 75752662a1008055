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
      module_(module),
      requests_(std::move(requests)),
      options_(options),
      clock_(std::move(clock)),
      pace_(options.speed) {}

void LiveSimulation::start() {
  last_turn_ = clock_();
  pace_.anchor(last_turn_, module_.now());
  if (options_.duration) end_ = module_.now() + *options_.duration;
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
  return pace_.is_maximum() && end_ == never && module_.next_turn() == never;
}

void LiveSimulation::advance(WallTime now) {
  last_turn_ = now;
  const Microseconds goal = std::min(pace_.simulated_at(now), end_);
  while (module_.now() < goal && !has_nothing_to_simulate()) {
    // Up to the firmware's next turn nothing needs to be looked at.
    const Microseconds step = std::max(module_.now() + simulation_step, module_.next_turn());
    module_.advance_to(std::min(goal, step));
    if (module_.now() < goal && clock_() - now >= longest_slice) break;
  }
  serve_ports();
  if (module_.now() >= goal || pace_.is_maximum()) return;
  const WallTime after = clock_();
  if (after - pace_.wall_at(module_.now()) > greatest_lag) pace_.anchor(after, module_.now());
}

void LiveSimulation::serve(WallTime now) {
  has_served_ = true;
  // At maximum speed the present is where the simulation is.
  if (pace_.is_maximum()) {
    serve_ports();
  } else {
    advance(now);
  }
}

std::size_t LiveSimulation::waiting_requests() const {
  std::size_t count = 0;
  for (const RequestQueue* queue : requests_) count += queue->size();
  return count;
}

void LiveSimulation::take_turn() {
  module_.wake();
  module_.advance_to(module_.now());
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
  // The firmware is busy, with its EEPROM for one: it is asked again.
  if (waiting_requests() > 0) return last_turn_ + shortest_turn;
  if (has_nothing_to_simulate()) return WallTime::max();
  const WallTime next = pace_.wall_at(std::min(module_.next_turn(), end_));
  if (pace_.is_maximum() || next == WallTime::max()) return next;
  return std::max(next, last_turn_ + shortest_turn);
}

}  // namespace opentmcl::server
