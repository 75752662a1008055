#include "twin/physics/phase_integrator.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <vector>

#include "twin/physics/elementary.hpp"

namespace opentmcl::twin {
namespace {

constexpr Tick grid = 20 * ticks_per_microsecond;
constexpr double turns_per_second_and_rpm = MotorData::pole_pairs / 60;
constexpr double degrees_per_turn = 360;

/// A motor on its own, integrated throughout.
class Bench {
 public:
  explicit Bench(const char* name = "QSH5718-41-28-055") : motor(*find_motor(name)) {
    load.inertia = 1e-5;
    field.energised = true;
    field.amplitude = motor.rated_amplitude();
  }

  MotorConditions conditions() const { return {&motor, &load, supply, motor.winding_resistance}; }

  void run(double seconds) { run_ticks(static_cast<Tick>(std::llround(seconds / seconds_per_tick))); }

  void run_ticks(Tick span) {
    for (Tick left = span; left > 0;) {
      const Tick part = std::min(left, ticks_per_millisecond);
      state = integrate(conditions(), field, state, now, now + part, step);
      now += part;
      left -= part;
      const double seconds = static_cast<double>(part) * seconds_per_tick;
      field.angle = field.angle_after(seconds);
      field.velocity = field.velocity_after(seconds);
    }
  }

  void accelerate_to(double rpm, double seconds) {
    field.acceleration = (rpm * turns_per_second_and_rpm - field.velocity) / seconds;
    run(seconds);
    field.acceleration = 0;
    field.velocity = rpm * turns_per_second_and_rpm;
  }

  /// Electrical turns.
  double lead() const { return field.angle - state.angle; }

  /// Degrees, over the milliseconds of a time.
  double mean_lead(double seconds) {
    double sum = 0;
    int count = 0;
    for (const Tick end = now + static_cast<Tick>(seconds / seconds_per_tick); now < end; ++count) {
      run_ticks(ticks_per_millisecond);
      sum += lead();
    }
    return sum / count * degrees_per_turn;
  }

  /// Raises the load evenly until the rotor is a turn behind. @return time of that, s
  double stall_time(double torque_per_second, double begin) {
    const double torque = load.torque;
    while (std::fabs(lead()) < 1 && seconds() < 10) {
      load.torque = torque + torque_per_second * (seconds() - begin + 0.5e-3);
      run_ticks(ticks_per_millisecond);
    }
    return seconds();
  }

  double seconds() const { return static_cast<double>(now) * seconds_per_tick; }

