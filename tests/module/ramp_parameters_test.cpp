// The parameters of the ramp generator that the other tests of motion leave alone: 2, 13, 12, 130, 138, 149, 153, 154.
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

class RampParameters : public testing::TestWithParam<ModuleId> {
 protected:
  void wait_ms(unsigned milliseconds) { bench.wait(milliseconds * one_millisecond); }
  std::int32_t speed() { return bench.get(AxisParameter::actual_speed); }

  Bench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, RampParameters, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(RampParameters, ModeIsSetByMotionCommands) {
  for (const auto& [opcode, mode] :
       {std::pair{Opcode::ror, 2}, {Opcode::mvp, 0}, {Opcode::rol, 2}, {Opcode::mvp, 0}, {Opcode::mst, 2}}) {
    bench.command(opcode);
    EXPECT_EQ(bench.get(AxisParameter::ramp_mode), mode) << static_cast<int>(opcode);
  }
}

TEST_P(RampParameters, SoftModeApproachesTheTargetExponentiallyAndReachesIt) {
  bench.set(AxisParameter::maximum_acceleration, 100);
  std::int64_t time[2];
  for (const std::int32_t mode : {0, 1}) {
    bench.set(AxisParameter::ramp_mode, mode);
    bench.set(AxisParameter::target_position, mode == 0 ? 20'000 : 0);
    bench.wait(one_millisecond);
    time[mode] = static_cast<std::int64_t>(bench.wait_until_reached(60'000 * one_millisecond));
    EXPECT_EQ(bench.get(AxisParameter::ramp_mode), mode);
  }
  EXPECT_GT(time[1], time[0] * 3 / 2) << "slower towards the end than on a linear ramp";
}

TEST_P(RampParameters, TargetSpeedChangesTheSpeedInVelocityMode) {
  bench.command(Opcode::ror, 0, 0, 300);
  wait_ms(500);
  bench.set(AxisParameter::target_speed, -400);
  wait_ms(1'000);
  EXPECT_EQ(speed(), -400);
  EXPECT_EQ(bench.get(AxisParameter::target_speed), -400);
}

TEST_P(RampParameters, MinimumSpeedEndsARampEarlier) {
  bench.set(AxisParameter::maximum_acceleration, 20);
  const auto speed_near_the_target = [this](std::int32_t minimum, std::int32_t target) {
    bench.set(AxisParameter::minimum_speed, minimum);
    bench.command(Opcode::mvp, 0, 0, target);
    std::int32_t last = 0;
    while (bench.get(AxisParameter::position_reached) == 0) last = speed();
    return last;
  };
  EXPECT_LT(speed_near_the_target(1, 30'000), 100);
  EXPECT_GE(speed_near_the_target(300, 60'000), 300);
}

TEST_P(RampParameters, LimitSwitchesStopOnlyWhenEnabledEachForItself) {
  bench.module.world().set_left_switch(true);
  bench.module.world().set_right_switch(true);
  for (const bool left_off : {false, true}) {
    for (const bool right_off : {false, true}) {
      bench.set(AxisParameter::left_limit_switch_disable, left_off ? 1 : 0);
      bench.set(AxisParameter::right_limit_switch_disable, right_off ? 1 : 0);
      bench.command(Opcode::rol, 0, 0, 300);
      wait_ms(300);
      EXPECT_EQ(speed(), left_off ? -300 : 0);
      bench.command(Opcode::ror, 0, 0, 300);
      wait_ms(600);
      EXPECT_EQ(speed(), right_off ? 300 : 0);
      bench.command(Opcode::mst);
      wait_ms(300);
    }
  }
}

TEST_P(RampParameters, SoftStopBrakesAtALimitSwitchAlongTheRamp) {
  bench.set(AxisParameter::maximum_acceleration, 20);
  bench.set(AxisParameter::right_limit_switch_disable, 0);
  for (const bool soft : {false, true}) {
    bench.set(AxisParameter::soft_stop, soft ? 1 : 0);
    bench.command(Opcode::ror, 0, 0, 500);
    while (speed() < 500) wait_ms(10);
    bench.module.world().set_right_switch(true);
    wait_ms(5);
    if (soft) {
      EXPECT_GT(speed(), 400);
      EXPECT_LT(speed(), 500);
      wait_ms(5'000);
    }
    EXPECT_EQ(speed(), 0);
    bench.module.world().set_right_switch(false);
    bench.command(Opcode::mst);
    wait_ms(100);
  }
}

TEST_P(RampParameters, DivisorsActAtOnceOnSpeedAndBrakingFactor) {
  bench.command(Opcode::ror, 0, 0, 500);
  wait_ms(1'000);
  const auto way = [this] {
    const std::int64_t begin = bench.module.world().rotor_angle();
    wait_ms(400);
    return static_cast<double>(bench.module.world().rotor_angle() - begin);
  };
  const double before = way();
  bench.set(AxisParameter::pulse_divisor, 4);
  EXPECT_NEAR(way(), before / 2, 2);
  // A move right after a change of the divisors lands on its target: the factor was computed anew.
  for (const auto& [ramp, pulse] : {std::pair{9, 5}, {5, 3}, {7, 7}, {4, 2}}) {
    bench.set(AxisParameter::ramp_divisor, ramp);
    bench.set(AxisParameter::pulse_divisor, pulse);
    bench.set(AxisParameter::maximum_acceleration, 100);
    const std::int32_t target = bench.get(AxisParameter::actual_position) + 5'000;
    bench.command(Opcode::mvp, 0, 0, target);
    bench.wait_until_reached(60'000 * one_millisecond);
    wait_ms(50);
    EXPECT_EQ(bench.get(AxisParameter::actual_position), target);
    EXPECT_EQ(speed(), 0);
  }
}

TEST_P(RampParameters, DoubleStepExecutesEveryMicrostepTwice) {
  bench.set(AxisParameter::double_step, 1);
  bench.command(Opcode::mvp, 0, 0, 1'000);
  bench.wait_until_reached(1'000 * one_millisecond);
  EXPECT_EQ(bench.module.world().rotor_angle(), 2'000);
}

}  // namespace
}  // namespace opentmcl::tests
