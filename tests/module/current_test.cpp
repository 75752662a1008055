// Which current the motor gets: parameters 6, 7, 150, 172, 182, 183, 200, 204, 214 and 254, seen at the driver.
#include <gtest/gtest.h>

#include <optional>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

const twin::Tmc262& driver(const Bench& bench) {
  return bench.module.world().tmc262();
}
bool cool_step_is_on(const Bench& bench) {
  return tmc262::CoolStepControl::HysteresisStart::in(driver(bench).cool_step_control()) != 0;
}

/// Currents that tell by their scale which parameter is in force.
constexpr std::int32_t run_current = 160;
constexpr std::int32_t run_scale = 20;
constexpr std::int32_t standby_current = 40;
constexpr std::int32_t standby_scale = 5;
constexpr std::int32_t special_current = 240;
constexpr std::int32_t special_scale = 30;

class MotorCurrent : public testing::TestWithParam<ModuleId> {
 protected:
  MotorCurrent() {
    bench.set(AxisParameter::maximum_current, run_current);
    bench.set(AxisParameter::standby_current, standby_current);
    bench.set(AxisParameter::power_down_delay, 10);
  }
  void wait_ms(unsigned milliseconds) { bench.wait(milliseconds * one_millisecond); }
  void stop() {
    bench.command(Opcode::mst);
    while (bench.get(AxisParameter::actual_speed) != 0) wait_ms(1);
  }