  MotorData motor;
  Load load;
  Field field;
  double supply = 24;
  PhaseState state;
  Tick now = 0;
  Tick step = grid;
};

// ---- Against figures of the prototype, whose 1 µs steps were the reference

TEST(PhaseIntegrator, LeadsByTheLoadAngleOfTheTorque) {
  Bench bench;
  bench.load.torque = 0.1;
  bench.accelerate_to(286, 0.5);
  bench.run(0.5);
  EXPECT_NEAR(bench.mean_lead(0.4), 11.9633, 0.004);
}

TEST(PhaseIntegrator, StallsWhereTheLoadPassesTheHoldingTorque) {
  Bench bench;
  bench.load.torque = 0.05;
  bench.accelerate_to(286, 0.5);
  bench.run(0.5);
  EXPECT_NEAR(bench.stall_time(0.3, 1), 2.636, 0.003);
}

TEST(PhaseIntegrator, StallsEarlierWhereTheVoltageIsTheLimit) {
  Bench bench;
  bench.load.torque = 0.05;
  bench.accelerate_to(1144, 0.5);
  bench.run(0.3);
  EXPECT_NEAR(bench.mean_lead(0.2), 55.73, 0.15);
  EXPECT_NEAR(bench.stall_time(0.15, 1), 3.432, 0.003);
}

TEST(PhaseIntegrator, TwiceTheStepChangesLittle) {
  Bench fine;
  Bench coarse;
  coarse.step = 2 * grid;
  for (Bench* bench : {&fine, &coarse}) {
    bench->load.torque = 0.05;
    bench->accelerate_to(1144, 0.5);
    bench->run(0.3);
  }
  EXPECT_NEAR(fine.mean_lead(0.2), coarse.mean_lead(0.2), 0.5);
}

// Pull-out torque at the shaft that 20 µs steps of the prototype gave, N m.
TEST(PhaseIntegrator, HasThePullOutTorqueOverSpeed) {
  struct Row {
    double rpm;
    double torque;
  };
  for (const auto& [rpm, torque] : {Row{200, 0.540}, {600, 0.532}, {1000, 0.459}, {1500, 0.319}, {2000, 0.224}}) {
    Bench bench;
    bench.accelerate_to(rpm, 1);
    bench.run(0.1);
    bench.stall_time(0.2, bench.seconds());
    EXPECT_NEAR(bench.load.torque, torque, 0.02 * torque + 0.004) << rpm << " rpm";
  }
}

// ---- Against an independent integrator

/// The equations once more, written down from the physics in SI units.
TEST(PhaseIntegrator, AgreesWithAnAdaptiveIntegratorOfBoost) {
  const Bench bench;
  const MotorData& m = bench.motor;
  const double constant = m.torque_constant();
  const double inertia = m.rotor_inertia + bench.load.inertia;
  const double amplitude = bench.field.amplitude;
  constexpr double field_speed = 100 * 2 * M_PI;  // rad/s
  constexpr double torque = 0.2;
  using State = std::array<double, 4>;  // shaft angle and speed, currents
  const auto rates = [&](const State& x, State& rate, double t) {
    const double angle = 50 * x[0];
    const double emf_a = -constant * x[1] * std::sin(angle);
    const double emf_b = constant * x[1] * std::cos(angle);
    const auto voltage = [&](double wanted, double wanted_rate, double current, double emf) {
      const double u = (wanted - current) * m.winding_inductance / 28e-6 + m.winding_resistance * current + emf +
                       m.winding_inductance * wanted_rate;
      return std::clamp(u, -24.0, 24.0);
    };
    const double phase = field_speed * t;
    const double u_a = voltage(amplitude * std::cos(phase), -amplitude * field_speed * std::sin(phase), x[2], emf_a);
    const double u_b = voltage(amplitude * std::sin(phase), amplitude * field_speed * std::cos(phase), x[3], emf_b);
    rate[0] = x[1];
    rate[1] = (constant * (x[3] * std::cos(angle) - x[2] * std::sin(angle)) - m.detent_torque * std::sin(4 * angle) -
               m.viscous_friction * x[1] - m.eddy_damping * (x[1] - field_speed / 50) -
               std::copysign(m.coulomb_friction, x[1]) - torque) /
              inertia;
    rate[2] = (u_a - m.winding_resistance * x[2] - emf_a) / m.winding_inductance;
    rate[3] = (u_b - m.winding_resistance * x[3] - emf_b) / m.winding_inductance;
  };
  State reference{0, field_speed / 50, amplitude, 0};
  namespace odeint = boost::numeric::odeint;
  odeint::integrate_adaptive(odeint::make_controlled<odeint::runge_kutta_dopri5<State>>(1e-10, 1e-10), rates, reference,
                             0.0, 0.05, 1e-6);

  Bench own;
  own.load.torque = torque;
  own.field.velocity = 100;
  own.state = {0, 100, amplitude, 0};
  own.run(0.05);
  EXPECT_NEAR(own.state.angle, reference[0] * 50 / (2 * M_PI), 2e-5);
  EXPECT_NEAR(own.state.velocity, reference[1] * 50 / (2 * M_PI), 0.02);
  EXPECT_NEAR(own.state.current_a, reference[2], 2e-3);
  EXPECT_NEAR(own.state.current_b, reference[3], 2e-3);
}

// ---- Cutting time

RC_GTEST_PROP(PhaseIntegrator, GoesOnWhereItWasCut, ()) {
  Bench bench;
  bench.load.torque = *rc::gen::inRange(0, 40) * 1e-2;
  bench.field.velocity = *rc::gen::inRange(-200, 200);
  bench.field.acceleration = *rc::gen::inRange(-2000, 2000);
  bench.state.velocity = bench.field.velocity;
  const auto begin = *rc::gen::inRange<Tick>(0, 1000);
  const Tick cut = (begin / grid + *rc::gen::inRange<Tick>(1, 40)) * grid;
  const Tick end = cut + *rc::gen::inRange<Tick>(1, 40 * grid);
  const PhaseState at_once = integrate(bench.conditions(), bench.field, bench.state, begin, end, grid);
  const PhaseState first = integrate(bench.conditions(), bench.field, bench.state, begin, cut, grid);
  Field rest = bench.field;
  const double seconds = static_cast<double>(cut - begin) * seconds_per_tick;
  rest.angle = bench.field.angle_after(seconds);
  rest.velocity = bench.field.velocity_after(seconds);
  const PhaseState second = integrate(bench.conditions(), rest, first, cut, end, grid);
  RC_ASSERT(std::fabs(second.angle - at_once.angle) < 1e-10);
  RC_ASSERT(std::fabs(second.velocity - at_once.velocity) < 1e-6);
  RC_ASSERT(std::fabs(second.current_a - at_once.current_a) < 1e-6);
}

RC_GTEST_PROP(PhaseIntegrator, StepsOfTheFieldActWhereverTimeIsCut, ()) {
  Bench bench;
  std::vector<Field::Step> steps;
  Tick tick = 0;
  for (int i = 1; i <= 20; ++i) {
    tick += *rc::gen::inRange<Tick>(100, 5000);
    steps.push_back({tick, 0.25 * i});
  }
  const Tick end = tick + 1000;
  bench.field.steps = steps;
  const PhaseState at_once = integrate(bench.conditions(), bench.field, bench.state, 0, end, grid);
  const Tick cut = *rc::gen::inRange<Tick>(0, end / grid) * grid;
  PhaseState state = bench.state;
  Field part = bench.field;
  const auto later =
      std::find_if(steps.begin(), steps.end(), [cut](const Field::Step& step) { return step.tick >= cut; });
  part.steps = {steps.begin(), later};
  state = integrate(bench.conditions(), part, state, 0, cut, grid);
  if (later != steps.begin()) part.angle = std::prev(later)->angle;
  part.steps = {later, steps.end()};
  state = integrate(bench.conditions(), part, state, cut, end, grid);
  RC_ASSERT(std::fabs(state.angle - at_once.angle) < 1e-9);
  RC_ASSERT(std::fabs(state.velocity - at_once.velocity) < 1e-5);
}

// ---- Energy

// What the coils put in is what friction takes out, what became heat and what the load was lifted by.
TEST(PhaseIntegrator, TurnsAsMuchPowerAsTheLoadTakes) {
  Bench bench;
  bench.load.torque = 0.25;
  bench.accelerate_to(300, 0.3);
  bench.run(0.7);
  double mean_torque = 0;
  constexpr int samples = 2000;
  for (int i = 0; i < samples; ++i) {
    bench.run_ticks(grid);
    mean_torque += field_torque(bench.motor, bench.state) / samples;
  }
  const double speed = 300.0 / 60 * radians_per_turn;
  EXPECT_NEAR(mean_torque, 0.25 + bench.motor.coulomb_friction + bench.motor.viscous_friction * speed, 2e-4);
}

TEST(PhaseIntegrator, LosesEnergyAllTheTimeWithoutCurrent) {
  Bench bench;
  bench.field.energised = false;
  bench.state.velocity = 300;
  const double inertia = bench.motor.rotor_inertia + bench.load.inertia;
  const auto energy = [&] {
    const double speed = bench.state.velocity * radians_per_turn / MotorData::pole_pairs;
    // The detent's torque -Td sin(4 Nr th) has the potential -Td / (4 Nr) cos(4 Nr th).
    return inertia * speed * speed / 2 -
           bench.motor.detent_torque / (4 * MotorData::pole_pairs) * std::cos(4 * radians_per_turn * bench.state.angle);
  };
  double before = energy();
  for (int i = 0; i < 100 && bench.state.velocity != 0; ++i) {
    bench.run_ticks(ticks_per_millisecond);
    EXPECT_LT(energy(), before);
    before = energy();
  }
  EXPECT_EQ(bench.state.velocity, 0);
}

// ---- Standing, coasting, faults

TEST(PhaseIntegrator, AShaftAtRestStaysExactlyWhereItIs) {
  Bench bench;
  bench.field.angle = 0.01;
  bench.run(1);
  EXPECT_EQ(bench.state.velocity, 0);
  const double place = bench.state.angle;
  EXPECT_NE(place, 0.01);  // friction keeps it short of the field
  EXPECT_NEAR(place, 0.01, 0.003);
  bench.run(1);
  EXPECT_EQ(bench.state.angle, place);
}

TEST(PhaseIntegrator, ComesToRestInADetentWithoutCurrent) {
  Bench bench;
  bench.field.energised = false;
  bench.state = {0.13, 100, 3, -2};
  bench.run(2);
  EXPECT_EQ(bench.state.velocity, 0);
  EXPECT_EQ(bench.state.current_a, 0);
  EXPECT_EQ(bench.state.current_b, 0);
  EXPECT_LE(std::fabs(detent_torque(bench.motor, bench.state.angle)), bench.motor.coulomb_friction);
}

TEST(PhaseIntegrator, CurrentsAreGoneAMillisecondAfterTheBridges) {
  Bench bench;
  bench.run(0.01);
  EXPECT_NEAR(bench.state.current_a, bench.field.amplitude, 0.01);
  bench.field.energised = false;
  bench.run_ticks(ticks_per_millisecond);
  EXPECT_EQ(bench.state.current_a, 0);
}

TEST(PhaseIntegrator, TurnsBackAndForthOnOneCoil) {
  Bench bench;
  bench.field.coil_b_connected = false;
  bench.field.velocity = 10;
  bench.run(0.5);
  EXPECT_EQ(bench.state.current_b, 0);
  EXPECT_GT(std::fabs(bench.lead()), 2);  // a field that only pulses does not turn a rotor from rest
}

TEST(PhaseIntegrator, AnEndStopsTheShaft) {
  Bench bench;
  bench.load.highest_angle = 3;
  bench.field.velocity = 20;
  for (int i = 0; i < 500; ++i) {
    bench.run_ticks(ticks_per_millisecond);
    // Full torque into 300 N m per rad, and what a rotor that bounces makes of it.
    EXPECT_LT(bench.state.angle, 3 + 0.1);
  }
  EXPECT_GT(bench.lead(), 2);
}

TEST(PhaseIntegrator, AJammedShaftDoesNotMove) {
  Bench bench;
  bench.field.velocity = 50;
  bench.run(0.1);
  bench.load.jammed = true;
  const double place = bench.state.angle;
  bench.run(0.1);
  EXPECT_EQ(bench.state.angle, place);
  EXPECT_EQ(bench.state.velocity, 0);
}

TEST(PhaseIntegrator, ASpringPullsTheRotorBack) {
  Bench bench;
  bench.load.spring = 2;  // N m per rad
  bench.field.angle = 0.5;
  bench.state.angle = 0.5;
  bench.run(1);
  // 0.5 electrical turns are 3.6 degrees of the shaft: 0.126 N m of 0.55 at most.
  EXPECT_NEAR(bench.lead() * degrees_per_turn, std::asin((0.126 - 0.02) / 0.55) * 180 / M_PI, 3);
}

// A load far beyond every motor tears the shaft away; it stays a number.
RC_GTEST_PROP(PhaseIntegrator, StaysFiniteUnderAnyLoad, ()) {
  Bench bench;
  bench.field.velocity = *rc::gen::inRange(-5000, 5000);
  bench.field.energised = *rc::gen::arbitrary<bool>();
  bench.load.torque = *rc::gen::inRange(-100, 100);
  bench.load.viscous_friction = *rc::gen::inRange(0, 100) * 0.1;
  bench.load.coulomb_friction = *rc::gen::inRange(0, 10);
  bench.load.spring = *rc::gen::inRange(0, 2) * 10;
  bench.load.highest_angle = *rc::gen::inRange(0, 100);
  bench.load.end_stiffness = *rc::gen::inRange(1, 100'000);
  bench.run(0.2);
  RC_ASSERT(std::isfinite(bench.state.angle));
  RC_ASSERT(std::fabs(bench.state.velocity) < 1e8);
  RC_ASSERT(std::fabs(bench.state.current_a) < 1e4);
}

// ---- Steps and resonance

TEST(PhaseIntegrator, AFullStepRingsAtTheNaturalFrequency) {
  Bench bench;
  bench.run(0.01);
  bench.field.angle = 0.25;
  // From standstill a quarter turn away the rotor swings past and back; count how often it passes the field.
  std::vector<double> passages;
  double highest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double before = bench.lead();
    bench.run_ticks(grid);
    highest = std::max(highest, bench.state.angle);
    if (before * bench.lead() < 0) passages.push_back(bench.seconds());
  }
  EXPECT_GT(highest, 0.25 * 1.5);  // little damping: it overshoots by more than half of the step
  ASSERT_GE(passages.size(), 6U);
  const double period = passages[5] - passages[3];
  // sqrt(50 * 0.55 / 2.2e-5) / 2 pi = 178 Hz for small swings; wide ones are slower.
  EXPECT_NEAR(1 / period, 172, 8);
}

/// Root mean square of the speed's ripple over the mean, at full steps a second.
double ripple(double full_steps_per_second, bool in_full_steps) {
  Bench bench;
  const double velocity = full_steps_per_second / 4;
  const auto between_steps = static_cast<Tick>(1 / full_steps_per_second / seconds_per_tick);
  double sum = 0;
  double squares = 0;
  int count = 0;
  Tick next_step = between_steps;
  if (!in_full_steps) bench.accelerate_to(full_steps_per_second / 200 * 60, 0.5);
  while (bench.seconds() < 2) {
    Field::Step step{next_step, bench.field.angle + 0.25};
    if (in_full_steps && next_step < bench.now + grid) {
      bench.field.steps = {&step, 1};
      next_step += between_steps;
    }
    bench.run_ticks(grid);
    if (!bench.field.steps.empty()) bench.field.angle = step.angle;
    bench.field.steps = {};
    if (bench.seconds() > 1) {
      sum += bench.state.velocity;
      squares += bench.state.velocity * bench.state.velocity;
      ++count;
    }
  }
  const double mean = sum / count;
  return std::sqrt(squares / count - mean * mean) / velocity;
}

// The load makes the natural frequency 178 Hz: there and at twice it (the detent modulates the stiffness) even
// microsteps shake the rotor, and full steps are lost.
TEST(PhaseIntegrator, MicrostepsCureTheResonanceOfFullSteps) {
  EXPECT_GT(ripple(25, true), 10);
  EXPECT_GT(ripple(75, true), 5);
  EXPECT_GT(ripple(178, true), 2);
  EXPECT_NEAR(ripple(60, false), 0.15, 0.02);
  EXPECT_NEAR(ripple(178, false), 0.92, 0.05);
  EXPECT_NEAR(ripple(356, false), 0.57, 0.05);
  EXPECT_NEAR(ripple(450, false), 0.02, 0.005);
}

}  // namespace
}  // namespace opentmcl::twin
