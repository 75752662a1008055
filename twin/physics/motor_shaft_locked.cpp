// The locked regime of MotorShaft: the rotor as a closed form, and where that can be trusted.

#include <algorithm>
#include <cmath>

#include "twin/physics/damped_swing.hpp"
#include "twin/physics/elementary.hpp"
#include "twin/physics/motor_shaft.hpp"

namespace opentmcl::twin {
namespace {

constexpr double shaft_radians = MotorData::shaft_radians_per_turn;

/// Above this share of the holding torque the detent bends the closed form too much: it changes the stiffness by four
/// times as much.
constexpr double most_detent = 0.15;

double sign(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// How far the field is ahead of the rotor, radians, counted from the pole that is nearest to `expected`.
double lead(double field_angle, double rotor_angle, double expected) {
  const double turns = field_angle - rotor_angle;
  return (turns - nearest_integer(turns - expected / radians_per_turn)) * radians_per_turn;
}

/// Detent resonances: the field passes four detents an electrical turn, and the rotor answers strongly where that is
/// its own frequency, or twice it.
bool shakes(double first_velocity, double last_velocity, double natural_frequency) {
  const double slowest = std::min(std::fabs(first_velocity), std::fabs(last_velocity));
  const double fastest = std::max(std::fabs(first_velocity), std::fabs(last_velocity));
  const double natural = natural_frequency / radians_per_turn;
  const auto meets = [&](double centre, double width) {
    return fastest > centre * (1 - width) && slowest < centre * (1 + width);
  };
  return meets(natural / 4, 0.15) || meets(natural / 2, 0.10);
}

}  // namespace

/// Where the closed form is trusted (decision 0038). Going back to it asks for more than staying.
struct MotorShaft::Limits {
  double torque_share;  ///< of the pull-out torque
  double swing;         ///< electrical radians
  double angle_share;   ///< load angle and swing together, of the pull-out angle

