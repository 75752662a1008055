#include "twin/physics/motor_shaft.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "twin/physics/elementary.hpp"

namespace opentmcl::twin {
namespace {

constexpr Tick grid = 20 * ticks_per_microsecond;
constexpr double turns_per_second_and_rpm = MotorData::pole_pairs / 60;
constexpr double degrees_per_turn = 360;

/// A shaft and the field that turns it, moved on as the world does it.
class Bench {
 public:
  explicit Bench(const char* motor = "QSH5718-41-28-055")
      : shaft(*find_motor(motor), std::make_shared<TorqueTables>()) {
    load.inertia = 1e-5;
    shaft.set_load(load);
    field.energised = true;
    field.amplitude = shaft.motor().rated_amplitude();
  }

  void set_torque(double torque) {
    load.torque = torque;
    shaft.set_load(load);
  }

  void advance(Tick span) {
    shaft.advance_to(shaft.now() + span, field);
    const double seconds = static_cast<double>(span) * seconds_per_tick;
    field.angle = field.angle_after(seconds);
    field.velocity = field.velocity_after(seconds);
  }

  void run(double seconds) {
    const auto ticks = static_cast<Tick>(std::llround(seconds / seconds_per_tick));
    for (const Tick end = shaft.now() + ticks; shaft.now() < end;)
      advance(std::min(shaft.longest_span(field), end - shaft.now()));
  }

  void accelerate_to(double rpm, double seconds) {
    field.acceleration = (rpm * turns_per_second_and_rpm - field.velocity) / seconds;
    run(seconds);
    field.acceleration = 0;
    field.velocity = rpm * turns_per_second_and_rpm;
  }

  /// Electrical turns.
  double lead() const { return field.angle - shaft.state().angle; }

