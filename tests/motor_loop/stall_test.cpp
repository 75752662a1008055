// Stop on stall (parameters 181, 173 and 174) with a motor that really stalls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/motor_loop/motor_bench.hpp"
#include "twin/chip/tmc262_choices.hpp"

namespace opentmcl::tests {
namespace {

class StopOnStall : public testing::TestWithParam<ModuleId> {
 protected:
  const ModuleDescription& description() const { return modules[static_cast<std::size_t>(GetParam())]; }

  /// As one tunes it at the bench: what reads this share of the value without load with threshold 0 becomes 0.
  static void tune(MotorBench& bench, double share) {
    bench.set(AxisParameter::stall_guard_filter, 0);
    bench.set(AxisParameter::stall_guard_threshold, 0);
    bench.wait_ms(200);
    const double unloaded = bench.get(AxisParameter::actual_load_value);
    bench.set(AxisParameter::stall_guard_threshold,
              -static_cast<std::int32_t>(share * unloaded / twin::tmc262_choices::stall_guard_threshold_weight));
  }

  struct Stop {
    std::int32_t stall_position = 0;  ///< microsteps, where stallGuard2 first read 0
    bool seen = false;
  };
  /// A brake takes hold, 0.3 N m more each second, until the motor has been stopped or `limit` has passed.
  static Stop brake(MotorBench& bench, Microseconds limit) {
    constexpr Microseconds look = 50;
    Stop stop;
    double torque = 0;
    for (Microseconds passed = 0; passed < limit; passed += look) {
      if (passed % one_millisecond == 0) {
        torque += 0.3e-3;
        bench.set_brake(torque);
      }
      bench.wait(look);
      if (!stop.seen && bench.driver().stall_guard_output()) {
        stop = {bench.position_at_once(), true};
        limit = std::min(limit, passed + 50 * one_millisecond);
      }
    }
    return stop;
  }
};

INSTANTIATE_TEST_SUITE_P(Both, StopOnStall, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161), name_of_module);

TEST_P(StopOnStall, StopsWithinAFullStepAfterStallGuardReadsZero) {
  for (const double rpm : {100.0, -150.0, 200.0, -250.0, 286.0, 400.0, -580.0}) {
    SCOPED_TRACE(rpm);
    MotorBench bench(description());
    bench.rotate(rpm);
    tune(bench, 0.2);
    bench.set(AxisParameter::stop_on_stall, velocity_of(80));
    bench.wait_ms(300);
    ASSERT_EQ(std::abs(bench.speed()), velocity_of(std::fabs(rpm))) << "not without a reason";
    const Stop stop = brake(bench, 3'000 * one_millisecond);
    ASSERT_TRUE(stop.seen);
    EXPECT_EQ(bench.speed(), 0);
    EXPECT_EQ(bench.get(AxisParameter::extended_error_flags), flag_of(AxisEvent::stall));
    // The firmware looks every millisecond: above 300 rpm that is more than a full step.
    const double way_between_looks = std::fabs(rpm) / 60.0 * turn / 1000.0;
    EXPECT_LE(std::abs(bench.position_at_once() - stop.stall_position),
              std::max(static_cast<double>(full_step), way_between_looks));
    EXPECT_LT(std::fabs(bench.full_steps_lost()), 2.0) << "in time: no step is lost";
    EXPECT_NEAR(bench.motor().state().velocity, 0.0, 1e-3) << "and the shaft stands";
  }
}

TEST_P(StopOnStall, StopsEveryMotorOfTheTable) {
  for (const twin::MotorData& motor : twin::motors()) {
    SCOPED_TRACE(std::string(motor.name));
    VirtualModule::Options options = free_shaft();
    options.motor = motor;
    MotorBench bench(description(), options);
    bench.rotate(200);
    tune(bench, 0.2);
    bench.set(AxisParameter::stop_on_stall, velocity_of(80));
    const Stop stop = brake(bench, 12'000 * one_millisecond);
    ASSERT_TRUE(stop.seen);
    EXPECT_EQ(bench.speed(), 0);
    EXPECT_LE(std::abs(bench.position_at_once() - stop.stall_position), full_step);
    EXPECT_LT(std::fabs(bench.full_steps_lost()), 2.0);
  }
}

TEST_P(StopOnStall, NeverStopsAnUnloadedMotorAtAnyUsableSpeed) {
  MotorBench bench(description());
  bench.rotate(100);
  tune(bench, 0.2);
  // Above the speed at which the detent shakes the rotor at half its natural frequency: 107 rpm with this inertia. On
  // the way through it the load angle swings so far that a stall is measured.
  bench.set(AxisParameter::stop_on_stall, velocity_of(125));
  for (int rpm = 130; rpm <= 580; rpm += 10) {
    SCOPED_TRACE(rpm);
    for (const int way : {rpm, -rpm}) {
      bench.rotate(way);
      bench.wait_ms(200);
      EXPECT_EQ(std::abs(bench.speed()), velocity_of(rpm));
    }
  }
  EXPECT_EQ(bench.get(AxisParameter::extended_error_flags), 0);
  EXPECT_LT(std::fabs(bench.full_steps_lost()), 1.0);
}

TEST_P(StopOnStall, StopsAMotorThatJamsAtOnce) {
  MotorBench bench(description());
  bench.rotate(250);
  tune(bench, 0.2);
  bench.set(AxisParameter::stop_on_stall, velocity_of(80));
  bench.wait_ms(20);  // from now on the firmware looks every millisecond
  const std::int32_t jammed_at = bench.position_at_once();
  bench.jam();
  bench.wait_ms(50);
  EXPECT_EQ(bench.speed(), 0);
  EXPECT_EQ(bench.get(AxisParameter::extended_error_flags), flag_of(AxisEvent::stall));
  // A full step until the next measurement, twice 0.8 until the motor model and then the firmware have looked.
  EXPECT_LE(bench.position_at_once() - jammed_at, 3 * full_step);
}

TEST_P(StopOnStall, MissesTheStallWithTooHighAThresholdAndTheEncoderShowsTheLostSteps) {
  MotorBench bench(description());
  bench.set(AxisParameter::stall_guard_threshold, 40);
  bench.set(AxisParameter::stop_on_stall, velocity_of(80));
  bench.rotate(250);
  bench.set_brake(1.2 * holding_torque());
  bench.wait_ms(500);
  EXPECT_EQ(bench.speed(), velocity_of(250)) << "it believes to turn";
  EXPECT_EQ(bench.get(AxisParameter::extended_error_flags), 0);
  EXPECT_GT(bench.position() - bench.get(AxisParameter::encoder_position), 100 * full_step);
}

TEST_P(StopOnStall, LeavesAMotorAloneBelowItsSpeed) {
  MotorBench bench(description());
  bench.rotate(150);
  tune(bench, 0.2);
  bench.set(AxisParameter::stop_on_stall, velocity_of(150));
  bench.set_brake(1.2 * holding_torque());
  bench.wait_ms(500);
  EXPECT_EQ(bench.speed(), velocity_of(150));
  EXPECT_GT(bench.full_steps_lost(), 100.0);
}

}  // namespace
}  // namespace opentmcl::tests
