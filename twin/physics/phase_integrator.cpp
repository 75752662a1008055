#include "twin/physics/phase_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "twin/physics/elementary.hpp"

namespace opentmcl::twin {
namespace {

constexpr double shaft_radians = MotorData::shaft_radians_per_turn;

double inertia_of(const MotorConditions& conditions) {
  return conditions.motor->rotor_inertia + conditions.load->inertia;
}

/// The fastest swing and decay that steps of 20 µs follow with a good margin, 1/s.
constexpr double fastest = 1 / 20e-6;

/// N m per radian. An end on which the shaft would swing faster is made softer.
double end_stiffness(const MotorConditions& conditions) {
  return std::min(conditions.load->end_stiffness, inertia_of(conditions) * fastest * fastest);
}

/// N m s. Oil that would stop the shaft within a step is made thinner.
double viscous_friction(const MotorConditions& conditions) {
  return std::min(conditions.motor->viscous_friction + conditions.load->viscous_friction,
                  inertia_of(conditions) * fastest);
}

/// What the field asks of the regulator at one instant.
struct Demand {
  Phasor current_rate;  ///< A/s in coils A and B that the regulator would make of coils without current
  double velocity;      ///< electrical turns per second
};

/// Turned by what a rotor turns in a step. Up to a tenth of a turn, which is 6000 rpm in 20 µs, a short series does
/// with an error of 8e-6, at usual speeds of 1e-9 and less; a shaft that a load has torn away may be faster.
Phasor turned(Phasor direction, double turns) {
  if (std::fabs(turns) > 0.1) return direction * unit_phasor(turns);
  const double angle = turns * radians_per_turn;
  const double square = angle * angle;
  const double sine = angle * (1 - square * (1.0 / 6 - square * (1.0 / 120)));
  const double cosine = 1 - square * (1.0 / 2 - square * (1.0 / 24 - square * (1.0 / 720)));
  return direction * Phasor{cosine, sine};
}

/// Turned by what acceleration alone turns in a step, usually a thousandth of a radian.
Phasor turned_slightly(Phasor direction, double turns) {
  if (std::fabs(turns) > 0.01) return direction * unit_phasor(turns);
  const double angle = turns * radians_per_turn;
  return direction * Phasor{1 - 0.5 * angle * angle, angle};
}

struct Rates {
  double velocity;      ///< d angle / dt
  double acceleration;  ///< d velocity / dt
  double current_a;     ///< d current / dt
  double current_b;
};

/// What changes its sign when motion or current does, and is held over a step.
struct Held {
  double friction;                 ///< N m of Coulomb friction, against the motion
  double acceleration_per_torque;  ///< 0 for a rotor that does not move
  Phasor freewheel_rate;           ///< A/s in coils A and B, against their currents
};

/// Constants of a span, in the units of the equations: electrical turns, seconds, amperes.
class Equations {
 public:
  Equations(const MotorConditions& conditions, const Field& field)
      : load_(*conditions.load),
        amplitude_(field.amplitude),
        connected_a_(field.coil_a_connected),
        connected_b_(field.coil_b_connected),
        supply_rate_(conditions.supply / conditions.motor->winding_inductance),
        resistance_rate_(conditions.resistance / conditions.motor->winding_inductance),
        emf_rate_(conditions.motor->torque_constant() * shaft_radians / conditions.motor->winding_inductance),
        torque_constant_(conditions.motor->torque_constant()),
        detent_torque_(4 * conditions.motor->detent_torque),
        friction_(conditions.motor->coulomb_friction + load_.coulomb_friction),
        eddy_damping_(field.energised ? conditions.motor->eddy_damping * shaft_radians : 0),
        drag_(viscous_friction(conditions) * shaft_radians + eddy_damping_),
        acceleration_per_torque_(1 / (inertia_of(conditions) * shaft_radians)),
        end_stiffness_(end_stiffness(conditions) * shaft_radians) {
    // Rubber to steel give back some of the energy; a fifth of critical damping leaves half of the speed.
    constexpr double damping_ratio = 0.2;
    end_damping_ = 2 * damping_ratio * std::sqrt(end_stiffness(conditions) * inertia_of(conditions)) * shaft_radians;
  }