  static constexpr Limits to_stay() { return {.torque_share = 0.95, .swing = 0.15, .angle_share = 0.9}; }
  static constexpr Limits to_return() { return {.torque_share = 0.88, .swing = 0.1, .angle_share = 0.85}; }
};

bool MotorShaft::can_lock(const Field& field) const {
  return field.energised && field.coil_a_connected && field.coil_b_connected && field.steps.empty() && !load_.jammed &&
         field.amplitude * motor_.torque_constant() * most_detent >= motor_.detent_torque &&
         std::fabs(field.velocity) < TorqueTable::highest_speed;
}

std::optional<MotorShaft::Arrival> MotorShaft::locked_after(Tick end, const Field& field) const {
  if (memory_.regime != Regime::locked || always_free_ || !can_lock(field)) return std::nullopt;
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

/// Of small swings about a place, rad/s: w_n² = Nr (dT/dd) / J.
double MotorShaft::natural_frequency(const Equilibrium& equilibrium) const {
  return std::sqrt(MotorData::pole_pairs * equilibrium.stiffness / inertia());
}

/// Damped so much that it only creeps is a matter for the integrator.
bool MotorShaft::swings(double frequency) const {
  return frequency > 2 * swing_decay();
}

std::optional<MotorShaft::MovingBalance> MotorShaft::moving_balance(const Field& field, double seconds,
                                                                    const TorqueTable& torques) const {
  constexpr Limits limits = Limits::to_stay();
  const double end_velocity = field.velocity_after(seconds);
  const double end_angle = memory_.rotor.angle + field.angle_after(seconds) - field.angle;
  const std::optional<Equilibrium> last =
      moving_equilibrium(end_angle, end_velocity, field.acceleration, torques, limits);
  if (!last) return std::nullopt;
  const std::optional<Equilibrium> first =
      keeps_its_balance(field)
          ? last
          : moving_equilibrium(memory_.rotor.angle, field.velocity, field.acceleration, torques, limits);
  if (!first) return std::nullopt;

  const double frequency = natural_frequency(*last);
  if (!swings(frequency) || shakes(field.velocity, end_velocity, frequency)) return std::nullopt;
  return MovingBalance{*first, *last, DampedOscillator(swing_decay(), frequency)};
}

/// With neither acceleration nor spring it does not depend on where and for how long the field turns.
std::optional<MotorShaft::MovingBalance> MotorShaft::remembered_balance(const Field& field, double seconds) const {
  const TorqueTable& torques = table(field.amplitude);
  if (!keeps_its_balance(field)) return moving_balance(field, seconds, torques);
  if (!even_balance_ || even_balance_->velocity != field.velocity) {
    even_balance_ = {field.velocity, moving_balance(field, seconds, torques)};
  }
  return even_balance_->balance;
}

/// The field turns, and the rotor with it.
std::optional<MotorShaft::Arrival> MotorShaft::following(const Field& field, double seconds) const {
  constexpr Limits limits = Limits::to_stay();
  const std::optional<MovingBalance> balance = remembered_balance(field, seconds);
  if (!balance) return std::nullopt;
  const auto& [first, last, oscillator] = *balance;
  const double end_angle = field.angle_after(seconds);

  // The equilibrium itself moves evenly from first to last; lead and its rate are continuous.
  const double drift = (last.lead - first.lead) / seconds;
  const double lead_now = lead(field.angle, memory_.rotor.angle, first.lead);
  const Swing swing{lead_now - first.lead, radians_per_turn * (field.velocity - memory_.rotor.velocity) - drift};
  const double amplitude = oscillator.amplitude(swing);
  if (amplitude > limits.swing || std::max(std::fabs(first.lead), std::fabs(last.lead)) + amplitude > last.most_lead)
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
  const bool swings_on = amplitude >= no_swing;
  const Swing then = swings_on ? oscillator.after(swing, seconds) : Swing{};
  return Arrival{.rotor = {.angle = end_angle - pole - (last.lead + then.deviation) / radians_per_turn,
                           .velocity = field.velocity_after(seconds) - (drift + then.rate) / radians_per_turn},
                 .torque = last.torque,
                 .pull_out_torque = last.pull_out_torque,
                 .is_even = keeps_its_balance(field) && !swings_on,
                 .is_cruise = false};
}

/// The field turns evenly under the conditions of a motion that has settled: the rotor keeps its lead.
std::optional<MotorShaft::Arrival> MotorShaft::cruising(const Field& field, double seconds) const {
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
  return Arrival{.rotor = {.angle = field.angle_after(seconds) - pole - mean, .velocity = field.velocity},
                 .torque = cruise.torque,
                 .pull_out_torque = memory_.pull_out_torque,
                 .is_even = true,
                 .is_cruise = true};
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
std::optional<MotorShaft::Arrival> MotorShaft::settling(const Field& field, double seconds) const {
  constexpr Limits limits = Limits::to_stay();
  // A spring moves the equilibrium of each pole to another place.
  const double pole = nearest_integer(field.angle - memory_.rotor.angle);
  const double angle = field.angle - pole;
  const std::optional<Equilibrium> centre = standing_equilibrium(angle, table(field.amplitude), limits);
  if (!centre) return std::nullopt;
  const double frequency = natural_frequency(*centre);
  if (!swings(frequency)) return std::nullopt;
  const DampedOscillator oscillator(swing_decay(), frequency);

  Swing swing{(angle - memory_.rotor.angle) * radians_per_turn - centre->lead,
              -radians_per_turn * memory_.rotor.velocity};
  const double amplitude = oscillator.amplitude(swing);
  if (amplitude > limits.swing || std::fabs(centre->lead) + amplitude > centre->most_lead) return std::nullopt;
  const double margin = 0.25 + amplitude / radians_per_turn;
  if (angle - margin < load_.lowest_angle || angle + margin > load_.highest_angle) return std::nullopt;

  const double friction_angle = friction() / centre->stiffness;
  const auto rotor_angle = [&] { return angle - (centre->lead + swing.deviation) / radians_per_turn; };
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
  return Arrival{.rotor = {.angle = rotor_angle(), .velocity = -swing.rate / radians_per_turn},
                 .torque = centre->torque,
                 .pull_out_torque = centre->pull_out_torque,
                 .is_even = false,
                 .is_cruise = false};
}

// ---- The way back from the integrator

/// Whether the closed form can take over at the end of a span.
bool MotorShaft::calm(const Field& field, double seconds, const PhaseState& rotor) const {
  constexpr Limits limits = Limits::to_return();
  if (!can_lock(field)) return false;
  const double angle = field.angle_after(seconds);
  const double velocity = field.velocity_after(seconds);
  const TorqueTable& torques = table(field.amplitude);
  const std::optional<Equilibrium> centre =
      field.stands() ? standing_equilibrium(angle - nearest_integer(angle - rotor.angle), torques, limits)
                     : moving_equilibrium(rotor.angle, velocity, field.acceleration, torques, limits);
  if (!centre) return false;
  const double frequency = natural_frequency(*centre);
  if (!swings(frequency) || (!field.stands() && shakes(field.velocity, velocity, frequency))) return false;
  const DampedOscillator oscillator(swing_decay(), frequency);
  const double amplitude = oscillator.amplitude(
      {lead(angle, rotor.angle, centre->lead) - centre->lead, radians_per_turn * (velocity - rotor.velocity)});
  const double margin = 0.25;
  return amplitude < limits.swing && std::fabs(centre->lead) + amplitude < centre->most_lead &&
         rotor.angle - margin > load_.lowest_angle && rotor.angle + margin < load_.highest_angle;
}

/// The lead that the rotor has kept under the present conditions.
MotorShaft::Cruise MotorShaft::observed_cruise(const Field& field, Tick span, const PhaseState& rotor) const {
  /// Electrical turns; wider is no even motion.
  constexpr double band = 0.01;
  if (!can_lock(field) || field.velocity == 0 || field.acceleration != 0 || load_.spring != 0) return {};
  const double ahead = field.angle_after(seconds_of(span)) - rotor.angle;
  const double here = ahead - nearest_integer(ahead);
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
  return point.saturated && std::fabs(cruise.torque) < Limits::to_stay().torque_share * point.pull_out_torque &&
         swings_die_down(point.response, inertia(), drag() + motor_.eddy_damping, 0.5 * swing_decay());
}

}  // namespace opentmcl::twin
