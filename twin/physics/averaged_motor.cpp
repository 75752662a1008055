#include "twin/physics/averaged_motor.hpp"

#include <cmath>

#include "twin/physics/phase_integrator.hpp"

namespace opentmcl::twin {
namespace {

/// Describing function of a limiter: the fundamental of a sine of amplitude `modulation` that is cut off at 1, over
/// that sine. N(x) = 2/pi (asin(1/x) + sqrt(1 - 1/x²) / x) above 1.
double limiter_gain(double modulation) {
  if (modulation <= 1) return 1;
  const double level = 1 / modulation;
  const double rest = std::sqrt(1 - level * level);
  const double arc_sine = angle_in_turns({rest, level}) * radians_per_turn;
  return 2 / std::numbers::pi * (arc_sine + level * rest);
}

}  // namespace

AveragedMotor::AveragedMotor(const ElectricalConditions& conditions, double speed)
    : conditions_(conditions), speed_(speed) {}

/// U = (I* - I) L/tau + R I + E + j w_field L I*
Phasor AveragedMotor::regulator_voltage(Phasor current, Phasor wanted, Phasor emf, double field_speed) const {
  const Phasor feed_forward{0, field_speed * conditions_.inductance};
  return conditions_.inductance / regulator_time_constant * (wanted - current) + conditions_.resistance * current +
         emf + feed_forward * wanted;
}

AveragedMotor::OperatingPoint AveragedMotor::at(double load_angle) const {
  const double torque_constant = conditions_.torque_constant;
  const double inductance = conditions_.inductance;
  const double resistance = conditions_.resistance;
  const Phasor wanted = conditions_.amplitude * unit_phasor(load_angle / radians_per_turn);
  const Phasor emf{0, torque_constant * speed_ / MotorData::pole_pairs};
  const double reactance = speed_ * inductance;
  const double regulator_gain = inductance / regulator_time_constant;

  // With V = N U: I = (N (L/tau + j w L) I* - (1 - N) E) / (R + j w L + N (L/tau - R))
  const auto current_at = [&](double gain) {
    const Phasor drive = gain * (Phasor{regulator_gain, reactance} * wanted);
    return (drive - (1 - gain) * emf) / Phasor{resistance + gain * (regulator_gain - resistance), reactance};
  };
  const auto modulation_at = [&](Phasor current) {
    return regulator_voltage(current, wanted, emf, speed_).magnitude() / conditions_.supply;
  };

  Phasor current = current_at(1);
  double modulation = modulation_at(current);
  if (modulation > 1) {
    // Too small a gain asks for too little: N(|U(gain)| / Vs) - gain falls from above 0 to below 0. Regula falsi with
    // the Illinois rule: a bound that stays twice counts half.
    double lowest = 1e-6;
    double highest = 1;
    double above = limiter_gain(modulation_at(current_at(lowest))) - lowest;
    double below = limiter_gain(modulation) - highest;
    int kept = 0;
    for (int round = 0; round < 60 && highest - lowest > 1e-12; ++round) {
      const double gain = (lowest * below - highest * above) / (below - above);
      current = current_at(gain);
      modulation = modulation_at(current);
      const double excess = limiter_gain(modulation) - gain;
      if (std::fabs(excess) < 1e-12) break;
      if (excess > 0) {
        lowest = gain;
        above = excess;
        if (kept == 1) below /= 2;
        kept = 1;
      } else {
        highest = gain;
        below = excess;
        if (kept == -1) above /= 2;
        kept = -1;
      }
    }
  }
  return {current, torque_constant * current.across, modulation};
}

AveragedMotor::Response AveragedMotor::response(const OperatingPoint& point, double load_angle) const {
  const double torque_constant = conditions_.torque_constant;
  const double inductance = conditions_.inductance;
  // L dI/dt = V - R I - j w L I - E in the rotor's frame, the field turning on at its speed.
  const auto current_rate = [&](Phasor current, double speed, double angle) {
    const Phasor wanted = conditions_.amplitude * unit_phasor(angle / radians_per_turn);
    const Phasor emf{0, torque_constant * speed / MotorData::pole_pairs};
    const Phasor asked = regulator_voltage(current, wanted, emf, speed_);
    const Phasor voltage = limiter_gain(asked.magnitude() / conditions_.supply) * asked;
    const Phasor reactance{0, speed * inductance};
    return 1 / inductance * (voltage - conditions_.resistance * current - reactance * current - emf);
  };
  // Central differences about the point.
  const auto difference = [&](Phasor current_step, double speed_step, double angle_step, double width) {
    const Phasor ahead = current_rate(point.current + current_step, speed_ + speed_step, load_angle + angle_step);
    const Phasor behind = current_rate(point.current - current_step, speed_ - speed_step, load_angle - angle_step);
    return 1 / (2 * width) * (ahead - behind);
  };
  constexpr double ampere = 1e-4;
  constexpr double radian = 1e-4;
  constexpr double radian_per_second = 1e-3;
  const Phasor by_along = difference({ampere, 0}, 0, 0, ampere);
  const Phasor by_across = difference({0, ampere}, 0, 0, ampere);
  const Phasor by_speed =
      MotorData::pole_pairs * difference({0, 0}, radian_per_second, 0, radian_per_second);  // of the shaft
  const Phasor by_angle = difference({0, 0}, 0, radian, radian);

  // dT = Km dI_across; the row of (s - A)^-1 that gives I_across is (a21, s - a11) / (s² - trace s + determinant).
  Response result{};
  result.e1 = -(by_along.along + by_across.across);
  result.e0 = by_along.along * by_across.across - by_across.along * by_along.across;
  const auto torque_by = [&](Phasor input, double& first, double& zeroth) {
    first = torque_constant * input.across;
    zeroth = torque_constant * (by_along.across * input.along - by_along.along * input.across);
  };
  torque_by(by_speed, result.w1, result.w0);
  torque_by(by_angle, result.d1, result.d0);
  return result;
}

bool swings_die_down(const AveragedMotor::Response& response, double inertia, double drag, double decay) {
  const auto& [e1, e0, w1, w0, d1, d0] = response;
  // J dw/dt = T - D w and dd/dt = -Nr w give
  //     s (s + D/J) (s² + e1 s + e0) - s (w1 s + w0) / J + Nr (d1 s + d0) / J = 0.
  const double damping = drag / inertia;
  double c3 = e1 + damping;
  double c2 = e0 + damping * e1 - w1 / inertia;
  double c1 = damping * e0 + (MotorData::pole_pairs * d1 - w0) / inertia;
  double c0 = MotorData::pole_pairs * d0 / inertia;
  // s = z - decay: the roots in z must lie in the left half plane. Taylor's shift by Horner's scheme.
  c3 -= decay;
  c2 -= decay * c3;
  c1 -= decay * c2;
  c0 -= decay * c1;
  c3 -= decay;
  c2 -= decay * c3;
  c1 -= decay * c2;
  c3 -= decay;
  c2 -= decay * c3;
  c3 -= decay;
  return c3 > 0 && c2 > 0 && c1 > 0 && c0 > 0 && c1 * (c3 * c2 - c1) > c3 * c3 * c0;
}

}  // namespace opentmcl::twin
