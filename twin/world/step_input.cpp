#include "twin/world/step_input.hpp"

#include <cmath>

namespace opentmcl::twin {

void StepInput::set_rate(double rate, Tick now) {
  rate_ = rate;
  begun_ = now;
  pulses_ = 0;
  next_ = rate == 0 ? never_tick : tick_of(1);
}

void StepInput::take() {
  ++pulses_;
  next_ = tick_of(pulses_ + 1);
}

double StepInput::part_of_step(Tick now) const {
  if (rate_ == 0) return 0;
  const double periods = static_cast<double>(now - begun_) * seconds_per_tick * std::fabs(rate_);
  const double part = periods - static_cast<double>(pulses_);
  return rate_ < 0 ? -part : part;
}

/// Counted from the begin, so that rounding to ticks does not add up.
Tick StepInput::tick_of(std::uint64_t pulse) const {
  const double seconds = (static_cast<double>(pulse) - 0.5) / std::fabs(rate_);
  return begun_ + static_cast<Tick>(std::floor(seconds / seconds_per_tick + 0.5));
}

}  // namespace opentmcl::twin
