// What a data sheet says about a stepper motor, and what it leaves out.
#pragma once

#include <numbers>
#include <span>
#include <string_view>

namespace opentmcl::twin {

/// Two-phase hybrid stepper of 200 full steps a turn. Rows come from twin/motors/motors.toml, which says what is
/// measured, what is stated by whom and what is assumed; twin/motors/motor_table.py has the ranges.
struct MotorData {
  std::string_view name;
  std::string_view source;

  double rated_current;                      ///< A rms, in each of two coils of a moving motor
  double winding_resistance;                 ///< ohm, of one coil at 20 °C
  double winding_inductance;                 ///< H, of one coil
  double holding_torque;                     ///< N m, at the rated current
  double detent_torque;                      ///< N m, amplitude; four periods an electrical turn
  double rotor_inertia;                      ///< kg m²
  double viscous_friction;                   ///< N m s
  double coulomb_friction;                   ///< N m
  double eddy_damping;                       ///< N m s, against the speed of the rotor relative to the field
  double winding_time_constant;              ///< s, of the winding's temperature
  double temperature_rise_at_rated_current;  ///< K above ambient
  double stall_guard_gain;  ///< stallGuard2 value of an unloaded motor, as a share of 1023, over back-EMF / supply

  /// Rotor teeth: electrical turns a turn of the shaft. One electrical turn is four full steps.
  static constexpr double pole_pairs = 50;
  /// Of the shaft, in an electrical turn.
  static constexpr double shaft_radians_per_turn = 2 * std::numbers::pi / pole_pairs;

  /// Torque per ampere of the current that is at right angles to the rotor, N m / A of the sine's peak; and back-EMF
  /// per speed of the shaft, V s/rad of the sine's peak: the same number (QSH5718 manual V2.6, chapter 4).
  double torque_constant() const { return holding_torque / rated_amplitude(); }

  /// A, peak of the sine whose rms value is the rated current.
  double rated_amplitude() const { return std::numbers::sqrt2 * rated_current; }

  friend bool operator==(const MotorData&, const MotorData&) = default;
};

/// All motors of twin/motors/motors.toml, the default motor of both modules first.
std::span<const MotorData> motors();

/// The motor of that name, or nullptr.
const MotorData* find_motor(std::string_view name);

}  // namespace opentmcl::twin
