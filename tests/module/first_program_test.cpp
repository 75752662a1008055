// The program of the manuals' chapter 2.4, kept as examples/first_steps.tmc, on both modules.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

std::string first_steps() {
  const std::ifstream file(OPENTMCL_EXAMPLES "/first_steps.tmc");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class FirstProgram : public testing::TestWithParam<ModuleId> {};

INSTANTIATE_TEST_SUITE_P(Both, FirstProgram, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

// With the defaults of both modules: pulse divisor 3, ramp divisor 7, acceleration 1000.
constexpr double unit_speed = 16e6 / (8 * 2048.0 * 32.0);                   // pps per internal unit
constexpr double unit_acceleration = 16e6 * 16e6 / (1024.0 * 536870912.0);  // pps² per internal unit
constexpr double ramp_tick = 32 * 128 / 16e6;                               // s

double seconds(Microseconds time) {
  return static_cast<double>(time) / 1e6;
}

TEST_P(FirstProgram, MovesAsTheFormulasSay) {
  Bench bench(modules[static_cast<std::size_t>(GetParam())]);
  bench.run_program(first_steps());
  const Microseconds start = bench.module.now();
  const auto& world = bench.module.world();

  // ROL 0, 1000 for 5 s: a ramp of v/a, then constant speed.
  bench.wait(4'900 * one_millisecond);
  const double speed = 1000 * unit_speed;
  const double acceleration = 1000 * unit_acceleration;
  const double elapsed = seconds(bench.module.now() - start);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), -1000);
  const double expected = -(speed * (elapsed - speed / acceleration / 2));
  EXPECT_NEAR(static_cast<double>(world.rotor_angle()), expected, speed * (ramp_tick + 0.004));

  // MST, and ROR 0, 100 at once behind it, for 5 s.
  bench.wait(4'900 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 100);

  // Then moves between 512000 and -512000 with speed 100 and acceleration 100.
  bench.wait(1'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::maximum_positioning_speed), 100);
  EXPECT_EQ(bench.get(AxisParameter::maximum_acceleration), 100);
  EXPECT_EQ(bench.get(AxisParameter::target_position), 512'000);
  const auto next_turning_point = [&bench](std::int32_t target) {
    while (bench.get(AxisParameter::target_position) == target) bench.wait(one_millisecond);
    return bench.module.now();
  };
  const Microseconds first = next_turning_point(512'000);
  const Microseconds second = next_turning_point(-512'000);
  const Microseconds third = next_turning_point(512'000);
  // A trapezoid: distance / speed + speed / acceleration, and at the end a crawl because the ramp generator brakes a
  // little early (p is reduced by 5 %).
  const double slow = 100 * unit_speed;
  const double trapezoid = 2 * 512'000 / slow + slow / (100 * unit_acceleration);
  EXPECT_NEAR(seconds(second - first), trapezoid, 0.05);
  EXPECT_NEAR(seconds(third - second), trapezoid, 0.05);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 1) << "it never ends";
}

}  // namespace
}  // namespace opentmcl::tests
