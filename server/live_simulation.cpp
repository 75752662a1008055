#include "server/live_simulation.hpp"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <utility>

namespace opentmcl::server {

namespace {

/// Simulated time between two looks at the wall clock.
constexpr Microseconds simulation_step = 10 * one_millisecond;

/// A simulation that is slower than its speed asks for goes on from where it is, instead of hurrying after lost time
/// for ever.
constexpr std::chrono::milliseconds greatest_lag{50};

}  // namespace

LiveSimulation::LiveSimulation(boost::asio::io_context& events, VirtualModule& module, std::vector<RequestPort*> ports,
                               Options options, WallClock clock)
    : events_(events),
      module_(module),
      ports_(std::move(ports)),
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
  start();
  while (true) {
    advance();
    if (after_turn_) after_turn_();
    if (stopped_ || is_finished()) return;
    const WallTime next = next_turn();
    if (next == WallTime::max()) {
      events_.run_one();
    } else if (next > clock_()) {
      events_.run_one_until(next);
    }
    events_.poll();
  }
}

bool LiveSimulation::has_nothing_to_simulate() const {
  return pace_.is_maximum() && end_ == never && module_.next_turn() == never;
}

void LiveSimulation::advance() {
  const WallTime begin = clock_();
  last_turn_ = begin;
  const Microseconds goal = std::min(pace_.simulated_at(begin), end_);
  while (module_.now() < goal && !has_nothing_to_simulate()) {
    // Up to the firmware's next turn nothing needs to be looked at.
    const Microseconds step = std::max(module_.now() + simulation_step, module_.next_turn());
    module_.advance_to(std::min(goal, step));
    if (clock_() - begin >= longest_slice) break;
  }
  serve_ports();
  if (!pace_.is_maximum() && clock_() - pace_.wall_at(module_.now()) > greatest_lag) {
    pace_.anchor(clock_(), module_.now());
  }
}

void LiveSimulation::serve() {
  // At maximum speed the present is where the simulation is.
  if (pace_.is_maximum()) {
    serve_ports();
  } else {
    advance();
  }
}

std::size_t LiveSimulation::waiting_requests() const {
  std::size_t count = 0;
  for (const RequestPort* port : ports_) count += port->size();
  return count;
}

void LiveSimulation::serve_ports() {
  // A turn that takes no request may still prepare for the next one, as the first after power-on does.
  constexpr int most_vain_turns = 2;
  int vain_turns = 0;
  for (std::size_t before = waiting_requests(); before > 0 && vain_turns < most_vain_turns;) {
    module_.wake();
    module_.advance_to(module_.now());
    const std::size_t left = waiting_requests();
    vain_turns = left == before ? vain_turns + 1 : 0;
    before = left;
  }
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
