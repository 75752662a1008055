// coolStep (parameters 168 to 172, 182 and 183) over a load that comes and goes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/motor_loop/motor_bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr std::int32_t full_scale = 31;
constexpr std::int32_t half_scale = 15;
constexpr std::int32_t hysteresis_start = 5;
constexpr std::int32_t hysteresis_width = 3;

class CoolStep : public testing::TestWithParam<ModuleId> {
 protected:
  CoolStep() {
    bench.set(AxisParameter::stall_guard_threshold, 0);
    bench.set(AxisParameter::smart_energy_current_minimum, 0);    // down to a half
    bench.set(AxisParameter::smart_energy_current_down_step, 3);  // with each measurement
    bench.set(AxisParameter::smart_energy_current_up_step, 1);    // by two
    bench.set(AxisParameter::smart_energy_hysteresis, hysteresis_width);
  }
  void switch_on() { bench.set(AxisParameter::smart_energy_hysteresis_start, hysteresis_start); }

  struct Phase {
    std::int32_t least = full_scale;
    std::int32_t most = 0;
    double copper_loss = 0;  ///< of that with the full current
  };
  Phase look(unsigned milliseconds) {
    Phase phase;
    for (unsigned i = 0; i < milliseconds; ++i) {
      bench.wait_ms(1);
      const std::int32_t scale = bench.driver().current_scale();
      phase.least = std::min(phase.least, scale);
      phase.most = std::max(phase.most, scale);
      const double share = bench.world().field().amplitude / full_current;
      phase.copper_loss += share * share / milliseconds;
    }
    return phase;
  }

  /// Datasheet chapter 6: the current is left alone while stallGuard2 is between its thresholds, and a limit of the
  /// scale is the only other reason.
  void expect_that_current_suits_load() const {
    constexpr std::int32_t lower_threshold = 32 * hysteresis_start;
    constexpr std::int32_t upper_threshold = 32 * (hysteresis_start + hysteresis_width + 1);
    const std::int32_t scale = bench.driver().current_scale();
    const std::int32_t measured = bench.driver().stall_guard_value();
    EXPECT_TRUE(measured >= lower_threshold || scale == full_scale) << measured << " at " << scale;
    EXPECT_TRUE(measured < upper_threshold || scale == half_scale) << measured << " at " << scale;
  }

  MotorBench bench{modules[static_cast<std::size_t>(GetParam())]};
  const double full_current = bench.driver().current_amplitude() / 1000.0;  // A
};

INSTANTIATE_TEST_SUITE_P(Both, CoolStep, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161), name_of_module);

TEST_P(CoolStep, FindsTheLoadBetweenItsLimitsAndSavesEnergy) {
  switch_on();
  bench.rotate(286);
  double copper_loss = 0;
  std::int32_t highest = 0;
  constexpr double load_profile[] = {0.02, 0.1, 0.2, 0.3, 0.4, 0.3, 0.2, 0.02};  // N m; pull-out at 0.53
  for (const double torque : load_profile) {
    SCOPED_TRACE(testing::Message() << torque << " N m");
    bench.set_brake(torque);
    const Phase phase = look(1'000);
    EXPECT_GE(phase.least, half_scale);
    EXPECT_LE(phase.most, full_scale);
    EXPECT_NE(bench.motor().regime(), twin::Regime::slipping);
    expect_that_current_suits_load();
    highest = std::max(highest, phase.most);
    copper_loss += phase.copper_loss / static_cast<double>(std::size(load_profile));
  }
  EXPECT_EQ(highest, full_scale) << "the full current for 0.4 N m";
  EXPECT_EQ(bench.driver().current_scale(), half_scale) << "and half of it without load";
  EXPECT_LT(copper_loss, 0.7) << "a third of the losses is saved";
  EXPECT_LT(std::fabs(bench.full_steps_lost()), 1.0) << "no step is lost on the way";
}

TEST_P(CoolStep, LowersTheCurrentToAQuarterIfParameter168SaysSo) {
  bench.set(AxisParameter::smart_energy_current_minimum, 1);
  switch_on();
  bench.rotate(286);
  look(1'000);
  EXPECT_EQ(look(200).least, 7);
  EXPECT_LT(std::fabs(bench.full_steps_lost()), 1.0);
}

TEST_P(CoolStep, IsOffBelowItsThresholdSpeed) {
  bench.set(AxisParameter::smart_energy_threshold_speed, velocity_of(200));
  bench.set(AxisParameter::smart_energy_slow_run_current, 200);
  switch_on();
  bench.rotate(190);
  Phase phase = look(1'000);
  EXPECT_EQ(phase.least, 25);
  EXPECT_EQ(phase.most, 25) << "parameter 183 all the time";
  bench.rotate(286);
  look(1'000);
  EXPECT_EQ(look(200).most, half_scale);
}

TEST_P(CoolStep, LeavesTheCurrentAloneWithHysteresisStartZero) {
  bench.rotate(286);
  const Phase phase = look(1'000);
  EXPECT_EQ(phase.least, full_scale);
}

}  // namespace
}  // namespace opentmcl::tests
