#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "server/follower.hpp"
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

  // ---- Control of time, from within an event handler too

  /// Time stands still and requests wait until resume().
  void pause();
  bool is_paused() const { return paused_; }
  /// Goes on at speed().
  void resume();
  /// @param speed more than 0, or Pace::maximum
  void set_speed(double speed) { follower_.set_speed(speed); }
  double speed() const { return follower_.speed(); }

  /// Where a run flat out ends.
  struct Goal {
    Microseconds time = never;
    std::uint64_t turns = std::uint64_t(-1);  ///< VirtualModule::turns()
  };
  enum class Outcome : std::uint8_t {
    reached,
    nothing_to_do,  ///< the firmware takes no more turns by itself
    out_of_time,    ///< on the wall clock
    given_up,       ///< by pause(), resume() or carry()
  };
  /// Runs flat out, whatever the speed, until one part of `goal` is reached, and is paused from then on; answers
  /// requests on the way. `done` is called at the end, at once if that is now.
  /// @param limit on the wall clock @pre !is_running_to_goal()
  void run_to(Goal goal, WallTime::duration limit, std::function<void(Outcome)> done);
  bool is_running_to_goal() const { return errand_.has_value(); }

  /// From now on this module is run, from where it is. It must outlive this.
  void carry(VirtualModule& module);

  /// nullptr: nobody looks; else it must outlive this.
  void set_watcher(Watcher* watcher) { follower_.set_watcher(watcher); }

  /// Called after each turn of the loop in which simulated time or requests may have changed the module.
  void after_turn(std::function<void()> callback) { after_turn_ = std::move(callback); }

  // ---- The parts of run(), for callers with an event loop of their own

  /// Simulated time and the duration begin now.
  void start() { follower_.start(); }
  /// A port has new requests: brings the module up to the present and lets it answer.
  /// @param now the wall clock's time
  void serve(WallTime now);
  /// Brings the module up to the present, as far as one slice gets, and lets it answer.
  /// @param now the wall clock's time
  void advance(WallTime now);
  bool is_finished() const { return follower_.is_finished(); }
  /// When advance() is next needed; WallTime::max() when only an event can change anything.
  WallTime next_turn() const;

 private:
  struct Errand {
    Goal goal;
    WallTime last_turn;
    WallTime give_up;
    std::function<void(Outcome)> done;
  };

  /// Handles an event that comes shortly after a request. @return whether one came
  bool handles_event_soon();
  void run_errand(WallTime now);
  void take_step_towards(const Goal& goal);
  std::optional<Outcome> outcome_of(const Goal& goal) const;
  void end_errand(Outcome outcome);

  boost::asio::io_context& events_;
  VirtualModule* module_;
  WallClock clock_;
  Follower follower_;
  std::optional<Errand> errand_;
  bool paused_ = false;
  std::function<void()> after_turn_;
  bool has_served_ = false;  // since the event loop last slept
  bool stopped_ = false;
};

}  // namespace opentmcl::server