  Bench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, MotorCurrent, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(MotorCurrent, HasThirtyTwoStepsOfEight) {
  bench.command(Opcode::ror, 0, 0, 100);
  for (const auto& [setting, scale] : {std::pair{0, 0}, {7, 0}, {8, 1}, {79, 9}, {80, 10}, {128, 16}, {255, 31}}) {
    bench.set(AxisParameter::maximum_current, setting);
    EXPECT_EQ(driver(bench).current_scale(), scale) << setting;
  }
}

TEST_P(MotorCurrent, FollowsAChangeOfTheStandbyCurrentAtOnce) {
  wait_ms(500);
  EXPECT_EQ(driver(bench).current_scale(), standby_scale);
  bench.set(AxisParameter::standby_current, 80);
  EXPECT_EQ(driver(bench).current_scale(), 10);
  bench.set(AxisParameter::maximum_current, 255);
  EXPECT_EQ(driver(bench).current_scale(), 10) << "not in force at rest";
}

TEST_P(MotorCurrent, IsTheSlowRunCurrentWithoutCoolStepBelowTheThresholdSpeed) {
  bench.set(AxisParameter::smart_energy_slow_run_current, special_current);
  bench.set(AxisParameter::smart_energy_threshold_speed, 500);
  bench.set(AxisParameter::smart_energy_hysteresis_start, 3);
  for (const auto& [speed, is_fast] : {std::pair{300, false}, {800, true}, {499, false}, {500, true}}) {
    for (const Opcode direction : {Opcode::ror, Opcode::rol}) {
      bench.command(direction, 0, 0, speed);
      wait_ms(1'000);
      EXPECT_EQ(driver(bench).current_scale(), is_fast ? run_scale : special_scale) << speed;
      EXPECT_EQ(cool_step_is_on(bench), is_fast) << speed;
    }
  }
  stop();
  wait_ms(200);
  EXPECT_EQ(driver(bench).current_scale(), standby_scale);
  EXPECT_FALSE(cool_step_is_on(bench));
}

TEST_P(MotorCurrent, IsTheMaximumCurrentAtAllSpeedsWithoutAThreshold) {
  bench.set(AxisParameter::smart_energy_hysteresis_start, 3);
  bench.command(Opcode::ror, 0, 0, 5);
  wait_ms(500);
  EXPECT_EQ(driver(bench).current_scale(), run_scale);
  EXPECT_TRUE(cool_step_is_on(bench));
}

TEST_P(MotorCurrent, IsSwitchedOffAfterTheFreewheelingDelayAndOnByTheNextCommand) {
  bench.set(AxisParameter::freewheeling_delay, 30);
  for (const bool moves_to_position : {false, true}) {
    bench.command(Opcode::ror, 0, 0, 300);
    wait_ms(500);
    stop();
    EXPECT_EQ(driver(bench).current_scale(), run_scale);
    wait_ms(150);
    EXPECT_EQ(driver(bench).current_scale(), standby_scale);
    EXPECT_TRUE(driver(bench).bridges_on());
    wait_ms(200);
    EXPECT_FALSE(driver(bench).bridges_on());
    EXPECT_EQ(bench.get(AxisParameter::chopper_off_time), 5) << "the setting stays";
    const std::int64_t angle = bench.module.world().rotor_angle();
    bench.command(moves_to_position ? Opcode::mvp : Opcode::ror, moves_to_position ? 1 : 0, 0, 300);
    EXPECT_TRUE(driver(bench).bridges_on());
    EXPECT_EQ(driver(bench).current_scale(), run_scale);
    wait_ms(500);
    EXPECT_NE(bench.module.world().rotor_angle(), angle);
  }
}

TEST_P(MotorCurrent, IsSwitchedOffWithoutStandbyWhenTheFreewheelingDelayIsTheShorter) {
  bench.set(AxisParameter::power_down_delay, 100);
  bench.set(AxisParameter::freewheeling_delay, 20);
  bench.command(Opcode::ror, 0, 0, 300);
  wait_ms(500);
  stop();
  wait_ms(150);
  EXPECT_EQ(driver(bench).current_scale(), run_scale);
  EXPECT_TRUE(driver(bench).bridges_on());
  wait_ms(100);
  EXPECT_FALSE(driver(bench).bridges_on());
}

TEST_P(MotorCurrent, ObeysDelaysThatAreSetWhileTheModuleSleeps) {
  wait_ms(1'000);
  EXPECT_EQ(bench.module.next_turn(), never);
  bench.set(AxisParameter::freewheeling_delay, 300);
  wait_ms(1'900);
  EXPECT_TRUE(driver(bench).bridges_on());
  wait_ms(300);
  EXPECT_FALSE(driver(bench).bridges_on());
  EXPECT_EQ(bench.module.next_turn(), never);
  bench.set(AxisParameter::freewheeling_delay, 0);
  EXPECT_TRUE(driver(bench).bridges_on());
  EXPECT_EQ(driver(bench).current_scale(), standby_scale);
}

TEST_P(MotorCurrent, IsTheStandbyCurrentWhileALimitSwitchHoldsTheMotorIfParameter150SaysSo) {
  for (const bool by_position : {false, true}) {
    bench.set(AxisParameter::end_switch_power_down, 0);
    bench.set(AxisParameter::right_limit_switch_disable, 0);
    bench.module.world().set_right_switch(true);
    bench.command(by_position ? Opcode::mvp : Opcode::ror, by_position ? 1 : 0, 0, 500);
    wait_ms(1'000);
    EXPECT_EQ(driver(bench).current_scale(), run_scale) << "0: stay at run current";
    bench.set(AxisParameter::end_switch_power_down, 1);
    wait_ms(50);
    EXPECT_EQ(driver(bench).current_scale(), run_scale) << "within the delay";
    wait_ms(100);
    EXPECT_EQ(driver(bench).current_scale(), standby_scale);
    bench.module.world().set_right_switch(false);
    wait_ms(30);
    EXPECT_EQ(driver(bench).current_scale(), run_scale) << "it moves on";
  }
}

struct BoostCurrent : testing::Test {
  Bench bench{pd1161};
};

TEST_F(BoostCurrent, IsUsedWhileTheSpeedChanges) {
  bench.set(AxisParameter::maximum_current, run_current);
  bench.set(AxisParameter::boost_current, special_current);
  bench.set(AxisParameter::maximum_acceleration, 100);
  const auto scale_at_phases = [this](Opcode opcode, std::int32_t value) {
    bench.command(opcode, opcode == Opcode::mvp ? 1 : 0, 0, value);
    bench.wait(100 * one_millisecond);
    const std::int32_t accelerating = driver(bench).current_scale();
    bench.wait(1'500 * one_millisecond);
    return std::pair{accelerating, driver(bench).current_scale()};
  };
  EXPECT_EQ(scale_at_phases(Opcode::ror, 1500), (std::pair{special_scale, run_scale}));
  EXPECT_EQ(scale_at_phases(Opcode::ror, 300), (std::pair{special_scale, run_scale})) << "braking";
  EXPECT_EQ(scale_at_phases(Opcode::mst, 0), (std::pair{special_scale, run_scale})) << "to a stop";
  EXPECT_EQ(scale_at_phases(Opcode::mvp, -100'000), (std::pair{special_scale, run_scale})) << "a positioning ramp";
  bench.set(AxisParameter::boost_current, 0);
  EXPECT_EQ(scale_at_phases(Opcode::ror, 1500).first, run_scale) << "0 means the maximum current";
}

TEST_F(BoostCurrent, DoesNotHeatAMotorThatALimitSwitchHolds) {
  bench.set(AxisParameter::maximum_current, run_current);
  bench.set(AxisParameter::boost_current, special_current);
  bench.set(AxisParameter::right_limit_switch_disable, 0);
  bench.module.world().set_right_switch(true);
  bench.command(Opcode::ror, 0, 0, 500);
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(driver(bench).current_scale(), run_scale);
}

/// Steps come from the step/direction connector, not from the ramp generator.
class StepDirectionMode : public testing::Test {
 protected:
  void start(const ModuleDescription& description, std::int32_t mode) {
    bench.emplace(description);
    bench->set(AxisParameter::maximum_current, run_current);
    bench->set(AxisParameter::standby_current, standby_current);
    bench->set(AxisParameter::power_down_delay, 10);
    bench->wait(500 * one_millisecond);
    bench->set(AxisParameter::step_direction_mode, mode);
  }
  void enable(bool level) {
    bench->module.world().set_inputs(level ? 1U << static_cast<unsigned>(hal::InputPin::step_dir_enable) : 0);
    bench->wait(20 * one_millisecond);
  }
  /// A pulse each millisecond.
  void step(int count) {
    for (int i = 0; i < count; ++i) {
      bench->module.world().pulse_step_input(false);
      bench->wait(one_millisecond);
    }
  }
  /// The scale of the current, or -1 without current.
  std::int32_t scale() { return driver(*bench).bridges_on() ? driver(*bench).current_scale() : -1; }

  std::optional<Bench> bench;
};

TEST_F(StepDirectionMode, SwitchesTheCurrentAsTheTableOfTheManualSays) {
  struct Row {
    std::int32_t mode;
    std::int32_t disabled_at_rest, disabled_moving, enabled_at_rest, enabled_moving;
  };
  constexpr std::int32_t off = -1;
  constexpr Row rows[] = {
      {1, standby_scale, standby_scale, run_scale, run_scale},
      {2, standby_scale, run_scale, standby_scale, run_scale},
      {3, run_scale, run_scale, run_scale, run_scale},
      {4, off, off, standby_scale, run_scale},
      {5, off, off, run_scale, run_scale},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.mode);
    start(pd1161, row.mode);
    for (const bool enabled : {false, true}) {
      enable(enabled);
      bench->wait(500 * one_millisecond);
      EXPECT_EQ(scale(), enabled ? row.enabled_at_rest : row.disabled_at_rest) << enabled;
      step(20);
      EXPECT_EQ(scale(), enabled ? row.enabled_moving : row.disabled_moving) << enabled;
    }
  }
}

TEST_F(StepDirectionMode, ReducesTheCurrentAfterThePowerDownDelayBehindTheLastStep) {
  for (const ModuleDescription* description : {&tmcm1110, &pd1161}) {
    start(*description, description == &tmcm1110 ? 1 : 2);
    bench->set(AxisParameter::power_down_delay, 30);
    step(100);
    EXPECT_EQ(scale(), run_scale);
    bench->wait(280 * one_millisecond);
    EXPECT_EQ(scale(), run_scale);
    bench->wait(40 * one_millisecond);
    EXPECT_EQ(scale(), standby_scale);
    step(20);
    EXPECT_EQ(scale(), run_scale) << "and back with the first steps";
  }
}

TEST_F(StepDirectionMode, TurnsTheShaftByTheStepsFromOutside) {
  start(pd1161, 2);
  const std::int64_t begin = bench->module.world().rotor_angle();
  step(64);
  EXPECT_EQ(bench->module.world().rotor_angle() - begin, 64);
  bench->set(AxisParameter::double_step, 1);
  step(64);
  EXPECT_EQ(bench->module.world().rotor_angle() - begin, 3 * 64) << "both edges count";
}

}  // namespace
}  // namespace opentmcl::tests
