// How a rotor swings about the place where it would stand, in closed form.
#pragma once

namespace opentmcl::twin {

/// Deviation from the equilibrium and its rate; any unit, here electrical radians and seconds.
struct Swing {
  double deviation = 0;
  double rate = 0;
};

/// x'' + 2 b x' + w_n² x = 0, damped less than critically.
class DampedOscillator {
 public:
  /// @param decay              b, 1/s
  /// @param natural_frequency  w_n, rad/s; above b
  DampedOscillator(double decay, double natural_frequency);

  Swing after(const Swing& swing, double seconds) const;

  /// Largest deviation that would be reached without damping, from here on.
  double amplitude(const Swing& swing) const;

  /// Seconds until the rate is 0 next; a half period when it is 0 now.
  double time_to_turn(const Swing& swing) const;

 private:
  double decay_;
  double natural_square_;
  double frequency_;  ///< w_d = sqrt(w_n² - b²), rad/s
};

}  // namespace opentmcl::twin
