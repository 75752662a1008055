#pragma once

#include <cstdint>

#include "twin/physics/tick.hpp"

namespace opentmcl::twin {

/// A pulse generator at the STEP and DIR inputs of the step/direction connector. Its pulses come at whole ticks, and on
/// average exactly as often as was asked for.
class StepInput {
 public:
  /// Pulses a second that it can give: more than any motor follows at the finest steps.
  static constexpr double highest_rate = 500'000;

  /// The next pulse comes half a period from now. @param rate pulses a second, -highest_rate to highest_rate; negative:
  /// in the direction of negative steps; 0: none
  void set_rate(double rate, Tick now);
  double rate() const { return rate_; }

  /// When the next pulse comes; never_tick without a rate.
  Tick next() const { return next_; }
  /// That pulse has been given.
  void take();
  /// How far it has come from its last pulse to its next, -1/2 to 1/2, the other way round for a negative rate; 0
  /// without one. A field that moves in steps is, on average, half a step ahead of where it last stepped to.
  double part_of_step(Tick now) const;
  /// Level at DIR.
  bool direction() const { return rate_ < 0; }

 private:
  Tick tick_of(std::uint64_t pulse) const;

  double rate_ = 0;
  Tick begun_ = 0;
  std::uint64_t pulses_ = 0;  ///< given since `begun_`
  Tick next_ = never_tick;
};

}  // namespace opentmcl::twin
