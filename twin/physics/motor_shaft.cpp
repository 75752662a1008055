#include "twin/physics/motor_shaft.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/physics/damped_swing.hpp"
#include "twin/physics/elementary.hpp"

namespace opentmcl::twin {
namespace {

/// Radians of the shaft in an electrical turn.
constexpr double shaft_radians = radians_per_turn / MotorData::pole_pairs;

constexpr Tick ticks_per_millisecond = 1000 * ticks_per_microsecond;
constexpr Tick free_step = 20 * ticks_per_microsecond;
constexpr Tick slipping_step = 40 * ticks_per_microsecond;

/// A free rotor is taken as locked when it has swung little for so long.
constexpr Tick calm_time = 3 * ticks_per_millisecond;
/// A free rotor is taken as slipping when the field has run away from it for so long.
constexpr Tick running_away_time = 20 * ticks_per_millisecond;

/// Above this share of the holding torque the detent bends the closed form too much: it changes the stiffness by four
/// times as much.
constexpr double most_detent = 0.15;

constexpr double seconds_of(Tick ticks) {
  return static_cast<double>(ticks) * seconds_per_tick;
}

double sign(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// How far the field is ahead of the rotor, radians, counted from the pole that is nearest to `expected`.
double lead(double field_angle, double rotor_angle, double expected) {
  const double turns = field_angle - rotor_angle;
  return (turns - nearest_integer(turns - expected / radians_per_turn)) * radians_per_turn;
}

}  // namespace

/// Where the closed form is trusted. Going back to it asks for more than staying.
struct MotorShaft::Limits {
  double torque_share;  ///< of the pull-out torque
  double swing;         ///< electrical radians
  double angle_share;   ///< load angle and swing together, of the pull-out angle
};

namespace {
constexpr double decay_share = 0.5;  ///< of the swing's decay at low speed, that a saturated motor must keep
}

struct MotorShaft::Equilibrium {
  double lead;             ///< radians by which the field leads the rotor
  double stiffness;        ///< N m per electrical radian
  double torque;           ///< N m of the field
  double most_lead;        ///< radians, with a swing
  double pull_out_torque;  ///< N m
};

MotorShaft::MotorShaft(const MotorData& motor, std::shared_ptr<TorqueTables> tables)
    : motor_(motor), tables_(std::move(tables)) {}

void MotorShaft::advance_to(Tick end, const Field& field) {
  memory_ = after(end, field);
}

MotorShaft::State MotorShaft::state_at(Tick tick, const Field& field) const {
  if (tick <= memory_.now) return state();
  const Memory then = after(tick, field);
  return {then.rotor.angle, then.rotor.velocity};
}

MotorShaft::Memory MotorShaft::after(Tick end, const Field& field) const {
  Memory result = memory_;
  if (at_rest(field)) {
    result.rotor.velocity = 0;
    const CoilCurrents currents = ideal_currents(field, field.angle);
    result.rotor.current_a = currents.a;
    result.rotor.current_b = currents.b;
    result.regime = !always_free_ && can_lock(field) ? Regime::locked : Regime::free;
    result.calm = 0;
    result.running_away = 0;
    result.torque = field_torque(motor_, result.rotor);
    result.pull_out_torque = pull_out_torque(field.amplitude, 0);
  } else if (auto locked =
                 memory_.regime == Regime::locked && !always_free_ ? locked_after(end, field) : std::nullopt) {
    result = *locked;
  } else {
    result = integrated(end, field);
  }
  result.now = end;
  result.amplitude = field.amplitude;
  result.winding_temperature = heated(seconds_of(end - memory_.now), field);
  return result;
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
  if (at_rest(field)) return 10 * ticks_per_millisecond;
  if (memory_.regime != Regime::locked || !can_lock(field)) return ticks_per_millisecond;
  return field.acceleration == 0 && load_.spring == 0 ? 10 * ticks_per_millisecond : 2 * ticks_per_millisecond;
}

// ---- Locked

bool MotorShaft::can_lock(const Field& field) const {
  return field.energised && field.coil_a_connected && field.coil_b_connected && field.steps.empty() && !load_.jammed &&
         field.amplitude * motor_.torque_constant() * most_detent >= motor_.detent_torque &&
         std::fabs(field.velocity) < TorqueTable::highest_speed;
}

namespace {
constexpr double stay_torque = 0.95;
}  // namespace

std::optional<MotorShaft::Memory> MotorShaft::locked_after(Tick end, const Field& field) const {
  if (!can_lock(field)) return std::nullopt;
  const double seconds = seconds_of(end - memory_.now);
  if (field.stands()) return settling(field, seconds);
  if (auto cruise = cruising(field, seconds)) return cruise;
  return following(field, seconds);
}

/// What the field must give at a place: T = T_load + spring + friction + B w + J dw/dt, N m.
double MotorShaft::moving_torque(double angle, double velocity, double acceleration) const {
  const double direction = velocity != 0 ? sign(velocity) : sign(acceleration);
  return load_.torque + load_.spring * shaft_radians * (angle - load_.spring_centre) + direction * friction() +
         shaft_radians * (drag() * velocity + inertia() * acceleration);
}

std::optional<MotorShaft::Equilibrium> MotorShaft::moving_equilibrium(double angle, double velocity,
                                                                      double acceleration, const TorqueTable& table,
                                                                      const Limits& limits) const {
  if (std::fabs(velocity) >= TorqueTable::highest_speed) return std::nullopt;
  const double torque = moving_torque(angle, velocity, acceleration);
  const double direction = velocity != 0 ? sign(velocity) : sign(acceleration);
  const TorqueTable::Point point = table.at(direction < 0 ? -std::fabs(velocity) : std::fabs(velocity), torque);
  if (point.saturated || std::fabs(torque) > limits.torque_share * point.pull_out_torque) return std::nullopt;
  return Equilibrium{point.load_angle, point.stiffness + load_.spring / MotorData::pole_pairs, torque,
                     limits.angle_share * point.pull_out_angle, point.pull_out_torque};
}

/// Detent resonances: the field passes four detents an electrical turn, and the rotor answers strongly where that is
/// its own frequency, or twice it.
static bool shakes(double first_velocity, double last_velocity, double natural_frequency) {
  const double slowest = std::min(std::fabs(first_velocity), std::fabs(last_velocity));
  const double fastest = std::max(std::fabs(first_velocity), std::fabs(last_velocity));
  const double natural = natural_frequency / radians_per_turn;
  const auto meets = [&](double centre, double width) {
    return fastest > centre * (1 - width) && slowest < centre * (1 + width);
  };
  return meets(natural / 4, 0.15) || meets(natural / 2, 0.10);
}

/// The field turns, and the rotor with it.
std::optional<MotorShaft::Memory> MotorShaft::following(const Field& field, double seconds) const {
  constexpr Limits to_stay{.torque_share = stay_torque, .swing = 0.15, .angle_share = 0.9};
  const TorqueTable& torques = table(field.amplitude);
  const double end_angle = field.angle_after(seconds);
  const double end_velocity = field.velocity_after(seconds);
  const std::optional<Equilibrium> last = moving_equilibrium(memory_.rotor.angle + end_angle - field.angle,
                                                             end_velocity, field.acceleration, torques, to_stay);
  if (!last) return std::nullopt;
  const bool steady = field.acceleration == 0 && load_.spring == 0;
  const std::optional<Equilibrium> first =
      steady ? last : moving_equilibrium(memory_.rotor.angle, field.velocity, field.acceleration, torques, to_stay);
  if (!first) return std::nullopt;

  const double natural_frequency = std::sqrt(MotorData::pole_pairs * last->stiffness / inertia());
  if (natural_frequency < 2 * swing_decay()) return std::nullopt;
  if (shakes(field.velocity, end_velocity, natural_frequency)) return std::nullopt;

  // The equilibrium itself moves evenly from first to last; lead and its rate are continuous.
  const double drift = (last->lead - first->lead) / seconds;
  const DampedOscillator oscillator(swing_decay(), natural_frequency);
  const double lead_now = lead(field.angle, memory_.rotor.angle, first->lead);
  const Swing swing{lead_now - first->lead, radians_per_turn * (field.velocity - memory_.rotor.velocity) - drift};
  const double amplitude = oscillator.amplitude(swing);
  if (amplitude > to_stay.swing ||
      std::max(std::fabs(first->lead), std::fabs(last->lead)) + amplitude > last->most_lead)
    return std::nullopt;

  const double pole = field.angle - memory_.rotor.angle - lead_now / radians_per_turn;
  // Ends are for the integrator.
  const double margin = 0.25 + amplitude / radians_per_turn;
  if (std::min(field.angle, end_angle) - pole - margin < load_.lowest_angle ||
      std::max(field.angle, end_angle) - pole + margin > load_.highest_angle) {
    return std::nullopt;
  }

  // What rounding leaves of a swing that died down long ago.
  constexpr double no_swing = 1e-8;
  const Swing then = amplitude < no_swing ? Swing{} : oscillator.after(swing, seconds);
  Memory result = memory_;
  result.rotor.angle = end_angle - pole - (last->lead + then.deviation) / radians_per_turn;
  result.rotor.velocity = end_velocity - (drift + then.rate) / radians_per_turn;
  result.torque = last->torque;
  result.pull_out_torque = last->pull_out_torque;
  return result;
}

/// The field turns evenly under the conditions of a motion that has settled: the rotor keeps its lead.
std::optional<MotorShaft::Memory> MotorShaft::cruising(const Field& field, double seconds) const {
  const Cruise& cruise = memory_.cruise;
  if (cruise.velocity == 0 || field.velocity != cruise.velocity || field.acceleration != 0 ||
      cruise.conditions != TorqueTables::key(supply_, field.amplitude, memory_.winding_temperature) ||
      cruise.torque != moving_torque(memory_.rotor.angle, field.velocity, 0)) {
    return std::nullopt;
  }
  const double mean = (cruise.least_lead + cruise.most_lead) / 2;
  const double pole = nearest_integer(field.angle - memory_.rotor.angle - mean);
  const double reach = std::fabs(field.velocity) * seconds + 0.5;
  if (memory_.rotor.angle - reach < load_.lowest_angle || memory_.rotor.angle + reach > load_.highest_angle)
    return std::nullopt;
  Memory result = memory_;
  result.rotor.angle = field.angle_after(seconds) - pole - mean;
  result.rotor.velocity = field.velocity;
  result.torque = cruise.torque;
  return result;
}

std::optional<MotorShaft::Equilibrium> MotorShaft::standing_equilibrium(double angle, const TorqueTable& table,
                                                                        const Limits& limits) const {
  const double most = table.pull_out_torque(0);
  // T_max sin d + T_detent - T_load = 0, by Newton's method from no lead at all.
  double load_angle = 0;
  double stiffness = most;
  for (int round = 0; round < 8; ++round) {
    const double rotor = angle - load_angle / radians_per_turn;
    const Phasor field = unit_phasor(load_angle / radians_per_turn);
    const Phasor detent = unit_phasor(4 * rotor);
    const double spring = load_.spring * shaft_radians * (rotor - load_.spring_centre);
    const double torque = most * field.across - motor_.detent_torque * detent.across - spring - load_.torque;
    stiffness = most * field.along + 4 * motor_.detent_torque * detent.along + load_.spring / MotorData::pole_pairs;
    if (stiffness < 0.2 * most) return std::nullopt;
    const double correction = torque / stiffness;
    load_angle -= correction;
    if (std::fabs(correction) < 1e-9) break;
  }
  const double torque = most * unit_phasor(load_angle / radians_per_turn).across;
  if (std::fabs(torque) > limits.torque_share * most) return std::nullopt;
  return Equilibrium{load_angle, stiffness, torque, limits.angle_share * std::numbers::pi / 2, most};
}

/// The field stands, and the rotor comes to rest: half swings, each about a place that friction has moved against it.
std::optional<MotorShaft::Memory> MotorShaft::settling(const Field& field, double seconds) const {
  constexpr Limits to_stay{.torque_share = stay_torque, .swing = 0.15, .angle_share = 0.9};
  // A spring moves the equilibrium of each pole to another place.
  const double pole = nearest_integer(field.angle - memory_.rotor.angle);
  const double angle = field.angle - pole;
  const std::optional<Equilibrium> centre = standing_equilibrium(angle, table(field.amplitude), to_stay);
  if (!centre) return std::nullopt;
  const double natural_frequency = std::sqrt(MotorData::pole_pairs * centre->stiffness / inertia());
  if (natural_frequency < 2 * swing_decay()) return std::nullopt;
  const DampedOscillator oscillator(swing_decay(), natural_frequency);

  Swing swing{(angle - memory_.rotor.angle) * radians_per_turn - centre->lead,
              -radians_per_turn * memory_.rotor.velocity};
  const double amplitude = oscillator.amplitude(swing);
  if (amplitude > to_stay.swing || std::fabs(centre->lead) + amplitude > centre->most_lead) return std::nullopt;
  const double margin = 0.25 + amplitude / radians_per_turn;
  if (angle - margin < load_.lowest_angle || angle + margin > load_.highest_angle) return std::nullopt;

  const double friction_angle = friction() / centre->stiffness;
  const auto rotor_angle = [&] { return angle - (centre->lead + swing.deviation) / radians_per_turn; };
  Memory result = memory_;
  for (double left = seconds; left > 0;) {
    if (swing.rate == 0) {
      if (std::fabs(standing_torque(field, rotor_angle())) <= friction()) break;
      // At the edge of what friction holds the straight line and the true curve may disagree.
      if (std::fabs(swing.deviation) <= friction_angle) return std::nullopt;
    }
    const double direction = swing.rate != 0 ? sign(swing.rate) : -sign(swing.deviation);
    // Friction pulls against the motion: the place that is swung about lies `friction_angle` back.
    swing.deviation += direction * friction_angle;
    const double half = oscillator.time_to_turn(swing);
    const double part = std::min(half, left);
    swing = oscillator.after(swing, part);
    swing.deviation -= direction * friction_angle;
    if (part == half) swing.rate = 0;
    left -= part;
  }
  result.rotor.angle = rotor_angle();
  result.rotor.velocity = -swing.rate / radians_per_turn;
  result.torque = centre->torque;
  result.pull_out_torque = centre->pull_out_torque;
  return result;
}

// ---- Free and slipping

MotorShaft::Memory MotorShaft::integrated(Tick end, const Field& field) const {
  Memory result = memory_;
  const bool slipping = memory_.regime == Regime::slipping && !always_free_;
  const PhaseState begin = memory_.regime == Regime::locked ? entering_free(field) : memory_.rotor;
  result.rotor = integrate(conditions(), field, begin, memory_.now, end, slipping ? slipping_step : free_step);
  result.torque = field_torque(motor_, result.rotor);
  result.pull_out_torque = pull_out_torque(field.amplitude, result.rotor.velocity);
  result.regime = slipping ? Regime::slipping : Regime::free;
  if (always_free_) return result;

  const Tick span = end - memory_.now;
  const double seconds = seconds_of(span);
  const double swing_frequency =
      std::sqrt(MotorData::pole_pairs * motor_.torque_constant() * field.amplitude / inertia()) / radians_per_turn;
  const bool running_away = field.energised && field.steps.empty() &&
                            std::fabs(field.velocity_after(seconds) - result.rotor.velocity) > swing_frequency;
  result.running_away = running_away ? memory_.running_away + span : 0;
  if (result.running_away >= running_away_time) {
    result.regime = Regime::slipping;
  } else if (!running_away) {
    result.regime = Regime::free;
  }

  result.calm = calm(field, seconds, result.rotor) ? memory_.calm + span : 0;
  result.cruise = observed_cruise(field, span, result.rotor);
  if (result.calm >= calm_time) {
    result.regime = Regime::locked;
    result.calm = 0;
    result.cruise = {};
  } else if (settled(field, result.cruise)) {
    result.regime = Regime::locked;
  }
  return result;
}

/// The lead that the rotor has kept under the present conditions.
MotorShaft::Cruise MotorShaft::observed_cruise(const Field& field, Tick span, const PhaseState& rotor) const {
  /// Electrical turns; wider is no even motion.
  constexpr double band = 0.01;
  if (!can_lock(field) || field.velocity == 0 || field.acceleration != 0 || load_.spring != 0) return {};
  const double lead = field.angle_after(seconds_of(span)) - rotor.angle;
  const double here = lead - nearest_integer(lead);
  Cruise result{.velocity = field.velocity,
                .torque = moving_torque(rotor.angle, field.velocity, 0),
                .conditions = TorqueTables::key(supply_, field.amplitude, memory_.winding_temperature),
                .least_lead = here,
                .most_lead = here,
                .quiet = 0};
  const Cruise& before = memory_.cruise;
  if (before.velocity == result.velocity && before.torque == result.torque && before.conditions == result.conditions) {
    const double least = std::min(before.least_lead, here);
    const double most = std::max(before.most_lead, here);
    if (most - least < band) {
      result.least_lead = least;
      result.most_lead = most;
      result.quiet = before.quiet + span;
    }
  }
  return result;
}

bool MotorShaft::settled(const Field& field, const Cruise& cruise) const {
  constexpr Tick settling_time = 100 * ticks_per_millisecond;
  if (cruise.quiet < settling_time) return false;
  const TorqueTable::Point point = table(field.amplitude).at(cruise.velocity, cruise.torque);
  return point.saturated && std::fabs(cruise.torque) < stay_torque * point.pull_out_torque &&
         swings_die_down(point.response, inertia(), drag() + motor_.eddy_damping, decay_share * swing_decay());
}

/// Whether the closed form can take over at the end of a span.
bool MotorShaft::calm(const Field& field, double seconds, const PhaseState& rotor) const {
  constexpr Limits to_return{.torque_share = 0.88, .swing = 0.1, .angle_share = 0.85};
  if (!can_lock(field)) return false;
  const double angle = field.angle_after(seconds);
  const double velocity = field.velocity_after(seconds);
  const TorqueTable& torques = table(field.amplitude);
  const std::optional<Equilibrium> centre =
      field.stands() ? standing_equilibrium(angle - nearest_integer(angle - rotor.angle), torques, to_return)
                     : moving_equilibrium(rotor.angle, velocity, field.acceleration, torques, to_return);
  if (!centre) return false;
  const double natural_frequency = std::sqrt(MotorData::pole_pairs * centre->stiffness / inertia());
  if (natural_frequency < 2 * swing_decay()) return false;
  if (!field.stands() && shakes(field.velocity, velocity, natural_frequency)) return false;
  const DampedOscillator oscillator(swing_decay(), natural_frequency);
  const double amplitude = oscillator.amplitude(
      {lead(angle, rotor.angle, centre->lead) - centre->lead, radians_per_turn * (velocity - rotor.velocity)});
  const double margin = 0.25;
  return amplitude < to_return.swing && std::fabs(centre->lead) + amplitude < centre->most_lead &&
         rotor.angle - margin > load_.lowest_angle && rotor.angle + margin < load_.highest_angle;
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
  const double direction = sign(field.velocity);
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
  const double share = field.energised ? field.amplitude / (MotorData::square_root_of_two * motor_.rated_current) : 0;
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
