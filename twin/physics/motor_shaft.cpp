#include "twin/physics/motor_shaft.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/physics/damped_swing.hpp"
#include "twin/physics/elementary.hpp"

namespace opentmcl::twin {
namespace {

constexpr double shaft_radians = MotorData::shaft_radians_per_turn;

constexpr Tick free_step = 20 * ticks_per_microsecond;
constexpr Tick slipping_step = 40 * ticks_per_microsecond;

/// A free rotor is taken as locked when it has swung little for so long.
constexpr Tick calm_time = 3 * ticks_per_millisecond;
/// A free rotor is taken as slipping when the field has run away from it for so long.
constexpr Tick running_away_time = 20 * ticks_per_millisecond;

}  // namespace

MotorShaft::MotorShaft(const MotorData& motor, std::shared_ptr<TorqueTables> tables)
    : motor_(motor), tables_(std::move(tables)) {}

void MotorShaft::advance_to(Tick end, const Field& field) {
  const double winding_temperature = heated(seconds_of(end - memory_.now), field);
  if (at_rest(field)) {
    rest(field);
  } else if (const std::optional<Arrival> arrival = locked_after(end, field)) {
    arrive(*arrival);
  } else {
    take_over(integrated(end, field), end, field);
  }
  memory_.now = end;
  memory_.amplitude = field.amplitude;
  memory_.winding_temperature = winding_temperature;
}

MotorShaft::State MotorShaft::state_at(Tick tick, const Field& field) const {
  if (tick <= memory_.now) return state();
  if (at_rest(field)) return {memory_.rotor.angle, 0};
  if (const std::optional<Arrival> arrival = locked_after(tick, field)) return arrival->rotor;
  const PhaseState rotor = integrated(tick, field);
  return {rotor.angle, rotor.velocity};
}

void MotorShaft::rest(const Field& field) {
  memory_.rotor.velocity = 0;
  memory_.even = false;
  const CoilCurrents currents = ideal_currents(field, field.angle);
  memory_.rotor.current_a = currents.a;
  memory_.rotor.current_b = currents.b;
  memory_.regime = !always_free_ && can_lock(field) ? Regime::locked : Regime::free;
  memory_.calm = 0;
  memory_.running_away = 0;
  memory_.cruise = {};
  memory_.torque = field_torque(motor_, memory_.rotor);
  memory_.pull_out_torque = pull_out_torque(field.amplitude, 0);
}

void MotorShaft::arrive(const Arrival& arrival) {
  memory_.rotor.angle = arrival.rotor.angle;
  memory_.rotor.velocity = arrival.rotor.velocity;
  memory_.even = arrival.is_even;
  memory_.torque = arrival.torque;
  memory_.pull_out_torque = arrival.pull_out_torque;
  if (!arrival.is_cruise) memory_.cruise = {};
}

bool MotorShaft::at_rest(const Field& field) const {
  if (load_.jammed) return !field.energised || field.stands();
  if (memory_.rotor.velocity != 0 || (field.energised && !field.stands())) return false;
  if (memory_.regime != Regime::locked) {
    // What is left of the currents' own transients.
    constexpr double settled = 1e-3;  // A
    const CoilCurrents ideal = ideal_currents(field, field.angle);
    if (std::fabs(memory_.rotor.current_a - ideal.a) > settled ||
        std::fabs(memory_.rotor.current_b - ideal.b) > settled)
      return false;
  }
  return std::fabs(standing_torque(field, memory_.rotor.angle)) <= friction();
}

Tick MotorShaft::longest_span(const Field& field) const {
  if (at_rest(field)) return 1000 * ticks_per_millisecond;
  if (memory_.regime != Regime::locked || !can_lock(field)) return ticks_per_millisecond;
  if (turns_evenly(field)) return 100 * ticks_per_millisecond;
  return field.acceleration == 0 && load_.spring == 0 ? 10 * ticks_per_millisecond : 2 * ticks_per_millisecond;
}

/// As in the span before, and nothing has changed since.
bool MotorShaft::turns_evenly(const Field& field) const {
  return memory_.even && field.acceleration == 0 && field.velocity == memory_.rotor.velocity &&
         field.amplitude == memory_.amplitude;
}

// ---- Free and slipping

PhaseState MotorShaft::integrated(Tick end, const Field& field) const {
  const PhaseState begin = memory_.regime == Regime::locked ? entering_free(field) : memory_.rotor;
  return integrate(conditions(), field, begin, memory_.now, end, slips() ? slipping_step : free_step);
}

/// @param rotor at `end`, integrated
void MotorShaft::take_over(const PhaseState& rotor, Tick end, const Field& field) {
  const bool slipping = slips();
  memory_.rotor = rotor;
  memory_.even = false;
  memory_.torque = field_torque(motor_, rotor);
  memory_.pull_out_torque = pull_out_torque(field.amplitude, rotor.velocity);
  memory_.regime = slipping ? Regime::slipping : Regime::free;
  if (always_free_) return;

  const Tick span = end - memory_.now;
  const double seconds = seconds_of(span);
  const double swing_frequency =
      std::sqrt(MotorData::pole_pairs * motor_.torque_constant() * field.amplitude / inertia()) / radians_per_turn;
  const bool running_away = field.energised && field.steps.empty() &&
                            std::fabs(field.velocity_after(seconds) - rotor.velocity) > swing_frequency;
  memory_.running_away = running_away ? memory_.running_away + span : 0;
  if (memory_.running_away >= running_away_time) {
    memory_.regime = Regime::slipping;
  } else if (!running_away) {
    memory_.regime = Regime::free;
  }

  memory_.calm = calm(field, seconds, rotor) ? memory_.calm + span : 0;
  memory_.cruise = observed_cruise(field, span, rotor);
  if (memory_.calm >= calm_time) {
    memory_.regime = Regime::locked;
    memory_.calm = 0;
    memory_.cruise = {};
  } else if (settled(field, memory_.cruise)) {
    memory_.regime = Regime::locked;
  }
}

/// The rotor as the closed form left it, with the currents of an even motion at its load angle.
PhaseState MotorShaft::entering_free(const Field& field) const {
  PhaseState result = memory_.rotor;
  const double speed = std::fabs(field.velocity);
  if (!field.energised || memory_.amplitude == 0 || speed == 0 || speed >= TorqueTable::highest_speed) {
    // The currents are those of the span before.
    const CoilCurrents currents = memory_.amplitude == 0 ? CoilCurrents{0, 0} : ideal_currents(field, field.angle);
    result.current_a = currents.a;
    result.current_b = currents.b;
    return result;
  }
  // Backwards everything is mirrored: the frame turns with the field, so angles count against it.
  const double direction = field.velocity < 0 ? -1 : 1;
  const double load_angle = direction * (field.angle - memory_.rotor.angle) * radians_per_turn;
  const AveragedMotor averaged({.torque_constant = motor_.torque_constant(),
                                .inductance = motor_.winding_inductance,
                                .resistance = conditions().resistance,
                                .supply = supply_,
                                .amplitude = field.amplitude},
                               speed * radians_per_turn);
  const Phasor current = averaged.at(load_angle).current;
  const Phasor coils = Phasor{current.along, direction * current.across} * unit_phasor(memory_.rotor.angle);
  result.current_a = field.coil_a_connected ? coils.along : 0;
  result.current_b = field.coil_b_connected ? coils.across : 0;
  return result;
}

// ---- Conditions and what can be measured

MotorConditions MotorShaft::conditions() const {
  return {&motor_, &load_, supply_, warm_resistance(motor_.winding_resistance, memory_.winding_temperature)};
}

const TorqueTable& MotorShaft::table(double amplitude) const {
  const TorqueTables::Key key = TorqueTables::key(supply_, amplitude, memory_.winding_temperature);
  if (!table_ || key != table_key_) {
    table_ = tables_->table(motor_, key);
    table_key_ = key;
    even_balance_.reset();
  }
  return *table_;
}

/// Torque on a standing rotor under a standing field, with the currents settled and without friction, N m.
double MotorShaft::standing_torque(const Field& field, double rotor_angle) const {
  const CoilCurrents currents = ideal_currents(field, field.angle);
  const PhaseState rotor{rotor_angle, 0, currents.a, currents.b};
  return field_torque(motor_, rotor) + detent_torque(motor_, rotor_angle) - load_torque(conditions(), rotor_angle);
}

MotorShaft::Effort MotorShaft::effort() const {
  return {memory_.torque, memory_.pull_out_torque,
          motor_.torque_constant() * std::fabs(memory_.rotor.velocity) * shaft_radians};
}

/// N m; 0 without current and beyond every table.
double MotorShaft::pull_out_torque(double amplitude, double velocity) const {
  if (amplitude <= 0 || std::fabs(velocity) >= TorqueTable::highest_speed) return 0;
  return table(amplitude).pull_out_torque(velocity);
}

std::int32_t MotorShaft::stall_guard_measurement() const {
  const Effort now = effort();
  if (now.pull_out_torque <= 0 || supply_ <= 0) return 0;
  // SG = 1023 G (Km w / Vs) (1 - |T| / T_max): the share of the energy that flows back from the motor
  const double value =
      1023 * motor_.stall_guard_gain * (now.back_emf / supply_) * (1 - std::fabs(now.torque) / now.pull_out_torque);
  constexpr double beyond_every_scale = 1e6;
  return static_cast<std::int32_t>(nearest_integer(std::clamp(value, -beyond_every_scale, beyond_every_scale)));
}

MotorShaft::Currents MotorShaft::currents(const Field& field) const {
  if (memory_.regime == Regime::locked) return ideal_currents(field, field.angle);
  return {memory_.rotor.current_a, memory_.rotor.current_b};
}

/// Winding temperature after a span: one body that warms towards the copper loss of the currents aimed at.
double MotorShaft::heated(double seconds, const Field& field) const {
  const double coils = (field.coil_a_connected ? 0.5 : 0) + (field.coil_b_connected ? 0.5 : 0);
  const double share = field.energised ? field.amplitude / motor_.rated_amplitude() : 0;
  // The rise at the rated current is that of a winding that has become warm.
  constexpr double usual_ambient = 25;
  const double warmer =
      conditions().resistance /
      warm_resistance(motor_.winding_resistance, usual_ambient + motor_.temperature_rise_at_rated_current);
  const double final_temperature = ambient_ + motor_.temperature_rise_at_rated_current * coils * share * share * warmer;
  // tau dTw/dt = T_final - Tw. Most spans are so short that the series of e^-x needs no third term.
  const double time = seconds / motor_.winding_time_constant;
  const double gone = time < 1e-5 ? time * (1 - 0.5 * time) : 1 - exponential(-time);
  return memory_.winding_temperature + (final_temperature - memory_.winding_temperature) * gone;
}

}  // namespace opentmcl::twin