  double friction() const { return friction_; }
  double supply_rate() const { return supply_rate_; }
  double acceleration_per_torque() const { return acceleration_per_torque_; }

  /// The regulator: u = (i* - i) L / tau + R i + e + L di*/dt, as far as the supply reaches. Here is what does not
  /// depend on i: (i* / tau + di*/dt), i* = amplitude (cos, sin).
  Demand demand(Phasor direction, double velocity) const {
    const double turning = velocity * radians_per_turn;
    return {amplitude_ * Phasor{direction.along * per_time_constant - turning * direction.across,
                                direction.across * per_time_constant + turning * direction.along},
            velocity};
  }

  /// Torque on the rotor without Coulomb friction, N m.
  template <bool place_dependent>
  double torque(const PhaseState& state, Phasor rotor, double field_velocity) const {
    const double s = rotor.across;
    const double c = rotor.along;
    // T = Km (-iA sin(Nr th) + iB cos(Nr th)) - Td sin(4 Nr th) - B w - Dr (w - w_field) - T_load,
    // sin 4x = 4 sin x cos x (cos²x - sin²x)
    double sum = torque_constant_ * (state.current_b * c - state.current_a * s) -
                 detent_torque_ * ((s * c) * (c * c - s * s)) - drag_ * state.velocity +
                 (eddy_damping_ * field_velocity - load_.torque);
    if constexpr (place_dependent) {
      sum -= load_.spring * shaft_radians * (state.angle - load_.spring_centre);
      // An end pushes and never pulls.
      if (state.angle < load_.lowest_angle) {
        sum += std::max(0.0, end_stiffness_ * (load_.lowest_angle - state.angle) - end_damping_ * state.velocity);
      } else if (state.angle > load_.highest_angle) {
        sum -= std::max(0.0, end_stiffness_ * (state.angle - load_.highest_angle) + end_damping_ * state.velocity);
      }
    }
    return sum;
  }

  template <bool energised, bool place_dependent>
  Rates rates(const PhaseState& state, Phasor rotor, const Demand& demand, const Held& held) const {
    Rates result{};
    result.velocity = state.velocity;
    // J dw/dt = T
    result.acceleration =
        held.acceleration_per_torque * (torque<place_dependent>(state, rotor, demand.velocity) - held.friction);
    // L di/dt = u - R i - e, e = Km w (-sin(Nr th), cos(Nr th)); all over L
    const double emf = emf_rate_ * state.velocity;
    const double drop_a = resistance_rate_ * state.current_a - emf * rotor.across;
    const double drop_b = resistance_rate_ * state.current_b + emf * rotor.along;
    if constexpr (energised) {
      const double wanted_a = demand.current_rate.along - per_time_constant * state.current_a;
      const double wanted_b = demand.current_rate.across - per_time_constant * state.current_b;
      result.current_a = connected_a_ ? limited(wanted_a + drop_a) - drop_a : 0;
      result.current_b = connected_b_ ? limited(wanted_b + drop_b) - drop_b : 0;
    } else {
      // Through the diodes into the supply, until there is no current left.
      result.current_a = state.current_a == 0 ? 0 : held.freewheel_rate.along - drop_a;
      result.current_b = state.current_b == 0 ? 0 : held.freewheel_rate.across - drop_b;
    }
    return result;
  }

 private:
  static constexpr double per_time_constant = 1 / regulator_time_constant;

  double limited(double voltage_rate) const { return std::min(std::max(voltage_rate, -supply_rate_), supply_rate_); }

