#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "boards/twin/simulated.hpp"
#include "server/pace.hpp"
#include "server/request_queue.hpp"

namespace opentmcl::server {

/// Looks at what is simulated at certain times of its own, whatever the speed.
class Watcher {
 public:
  /// `never` when it has nothing to look for.
  virtual Microseconds next_look() const = 0;
  /// That time has come. Must not change anything.
  virtual void look() = 0;

 protected:
  ~Watcher() = default;
};

/// Lets one thing that has simulated time follow the wall clock, and answer requests at once. Somebody else, who may
/// have many of them, decides when each of them has its turn.
class Follower {
 public:
  struct Options {
    double speed = 1;  ///< more than 0, or Pace::maximum
    /// Simulated time after which it is finished.
    std::optional<Microseconds> duration = {};
    /// Between two turns when nothing comes from outside.
    std::chrono::microseconds turn{1000};
    /// What one turn may take on the wall clock, unless 10 ms of simulated time take longer.
    std::chrono::microseconds slice{500};
  };

  /// @param requests those of each port; everything must outlive this
  Follower(Simulated& simulated, std::vector<const RequestQueue*> requests, const Options& options,
           const WallClock& clock)
      : simulated_(&simulated),
        requests_(std::move(requests)),
        options_(options),
        clock_(clock),
        pace_(options.speed) {}

  /// Simulated time and the duration begin now, or began `ago`: of many each at another moment, so that they are not
  /// due all at once.
  void start(std::chrono::microseconds ago = {});

  /// A port has new requests: comes to the present and answers. @param now the wall clock's time
  void serve(WallTime now);
  /// Comes to the present, as far as one slice gets, and answers. @param now the wall clock's time
  void advance(WallTime now);

  /// When advance() is next needed; WallTime::max() when only a request can change anything.
  WallTime next_turn() const;
  bool is_finished() const { return simulated_->now() >= end_; }

  // ---- For who wants more than to follow

  /// Follows from now on from where the simulated time is, whatever was before.
  void follow_from_here();
  /// The same at another speed. @param speed more than 0, or Pace::maximum
  void set_speed(double speed);
  double speed() const { return pace_.speed(); }
  /// The same with another thing; it must outlive this.
  void carry(Simulated& simulated);

  /// nullptr: nobody looks; else it must outlive this.
  void set_watcher(Watcher* watcher) { watcher_ = watcher; }

  /// Simulated time at which it is finished; `never` without a duration.
  Microseconds end() const { return end_; }
  /// Lets simulated time pass, but not beyond `goal` nor beyond one step.
  void take_step(Microseconds goal);
  /// Lets it look at what waits.
  void take_turn();
  /// Lets it answer what waits, as far as it wants to.
  void serve_ports();
  std::size_t waiting_requests() const;

 private:
  bool has_nothing_to_simulate() const;
  Microseconds next_look() const { return watcher_ == nullptr ? never : watcher_->next_look(); }

  Simulated* simulated_;
  std::vector<const RequestQueue*> requests_;
  Options options_;
  const WallClock& clock_;
  Pace pace_;
  Watcher* watcher_ = nullptr;
  Microseconds end_ = never;
  WallTime last_turn_{};
};

}  // namespace opentmcl::server
