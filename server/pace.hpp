#pragma once

#include <chrono>
#include <functional>

#include "firmware/hal/time.hpp"

namespace opentmcl::server {

using WallTime = std::chrono::steady_clock::time_point;
/// Where real time comes from; a test moves its own.
using WallClock = std::function<WallTime()>;
/// Told that a port has new requests, and what the wall clock said when they came.
using RequestsArrived = std::function<void(WallTime)>;

/// How simulated time follows the clock on the wall: `speed` times as fast, from a common anchor on.
class Pace {
 public:
  /// As fast as the computer can.
  static constexpr double maximum = 0;

  /// @param speed more than 0, or `maximum`
  explicit Pace(double speed) : speed_(speed) {}

  double speed() const { return speed_; }
  bool is_maximum() const { return speed_ == maximum; }

  /// From now on both times run from here.
  void anchor(WallTime wall, Microseconds simulated);

  /// Where the simulation should be; `never` (as far as it gets) at maximum speed. @pre wall is not before the anchor
  Microseconds simulated_at(WallTime wall) const;

  /// When the simulation should get there: the anchor at maximum speed, WallTime::max() for `never`.
  WallTime wall_at(Microseconds simulated) const;

 private:
  double speed_;
  WallTime wall_{};
  Microseconds simulated_ = 0;
};

}  // namespace opentmcl::server
