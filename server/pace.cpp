#include "server/pace.hpp"

#include <cmath>

namespace opentmcl::server {

namespace {

using WallMicroseconds = std::chrono::duration<double, std::micro>;

/// Farther away than anybody waits, and still a valid time point: 30 years in ns.
constexpr double longest_wait = 1e18;

}  // namespace

void Pace::anchor(WallTime wall, Microseconds simulated) {
  wall_ = wall;
  simulated_ = simulated;
}

Microseconds Pace::simulated_at(WallTime wall) const {
  if (is_maximum()) return never;
  const double passed = WallMicroseconds(wall - wall_).count() * speed_;
  return simulated_ + static_cast<Microseconds>(passed);
}

WallTime Pace::wall_at(Microseconds simulated) const {
  if (simulated == never) return WallTime::max();
  if (is_maximum() || simulated <= simulated_) return wall_;
  // Rounded up, in whole nanoseconds: at that wall time simulated_at() is really there.
  const double wait = std::ceil(static_cast<double>(simulated - simulated_) / speed_ * 1000) + 1;
  if (wait > longest_wait) return WallTime::max();
  return wall_ + std::chrono::nanoseconds(std::llround(wait));
}

}  // namespace opentmcl::server
