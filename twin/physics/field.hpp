// What the driver makes the coils of a motor carry.
#pragma once

#include <span>

#include "twin/physics/tick.hpp"

namespace opentmcl::twin {

/// What the driver makes the coils carry from a tick on, until it is told otherwise.
///
/// Currents are amplitude * cos(angle) in coil A and amplitude * sin(angle) in coil B, so a rotor without load stands
/// at the field's angle.
struct Field {
  double angle = 0;         ///< electrical turns (four full steps each) when the span begins; counts on over turns
  double velocity = 0;      ///< electrical turns per second when the span begins
  double acceleration = 0;  ///< electrical turns per second²
  double amplitude = 0;     ///< A, peak of the sine both coils carry
  bool energised = false;   ///< false: bridges off, both coils open
  bool coil_a_connected = true;
  bool coil_b_connected = true;

  /// Coarse microsteps: the field stands at `angle` until the first of these, then at theirs (velocity and acceleration
  /// are 0 then). In order of time, within the span.
  struct Step {
    Tick tick;
    double angle;
  };
  std::span<const Step> steps{};

  /// Angle and velocity `seconds` after the span began, without steps.
  double angle_after(double seconds) const { return angle + seconds * (velocity + 0.5 * acceleration * seconds); }
  double velocity_after(double seconds) const { return velocity + acceleration * seconds; }
  bool stands() const { return velocity == 0 && acceleration == 0 && steps.empty(); }
};

}  // namespace opentmcl::twin
