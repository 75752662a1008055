#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "boards/twin/simulated.hpp"
#include "server/pace.hpp"
#include "server/request_queue.hpp"

namespace opentmcl::server {

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
      : simulated_(simulated), requests_(std::move(requests)), options_(options), clock_(clock), pace_(options.speed) {}

  /// Simulated time and the duration begin now, or began `ago`: of many each at another moment, so that they are not
  /// due all at once.
  void start(std::chrono::microseconds ago = {});

  /// A port has new requests: comes to the present and answers. @param now the wall clock's time
  void serve(WallTime now);
  /// Comes to the present, as far as one slice gets, and answers. @param now the wall clock's time
  void advance(WallTime now);

  /// When advance() is next needed; WallTime::max() when only a request can change anything.
  WallTime next_turn() const;
  bool is_finished() const { return simulated_.now() >= end_; }

 private:
  bool has_nothing_to_simulate() const;
  std::size_t waiting_requests() const;
  void take_turn();
  void serve_ports();

  Simulated& simulated_;
  std::vector<const RequestQueue*> requests_;
  Options options_;
  const WallClock& clock_;
  Pace pace_;
  Microseconds end_ = never;
  WallTime last_turn_{};
};

}  // namespace opentmcl::server