  const Load& load_;
  double amplitude_;
  bool connected_a_;
  bool connected_b_;
  double supply_rate_;      ///< Vs / L
  double resistance_rate_;  ///< R / L
  double emf_rate_;         ///< V / L per electrical turn per second
  double torque_constant_;
  double detent_torque_;  ///< four times it
  double friction_;
  double eddy_damping_;             ///< N m per electrical turn per second
  double drag_;                     ///< the same, eddy damping included
  double acceleration_per_torque_;  ///< electrical turns per second² and N m
  double end_stiffness_;            ///< N m per electrical turn
  double end_damping_ = 0;          ///< N m per electrical turn per second
};

PhaseState moved(const PhaseState& state, const Rates& rates, double seconds) {
  return {state.angle + seconds * rates.velocity, state.velocity + seconds * rates.acceleration,
          state.current_a + seconds * rates.current_a, state.current_b + seconds * rates.current_b};
}

/// A current that changed its sign while it died away is gone.
double died_away(double before, double after) {
  return before * after > 0 ? after : 0;
}

/// A step of time as the field has it.
struct Interval {
  double seconds;
  Demand begin;
  Demand middle;
  Demand end;
};

/// @param rotor the direction of the state's angle; afterwards that of the new one
template <bool energised, bool place_dependent>
PhaseState step(const Equations& equations, const PhaseState& state, Phasor& rotor, const Interval& interval,
                bool jammed) {
  // Coulomb friction is a force against motion, and holds a shaft at rest against torques up to its own.
  Held held{.friction = std::copysign(equations.friction(), state.velocity),
            .acceleration_per_torque = equations.acceleration_per_torque(),
            .freewheel_rate = {std::copysign(equations.supply_rate(), -state.current_a),
                               std::copysign(equations.supply_rate(), -state.current_b)}};
  if (state.velocity == 0) {
    const double torque = equations.template torque<place_dependent>(state, rotor, interval.begin.velocity);
    held.friction = std::copysign(equations.friction(), torque);
    if (jammed || std::fabs(torque) <= equations.friction()) held.acceleration_per_torque = 0;
  }

  const auto rates = [&](const PhaseState& at, Phasor direction, const Demand& demand) {
    return equations.template rates<energised, place_dependent>(at, direction, demand, held);
  };
  const double half = interval.seconds / 2;
  const Rates k1 = rates(state, rotor, interval.begin);
  const PhaseState first_middle = moved(state, k1, half);
  const Phasor middle_rotor = turned(rotor, half * state.velocity);
  const Rates k2 = rates(first_middle, middle_rotor, interval.middle);
  const PhaseState second_middle = moved(state, k2, half);
  const Rates k3 = rates(second_middle, turned_slightly(middle_rotor, half * half * k1.acceleration), interval.middle);
  const PhaseState first_end = moved(state, k3, interval.seconds);
  const Phasor end_rotor = turned(rotor, interval.seconds * second_middle.velocity);
  const Rates k4 = rates(first_end, end_rotor, interval.end);
  const double sixth = interval.seconds / 6;
  const auto sum = [](double first, double second, double third, double fourth) {
    return first + 2 * (second + third) + fourth;
  };
  PhaseState after = moved(state,
                           {sum(k1.velocity, k2.velocity, k3.velocity, k4.velocity),
                            sum(k1.acceleration, k2.acceleration, k3.acceleration, k4.acceleration),
                            sum(k1.current_a, k2.current_a, k3.current_a, k4.current_a),
                            sum(k1.current_b, k2.current_b, k3.current_b, k4.current_b)},
                           sixth);
  rotor = turned_slightly(end_rotor, after.angle - first_end.angle);

  if (state.velocity * after.velocity < 0) {
    // The shaft stopped within the step. Friction has turned round since, or holds the shaft from here on.
    const double without_friction = k4.acceleration / held.acceleration_per_torque + held.friction;
    after.velocity = std::fabs(without_friction) <= equations.friction()
                         ? 0
                         : after.velocity * (without_friction + held.friction) / (without_friction - held.friction);
    // The torque at the end of the step and the one at the turn can differ in sign; then the shaft is just at rest.
    if (state.velocity * after.velocity > 0) after.velocity = 0;
  }
  if constexpr (!energised) {
    after.current_a = died_away(state.current_a, after.current_a);
    after.current_b = died_away(state.current_b, after.current_b);
  }
  return after;
}

/// The field as the integrator meets it. A field that turns is rotated from one half step to the next, which is cheaper
/// than a sine each time; a field that steps stands in between.
class MovingField {
 public:
  explicit MovingField(const Field& field)
      : direction_(unit_phasor(field.angle)), velocity_(field.velocity), acceleration_(field.acceleration) {}

  Demand demand(const Equations& equations) const { return equations.demand(direction_, velocity_); }
  void stand_at(double angle) { direction_ = unit_phasor(angle); }
  bool turns() const { return velocity_ != 0 || acceleration_ != 0; }

