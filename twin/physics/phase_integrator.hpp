// The whole motor, integrated: two coils on a chopper, a rotor with detent and friction, and what hangs on the shaft.
#pragma once

#include "twin/physics/field.hpp"
#include "twin/physics/load.hpp"
#include "twin/physics/motor_data.hpp"
#include "twin/physics/tick.hpp"

namespace opentmcl::twin {

/// Time in which a current regulator corrects an error when the supply allows it, s: one period of the TMC262's chopper
/// at its usual settings (35 kHz).
inline constexpr double regulator_time_constant = 28e-6;

struct PhaseState {
  double angle = 0;      ///< electrical turns of the rotor
  double velocity = 0;   ///< electrical turns per second
  double current_a = 0;  ///< A
  double current_b = 0;

  friend bool operator==(const PhaseState&, const PhaseState&) = default;
};

/// Motor, load and supply: all that acts but the field.
struct MotorConditions {
  const MotorData* motor;
  const Load* load;
  double supply;      ///< V
  double resistance;  ///< ohm, of a coil at its present temperature
};

/// Classical Runge-Kutta of the fourth order. The grid of steps lies on multiples of `grid` of absolute time, so that a
/// span can be cut at such ticks without another result; the first and the last step of a span may be shorter, and a
/// step of the field ends one.
/// @param end   not before begin
/// @param grid  ticks; 320 (20 µs) agrees with 1 µs to all digits of the load angle, 640 to 0.5 %
PhaseState integrate(const MotorConditions& conditions, const Field& field, const PhaseState& state, Tick begin,
                     Tick end, Tick grid);

/// Torque of the currents on the rotor, N m, without detent.
double field_torque(const MotorData& motor, const PhaseState& state);
/// Torque that pulls the rotor to the next full step, N m.
double detent_torque(const MotorData& motor, double angle);
/// Torque of the load against positive motion but for friction: constant part, spring and ends, N m. A standing shaft.
double load_torque(const MotorConditions& conditions, double angle);

/// Currents that the driver aims at in a field that stands at `angle`; 0 in an open coil.
struct CoilCurrents {
  double a;
  double b;
};
CoilCurrents ideal_currents(const Field& field, double angle);

}  // namespace opentmcl::twin
