// A motor that turns evenly, averaged over an electrical turn: its torque over the load angle, and how it swings.
#pragma once

#include "twin/physics/elementary.hpp"
#include "twin/physics/motor_data.hpp"

namespace opentmcl::twin {

/// What the mean torque depends on, apart from speed and load angle.
struct ElectricalConditions {
  double torque_constant;  ///< N m / A = V s/rad
  double inductance;       ///< H
  double resistance;       ///< ohm
  double supply;           ///< V
  double amplitude;        ///< A, peak
};

/// Currents and voltages are phasors in the frame that turns with the rotor, whose magnet lies along the axis.
class AveragedMotor {
 public:
  /// @param speed electrical radians per second, not negative
  AveragedMotor(const ElectricalConditions& conditions, double speed);

  struct OperatingPoint {
    Phasor current;     ///< A
    double torque;      ///< N m
    double modulation;  ///< what the regulator asks for over the supply; above 1 it does not get it
  };

  /// The point that an even motion has at a load angle, radians by which the field leads the rotor.
  OperatingPoint at(double load_angle) const;

  /// How torque answers to small swings about a point. The currents' part of the 4-state model (current along and
  /// across, speed w, load angle d), as transfer functions
  ///     dT/dw = (w1 s + w0) / (s² + e1 s + e0),   dT/dd = (d1 s + d0) / (s² + e1 s + e0),
  /// w in mechanical radians per second.
  struct Response {
    double e1, e0;
    double w1, w0;
    double d1, d0;
  };
  Response response(const OperatingPoint& point, double load_angle) const;

 private:
  Phasor regulator_voltage(Phasor current, Phasor wanted, Phasor emf, double field_speed) const;

  ElectricalConditions conditions_;
  double speed_;
};

/// Whether every swing about a point dies down faster than exp(-decay * t), by the criterion of Routh and Hurwitz.
/// @param inertia  kg m², of rotor and load
/// @param drag     N m s, all torque proportional to speed
bool swings_die_down(const AveragedMotor::Response& response, double inertia, double drag, double decay);

}  // namespace opentmcl::twin