  void advance(double seconds) {
    if (seconds != rotation_seconds_ || acceleration_ != 0) {
      rotation_seconds_ = seconds;
      rotation_ = unit_phasor(seconds * (velocity_ + 0.5 * acceleration_ * seconds));
    }
    direction_ = direction_ * rotation_;
    velocity_ += acceleration_ * seconds;
  }

 private:
  Phasor direction_;
  double velocity_;
  double acceleration_;
  double rotation_seconds_ = -1;
  Phasor rotation_;
};

template <bool energised, bool place_dependent>
PhaseState integrate_as(const Equations& equations, const Field& field, PhaseState state, Tick begin, Tick end,
                        Tick grid, bool jammed) {
  MovingField moving(field);
  Phasor rotor = unit_phasor(state.angle);
  auto next_step = field.steps.begin();
  Tick next_line = (begin / grid + 1) * grid;
  Demand demand = moving.demand(equations);
  for (Tick now = begin; now < end;) {
    while (next_step != field.steps.end() && next_step->tick <= now) {
      moving.stand_at((next_step++)->angle);
      demand = moving.demand(equations);
    }
    Tick until = std::min(end, next_line);
    if (next_step != field.steps.end()) until = std::min(until, next_step->tick);
    Interval interval{};
    interval.seconds = seconds_of(until - now);
    interval.begin = interval.middle = interval.end = demand;
    if (moving.turns()) {
      moving.advance(interval.seconds / 2);
      interval.middle = moving.demand(equations);
      moving.advance(interval.seconds / 2);
      interval.end = demand = moving.demand(equations);
    }
    state = step<energised, place_dependent>(equations, state, rotor, interval, jammed);
    now = until;
    if (now == next_line) next_line += grid;
  }
  return state;
}

}  // namespace

PhaseState integrate(const MotorConditions& conditions, const Field& field, const PhaseState& state, Tick begin,
                     Tick end, Tick grid) {
  const Load& load = *conditions.load;
  const Equations equations(conditions, field);
  PhaseState first = state;
  if (!field.coil_a_connected) first.current_a = 0;
  if (!field.coil_b_connected) first.current_b = 0;
  if (load.jammed) first.velocity = 0;
  // Most spans lie far from the ends. What is beyond the reach of the rotor changes nothing and need not be asked for.
  const double seconds = seconds_of(end - begin);
  const double strongest = 2 * conditions.motor->torque_constant() *
                               std::max(field.amplitude, std::fabs(state.current_a) + std::fabs(state.current_b)) +
                           conditions.motor->detent_torque + std::fabs(load.torque);
  const double reach =
      seconds * (std::fabs(first.velocity) + std::fabs(field.velocity) +
                 seconds * (std::fabs(field.acceleration) + strongest * equations.acceleration_per_torque()));
  const bool place_dependent =
      load.spring != 0 || first.angle - reach < load.lowest_angle || first.angle + reach > load.highest_angle;
  const auto integrate_here = field.energised
                                  ? (place_dependent ? integrate_as<true, true> : integrate_as<true, false>)
                                  : (place_dependent ? integrate_as<false, true> : integrate_as<false, false>);
  return integrate_here(equations, field, first, begin, end, grid, load.jammed);
}

double field_torque(const MotorData& motor, const PhaseState& state) {
  const Phasor rotor = unit_phasor(state.angle);
  return motor.torque_constant() * (state.current_b * rotor.along - state.current_a * rotor.across);
}

double detent_torque(const MotorData& motor, double angle) {
  return -motor.detent_torque * unit_phasor(4 * angle).across;
}

double load_torque(const MotorConditions& conditions, double angle) {
  const Load& load = *conditions.load;
  double torque = load.torque + load.spring * shaft_radians * (angle - load.spring_centre);
  const double stiffness = end_stiffness(conditions) * shaft_radians;
  if (angle < load.lowest_angle) torque -= stiffness * (load.lowest_angle - angle);
  if (angle > load.highest_angle) torque += stiffness * (angle - load.highest_angle);
  return torque;
}

CoilCurrents ideal_currents(const Field& field, double angle) {
  if (!field.energised) return {0, 0};
  const Phasor direction = unit_phasor(angle);
  return {field.coil_a_connected ? field.amplitude * direction.along : 0,
          field.coil_b_connected ? field.amplitude * direction.across : 0};
}

}  // namespace opentmcl::twin
