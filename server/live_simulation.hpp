#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "server/pace.hpp"
#include "server/request_queue.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// Runs a virtual module for hosts that live in real time: in one thread, asleep while nothing is to be done.
///
/// At a finite speed the module follows the wall clock in turns at least `shortest_turn` apart; a request is answered
/// at once, at the simulated time that has come. At maximum speed the module runs flat out, but not while it only waits
/// for commands: then time stands still until one comes (or, with a duration, jumps to the end).
class LiveSimulation {
 public:
  struct Options {
    double speed = 1;  ///< more than 0, or Pace::maximum
    /// Simulated time after which run() returns, from its call on.
    std::optional<Microseconds> duration = {};
  };

  static constexpr std::chrono::milliseconds shortest_turn{1};
  /// The event loop is looked at this often however much there is to simulate. Well below the 5 ms of silence that
  /// divide requests.
  static constexpr std::chrono::milliseconds longest_slice{2};

  /// @param requests those of each port of the module; everything must outlive this
  LiveSimulation(boost::asio::io_context& events, VirtualModule& module, std::vector<const RequestQueue*> requests,
                 Options options, WallClock clock = std::chrono::steady_clock::now);

  /// Handles events and lets time pass until stop() or the end of the duration.
  void run();
  /// From within an event handler: run() returns after this turn.
  void stop() { stopped_ = true; }

  /// Called after each turn of the loop in which simulated time or requests may have changed the module.
  void after_turn(std::function<void()> callback) { after_turn_ = std::move(callback); }

  // ---- The parts of run(), for callers with an event loop of their own

  /// Simulated time and the duration begin now.
  void start();
  /// A port has new requests: brings the module up to the present and lets it answer.
  /// @param now the wall clock's time
  void serve(WallTime now);
  /// Brings the module up to the present, as far as one slice gets, and lets it answer.
  /// @param now the wall clock's time
  void advance(WallTime now);
  bool is_finished() const { return module_.now() >= end_; }
  /// When advance() is next needed; WallTime::max() when only an event can change anything.
  WallTime next_turn() const;

 private:
  /// Handles an event that comes shortly after a request. @return whether one came
  bool handles_event_soon();
  bool has_nothing_to_simulate() const;
  std::size_t waiting_requests() const;
  void take_turn();
  void serve_ports();

  boost::asio::io_context& events_;
  VirtualModule& module_;
  std::vector<const RequestQueue*> requests_;
  Options options_;
  WallClock clock_;
  Pace pace_;
  std::function<void()> after_turn_;
  Microseconds end_ = never;
  WallTime last_turn_{};
  bool has_served_ = false;  // since the event loop last slept
  bool stopped_ = false;
};

}  // namespace opentmcl::server
