// The unit of simulated time.
#pragma once

#include <cstdint>
#include <limits>

namespace opentmcl::twin {

/// One tick is one clock of the TMC429, 62.5 ns.
using Tick = std::uint64_t;

inline constexpr Tick ticks_per_microsecond = 16;
inline constexpr Tick ticks_per_millisecond = 1000 * ticks_per_microsecond;
inline constexpr double seconds_per_tick = 62.5e-9;

/// No tick at all: what is not going to happen.
inline constexpr Tick never_tick = std::numeric_limits<Tick>::max();
constexpr double seconds_of(Tick ticks) {
  return static_cast<double>(ticks) * seconds_per_tick;
}

}  // namespace opentmcl::twin