  MotorShaft shaft;
  Load load;
  Field field;
};

// ---- Locked

TEST(MotorShaft, FollowsTheFieldWithTheLoadAngle) {
  Bench bench;
  bench.set_torque(0.1);
  bench.accelerate_to(286, 0.5);
  bench.run(1);
  EXPECT_EQ(bench.shaft.regime(), Regime::locked);
  // Load, bearings and 30 rad/s of viscous friction over the holding torque.
  const double torque = 0.1 + 0.008 + 2e-4 * 286 / 60 * radians_per_turn;
  EXPECT_NEAR(bench.lead() * degrees_per_turn, std::asin(torque / 0.55) * 180 / M_PI, 0.01);
  EXPECT_NEAR(bench.shaft.effort().torque, torque, 1e-9);
  EXPECT_NEAR(bench.shaft.effort().pull_out_torque, 0.55, 1e-4);
  EXPECT_NEAR(bench.shaft.effort().back_emf, 0.1389 * 29.95, 0.01);
}

TEST(MotorShaft, LagsTheOtherWayRoundBackwards) {
  Bench bench;
  bench.accelerate_to(-286, 0.5);
  bench.run(1);
  EXPECT_NEAR(bench.lead() * degrees_per_turn, -std::asin(0.014 / 0.55) * 180 / M_PI, 0.01);
}

// Neither angle nor speed jump when the load does; the rotor swings to its new place.
TEST(MotorShaft, SwingsToANewLoadAngle) {
  Bench bench;
  bench.accelerate_to(286, 0.5);
  bench.run(0.5);
  const MotorShaft::State before = bench.shaft.state();
  bench.set_torque(0.07);
  bench.advance(2);
  EXPECT_NEAR(bench.shaft.state().angle, before.angle + before.velocity * 2 * seconds_per_tick, 1e-9);
  EXPECT_NEAR(bench.shaft.state().velocity, before.velocity, 1e-2);
  double most = 0;
  for (int i = 0; i < 20; ++i) {
    bench.advance(ticks_per_millisecond);
    most = std::max(most, bench.lead());
  }
  EXPECT_EQ(bench.shaft.regime(), Regime::locked);
  const double end = std::asin(0.084 / 0.55) / radians_per_turn;
  EXPECT_GT(most, 1.4 * end);  // overshoots
  bench.run(1);
  EXPECT_NEAR(bench.lead(), end, 1e-5);
}

TEST(MotorShaft, TakesShorterSpansTheMoreHappens) {
  Bench bench;
  bench.run(0.1);
  EXPECT_EQ(bench.shaft.longest_span(bench.field), 1000 * ticks_per_millisecond);
  bench.field.acceleration = 100;
  EXPECT_EQ(bench.shaft.longest_span(bench.field), 2 * ticks_per_millisecond);
  bench.run(0.3);
  bench.field.acceleration = 0;
  EXPECT_EQ(bench.shaft.longest_span(bench.field), 10 * ticks_per_millisecond);
  bench.field.coil_a_connected = false;
  EXPECT_EQ(bench.shaft.longest_span(bench.field), ticks_per_millisecond);
}

// ---- At rest

TEST(MotorShaft, ComesToRestAndStaysThere) {
  Bench bench;
  bench.accelerate_to(60, 0.1);
  bench.run(0.5);
  EXPECT_FALSE(bench.shaft.at_rest(bench.field));
  bench.accelerate_to(0, 0.1);
  bench.run(0.2);
  ASSERT_TRUE(bench.shaft.at_rest(bench.field));
  EXPECT_EQ(bench.shaft.regime(), Regime::locked);
  const MotorShaft::State rest = bench.shaft.state();
  EXPECT_EQ(rest.velocity, 0);
  EXPECT_LT(std::fabs(bench.lead()), 0.008 / 0.5 / radians_per_turn + 0.01);
  bench.advance(3600 * 1000 * ticks_per_millisecond);
  EXPECT_EQ(bench.shaft.state().angle, rest.angle);
}

// With the field standing, the closed form of half swings against friction and the integrator agree.
TEST(MotorShaft, SettlesAsTheIntegratorDoes) {
  Bench closed;
  Bench integrated;
  integrated.shaft.set_always_free(true);
  for (Bench* bench : {&closed, &integrated}) {
    bench->run(0.01);
    bench->field.angle = 0.02;
  }
  for (int i = 0; i < 200; ++i) {
    closed.advance(ticks_per_millisecond / 4);
    integrated.advance(ticks_per_millisecond / 4);
    ASSERT_EQ(closed.shaft.regime(), Regime::locked);
    // A swing of 7 degrees stays within a few tenths of one.
    EXPECT_NEAR(closed.lead() * degrees_per_turn, integrated.lead() * degrees_per_turn, 0.7) << i;
  }
  EXPECT_TRUE(closed.shaft.at_rest(closed.field));
  EXPECT_TRUE(integrated.shaft.at_rest(integrated.field));
}

TEST(MotorShaft, RestsInItsDetentWithTheBridgesOff) {
  Bench bench;
  bench.run(0.1);
  bench.field.energised = false;
  bench.field.amplitude = 0;
  bench.run(0.5);
  EXPECT_TRUE(bench.shaft.at_rest(bench.field));
  EXPECT_NEAR(bench.shaft.state().angle, 0, 0.02);
  EXPECT_EQ(bench.shaft.currents(bench.field).a, 0);
  // A load that the detent cannot hold turns it.
  bench.set_torque(0.1);
  EXPECT_FALSE(bench.shaft.at_rest(bench.field));
  bench.run(0.1);
  EXPECT_LT(bench.shaft.state().angle, -1);
}

TEST(MotorShaft, ComesToRestOnLittleCurrentToo) {
  Bench bench;
  bench.run(0.1);
  bench.field.amplitude /= 32;  // less than the detent
  bench.field.angle = 0.1;
  bench.run(1);
  EXPECT_EQ(bench.shaft.regime(), Regime::free);
  EXPECT_TRUE(bench.shaft.at_rest(bench.field));
}

// ---- Leaving and finding the field

TEST(MotorShaft, LosesWholeElectricalTurnsInAStall) {
  Bench bench;
  bench.accelerate_to(200, 0.3);
  bench.run(0.2);
  bench.set_torque(0.7);
  bench.run(0.03);
  EXPECT_NE(bench.shaft.regime(), Regime::locked);
  bench.set_torque(0);
  bench.accelerate_to(20, 0.1);
  bench.run(1);
  EXPECT_EQ(bench.shaft.regime(), Regime::locked);
  const double lost = bench.lead() - std::asin(0.0084 / 0.55) / radians_per_turn;
  EXPECT_GE(std::fabs(lost), 0.9);
  EXPECT_NEAR(lost, std::nearbyint(lost), 0.02);
}

TEST(MotorShaft, SlipsWhenTheFieldRunsAway) {
  Bench bench;
  bench.load.coulomb_friction = 0.1;
  bench.shaft.set_load(bench.load);
  bench.run(0.1);
  bench.field.velocity = 600;  // no rotor starts so fast
  bench.run(0.1);
  EXPECT_EQ(bench.shaft.regime(), Regime::slipping);
  EXPECT_GT(bench.lead(), 10);
  bench.field.velocity = 0;
  bench.run(0.3);
  EXPECT_EQ(bench.shaft.regime(), Regime::locked);
  EXPECT_TRUE(bench.shaft.at_rest(bench.field));
}

TEST(MotorShaft, IsIntegratedNearItsDetentResonances) {
  const auto regime_at = [](double share_of_natural_frequency) {
    Bench bench;
    const double natural = std::sqrt(50 * 0.55 / 2.2e-5) / radians_per_turn;
    bench.accelerate_to(share_of_natural_frequency * natural / turns_per_second_and_rpm, 0.5);
    bench.run(1);
    return bench.shaft.regime();
  };
  EXPECT_EQ(regime_at(0.15), Regime::locked);
  EXPECT_EQ(regime_at(0.25), Regime::free);
  EXPECT_EQ(regime_at(0.36), Regime::locked);
  EXPECT_EQ(regime_at(0.5), Regime::free);
  EXPECT_EQ(regime_at(0.8), Regime::locked);
}

TEST(MotorShaft, IsIntegratedInFullSteps) {
  Bench bench;
  bench.run(0.01);
  const Field::Step step{bench.shaft.now() + 100, 0.25};
  bench.field.steps = {&step, 1};
  bench.advance(ticks_per_millisecond);
  EXPECT_EQ(bench.shaft.regime(), Regime::free);
  bench.field.steps = {};
  bench.field.angle = 0.25;
  bench.run(0.5);
  EXPECT_TRUE(bench.shaft.at_rest(bench.field));
  EXPECT_NEAR(bench.shaft.state().angle, 0.25, 0.005);
}

// Beyond the voltage limit an even motion settles, and is then as fast to compute as any other; what is said of it
// stays what the integrator says.
TEST(MotorShaft, KeepsTheLeadOfASettledMotionBeyondTheVoltageLimit) {
  Bench fast("QSH5718-41-28-055");
  Bench full("QSH5718-41-28-055");
  full.shaft.set_always_free(true);
  for (Bench* bench : {&fast, &full}) {
    bench->set_torque(0.05);
    bench->accelerate_to(1144, 0.5);
    bench->run(1);
  }
  EXPECT_EQ(fast.shaft.regime(), Regime::locked);
  EXPECT_NEAR(fast.lead() * degrees_per_turn, full.lead() * degrees_per_turn, 0.5);
  for (Bench* bench : {&fast, &full}) {
    bench->set_torque(0.15);
    bench->run(0.02);
  }
  EXPECT_EQ(fast.shaft.regime(), Regime::free);
  EXPECT_NEAR(fast.lead() * degrees_per_turn, full.lead() * degrees_per_turn, 2);
}

// What was measured under other conditions does not come back with them: the rotor has moved on since.
TEST(MotorShaft, DoesNotJumpWhenTheSupplyComesBack) {
  Bench bench;
  bench.set_torque(0.05);
  bench.accelerate_to(1144, 0.5);
  bench.run(1);
  ASSERT_EQ(bench.shaft.regime(), Regime::locked);
  for (const double supply : {60.0, 24.0}) {
    const MotorShaft::State before = bench.shaft.state();
    bench.shaft.set_supply(supply);
    bench.advance(2);
    EXPECT_NEAR(bench.shaft.state().angle, before.angle + before.velocity * 2 * seconds_per_tick, 1e-5) << supply;
    bench.run(0.5);
    ASSERT_EQ(bench.shaft.regime(), Regime::locked);
  }
}

TEST(MotorShaft, AnEndCostsSteps) {
  Bench bench;
  bench.load.highest_angle = 5;
  bench.shaft.set_load(bench.load);
  bench.accelerate_to(30, 0.1);
  bench.run(1);
  EXPECT_LT(bench.shaft.state().angle, 5.1);
  EXPECT_GT(bench.lead(), 5);
  bench.accelerate_to(0, 0.05);
  bench.run(0.5);
  EXPECT_TRUE(bench.shaft.at_rest(bench.field));
  bench.accelerate_to(-30, 0.1);
  bench.run(0.5);
  EXPECT_EQ(bench.shaft.regime(), Regime::locked);
  EXPECT_GT(bench.lead(), 3);
}

TEST(MotorShaft, AJammedShaftStandsAndGoesOnWhenItIsFree) {
  Bench bench;
  bench.accelerate_to(30, 0.1);
  bench.run(0.3);
  bench.load.jammed = true;
  bench.shaft.set_load(bench.load);
  const double place = bench.shaft.state().angle;
  bench.run(0.5);
  EXPECT_EQ(bench.shaft.state().angle, place);
  bench.load.jammed = false;
  bench.shaft.set_load(bench.load);
  bench.run(0.5);
  EXPECT_EQ(bench.shaft.regime(), Regime::locked);
  EXPECT_GT(bench.lead(), 10);
}

TEST(MotorShaft, ASpringIsWoundUp) {
  Bench bench;
  bench.load.spring = 0.02;  // N m per rad
  bench.shaft.set_load(bench.load);
  bench.accelerate_to(40, 0.1);
  bench.run(1);
  bench.accelerate_to(0, 0.1);
  bench.run(0.5);
  ASSERT_TRUE(bench.shaft.at_rest(bench.field));
  const double turned = bench.shaft.state().angle / MotorData::pole_pairs * radians_per_turn;
  EXPECT_NEAR(bench.lead() * radians_per_turn, std::asin(0.02 * turned / 0.55), 0.06);
}

// ---- Looking and cutting

struct RandomSpan {
  Field field;
  Load load;
  Tick span;
};

RandomSpan arbitrary_span(const Bench& bench) {
  RandomSpan result{bench.field, bench.load, 0};
  result.field.energised = *rc::gen::inRange(0, 10) != 0;
  result.field.coil_a_connected = *rc::gen::inRange(0, 20) != 0;
  result.field.amplitude = *rc::gen::inRange(0, 400) * 1e-2;
  const int kind = *rc::gen::inRange(0, 4);
  result.field.velocity = kind == 0 ? 0 : *rc::gen::inRange(-1000, 1000);
  result.field.acceleration = kind == 1 ? *rc::gen::inRange(-3000, 3000) : 0;
  result.load.torque = *rc::gen::inRange(-60, 60) * 1e-2;
  result.load.jammed = *rc::gen::inRange(0, 20) == 0;
  result.span = static_cast<Tick>(*rc::gen::inRange(1, 500)) * grid;
  return result;
}

RC_GTEST_PROP(MotorShaft, LookingAheadGivesWhatWillBeAndChangesNothing, ()) {
  Bench bench;
  const int spans = *rc::gen::inRange(1, 12);
  for (int i = 0; i < spans; ++i) {
    const RandomSpan random = arbitrary_span(bench);
    bench.shaft.set_load(random.load);
    const double angle = bench.field.angle;
    bench.field = random.field;
    bench.field.angle = angle;
    const MotorShaft::Memory before = bench.shaft.memory();
    bench.shaft.state_at(bench.shaft.now() + random.span / 3, bench.field);
    const MotorShaft::State looked = bench.shaft.state_at(bench.shaft.now() + random.span, bench.field);
    RC_ASSERT(bench.shaft.memory() == before);
    bench.advance(random.span);
    RC_ASSERT(bench.shaft.state().angle == looked.angle);
    RC_ASSERT(bench.shaft.state().velocity == looked.velocity);
  }
}

// A shaft that shares its tables with others, or goes on from a snapshot, gives the same to the last bit.
RC_GTEST_PROP(MotorShaft, DependsOnNothingButItsOwnPast, ()) {
  Bench bench;
  const auto used = std::make_shared<TorqueTables>();
  MotorShaft other(bench.shaft.motor(), used);
  const int spans = *rc::gen::inRange(1, 12);
  for (int i = 0; i < spans; ++i) {
    const RandomSpan random = arbitrary_span(bench);
    used->table(other.motor(), TorqueTables::key(24, random.field.amplitude, 25))->pull_out_torque(1234);
    MotorShaft restored(bench.shaft.motor(), used);
    restored.restore(bench.shaft.memory());
    const double angle = bench.field.angle;
    bench.field = random.field;
    bench.field.angle = angle;
    for (MotorShaft* shaft : {&bench.shaft, &other, &restored}) shaft->set_load(random.load);
    restored.advance_to(restored.now() + random.span, bench.field);
    other.advance_to(other.now() + random.span, bench.field);
    bench.advance(random.span);
    RC_ASSERT(other.memory() == bench.shaft.memory());
    RC_ASSERT(restored.memory() == bench.shaft.memory());
  }
}

// The locked rotor is a closed form: where time is cut matters only to the last digits.
RC_GTEST_PROP(MotorShaft, ALockedRotorGoesOnWhereItWasCut, ()) {
  Bench bench;
  const double velocity = *rc::gen::inRange(-35, 35);
  bench.accelerate_to(velocity / turns_per_second_and_rpm, 0.2);
  bench.set_torque(*rc::gen::inRange(-3, 4) * 1e-2);
  Bench cut = bench;
  const Tick span = static_cast<Tick>(*rc::gen::inRange(2, 500)) * grid;
  const Tick first = static_cast<Tick>(*rc::gen::inRange(1, 499)) * grid % span;
  bench.advance(span);
  if (first > 0) cut.advance(first);
  cut.advance(span - first);
  RC_ASSERT(bench.shaft.regime() == Regime::locked);
  RC_ASSERT(std::fabs(cut.shaft.state().angle - bench.shaft.state().angle) < 1e-8);
  RC_ASSERT(std::fabs(cut.shaft.state().velocity - bench.shaft.state().velocity) < 1e-5);
}

// ---- What is measured

TEST(MotorShaft, StallGuardFallsEvenlyToNothingAtTheHighestLoad) {
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    Bench bench;
    bench.accelerate_to(286, 0.5);
    const double torque = share * 0.55 - 0.008 - 2e-4 * 286 / 60 * radians_per_turn;
    for (int part = 1; part <= 10; ++part) {
      bench.set_torque(torque * part / 10);
      bench.run(0.2);
    }
    EXPECT_NEAR(bench.shaft.stall_guard_measurement(), 531 * (1 - share), 4) << share;
  }
}

TEST(MotorShaft, StallGuardIsLowAtAStandstillAndInAStall) {
  Bench bench;
  bench.run(0.1);
  EXPECT_EQ(bench.shaft.stall_guard_measurement(), 0);
  bench.load.jammed = true;
  bench.shaft.set_load(bench.load);
  bench.field.velocity = 238;
  bench.run(0.1);
  EXPECT_EQ(bench.shaft.stall_guard_measurement(), 0);
}

TEST(MotorShaft, TheWindingWarmsToItsRatedRise) {
  Bench bench;
  bench.run(0.1);
  EXPECT_NEAR(bench.shaft.winding_temperature(), 25, 0.1);
  // Half of the way after the time constant's ln 2 or a little later, since a cold winding has less resistance.
  bench.advance(915 * 1000 * ticks_per_millisecond);
  EXPECT_NEAR(bench.shaft.winding_temperature(), 60, 8);
  for (int hour = 0; hour < 5; ++hour) bench.advance(3600 * 1000 * ticks_per_millisecond);
  EXPECT_NEAR(bench.shaft.winding_temperature(), 105, 0.5);
  bench.field.amplitude /= 2;
  for (int hour = 0; hour < 5; ++hour) bench.advance(3600 * 1000 * ticks_per_millisecond);
  EXPECT_NEAR(bench.shaft.winding_temperature(), 25 + 80 / 4.0, 4);
}

TEST(MotorShaft, AWarmMotorStallsEarlierWhereTheVoltageIsTheLimit) {
  const auto pull_out = [](double celsius) {
    Bench bench("QSH6018-86-28-310");
    MotorShaft::Memory memory = bench.shaft.memory();
    memory.winding_temperature = celsius;
    bench.shaft.restore(memory);
    bench.accelerate_to(300, 0.5);
    return bench.shaft.effort().pull_out_torque;
  };
  EXPECT_LT(pull_out(120), 0.99 * pull_out(20));
}

TEST(MotorShaft, ShowsTheCurrentsOfItsCoils) {
  Bench bench;
  bench.field.angle = 0.125;
  bench.run(0.2);
  const MotorShaft::Currents currents = bench.shaft.currents(bench.field);
  EXPECT_NEAR(currents.a, bench.field.amplitude / std::numbers::sqrt2, 1e-3);
  EXPECT_NEAR(currents.b, bench.field.amplitude / std::numbers::sqrt2, 1e-3);
}

}  // namespace
}  // namespace opentmcl::twin
