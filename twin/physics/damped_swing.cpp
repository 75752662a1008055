#include "twin/physics/damped_swing.hpp"

#include <cmath>

#include "twin/physics/elementary.hpp"

namespace opentmcl::twin {

DampedOscillator::DampedOscillator(double decay, double natural_frequency)
    : decay_(decay),
      natural_square_(natural_frequency * natural_frequency),
      frequency_(std::sqrt(natural_square_ - decay * decay)) {}

Swing DampedOscillator::after(const Swing& swing, double seconds) const {
  // x(t) = e^(-bt) (A cos w_d t + B sin w_d t), A = x0, B = (x0' + b x0) / w_d
  const double a = swing.deviation;
  const double b = (swing.rate + decay_ * swing.deviation) / frequency_;
  const Phasor turn = unit_phasor(frequency_ * seconds / radians_per_turn);
  const double left = exponential(-decay_ * seconds);
  const double deviation = left * (a * turn.along + b * turn.across);
  return {deviation, left * frequency_ * (b * turn.along - a * turn.across) - decay_ * deviation};
}

double DampedOscillator::amplitude(const Swing& swing) const {
  const double b = (swing.rate + decay_ * swing.deviation) / frequency_;
  return std::sqrt(swing.deviation * swing.deviation + b * b);
}

double DampedOscillator::time_to_turn(const Swing& swing) const {
  if (swing.rate == 0) return std::numbers::pi / frequency_;
  // x'(t) = e^(-bt) (x0' cos w_d t - (b x0' + w_n² x0) / w_d sin w_d t)
  const double across = (decay_ * swing.rate + natural_square_ * swing.deviation) / frequency_;
  const double turn = angle_in_turns({std::copysign(across, across * swing.rate), std::fabs(swing.rate)});
  return turn * radians_per_turn / frequency_;
}

}  // namespace opentmcl::twin
