// A velocity that every ramp tick changes by the same amount, and the steps it gives, without iterating over ticks.
#pragma once

#include <cstdint>

namespace opentmcl::twin {

/// A stretch of whole ramp periods: a ramp tick on the tick after `begin`, and on all but the first tick of a period
/// the velocity that this ramp tick gave.
struct Tmc429VelocityLine {
  std::uint64_t begin;        ///< the tick before a ramp tick
  std::uint32_t accumulator;  ///< then
  std::int32_t velocity;      ///< then, 1/256 of the unit of V_ACTUAL; never negative, at `begin` or later
  std::int32_t change;        ///< of the velocity, on each ramp tick
  unsigned pulse_divider;
  unsigned ramp_divider;

  /// The last tick of so many periods.
  std::uint64_t end_of(std::uint64_t periods) const { return begin + (periods << ramp_divider); }
  std::int32_t velocity_after(std::uint64_t periods) const;
  /// The accumulator after so many periods, had it never overflowed: 2048 for each step.
  std::uint64_t phase_after(std::uint64_t periods) const;
  std::uint64_t steps_after(std::uint64_t periods) const;
  /// When step `number` (1 is the first) is given, which must be within `periods`.
  std::uint64_t tick_of_step(std::uint64_t number, std::uint64_t periods) const;
};

}  // namespace opentmcl::twin
