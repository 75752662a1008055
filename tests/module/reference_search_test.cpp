#include <gtest/gtest.h>

#include <functional>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

/// Switches as a stage has them, by position of the shaft in microsteps.
struct Stage {
  std::int32_t left_limit = -40'000;  ///< the left switch is active up to here
  std::int32_t right_limit = 40'000;  ///< the right switch is active from here on
  std::int32_t home_begin = -10'000;
  std::int32_t home_end = -8'000;
  std::int32_t left_limit_begin = int32_minimum;  ///< a left switch that can be passed begins here
  std::int32_t right_limit_end = int32_maximum;
  bool home_inverted = false;

  void apply_to(twin::World& world) const {
    const std::int64_t x = world.rotor_angle();
    world.set_left_switch(x <= left_limit && x >= left_limit_begin);
    world.set_right_switch(x >= right_limit && x <= right_limit_end);
    const bool home = (x >= home_begin && x <= home_end) != home_inverted;
    world.set_inputs(home ? 1U << static_cast<unsigned>(hal::InputPin::home_switch) : 0);
  }
};

/// Runs a search. @return where the shaft stands when it ends, in microsteps since power-on
std::int64_t origin_found(const Stage& stage, int mode, std::int32_t start) {
  Bench bench(pd1161);
  bench.set(AxisParameter::pulse_divisor, 2);
  bench.command(Opcode::mvp, 0, 0, start);
  bench.wait_until_reached(20'000 * one_millisecond);
  bench.set(AxisParameter::reference_search_mode, mode);
  stage.apply_to(bench.module.world());
  EXPECT_EQ(bench.command(Opcode::rfs, 0).status, Status::ok);
  EXPECT_NE(bench.command(Opcode::rfs, 2).value, 0);
  const Microseconds limit = bench.module.now() + 60'000 * one_millisecond;
  while (bench.command(Opcode::rfs, 2).value != 0) {
    if (bench.module.now() > limit) {
      ADD_FAILURE() << "mode " << mode << " does not end: state " << bench.command(Opcode::rfs, 2).value;
      break;
    }
    for (int i = 0; i < 50; ++i) {
      bench.wait(200);
      stage.apply_to(bench.module.world());
    }
  }
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 0);
  EXPECT_EQ(bench.get(AxisParameter::last_reference_position), bench.module.world().rotor_angle());
  if ((mode & 15) == 2 || (mode & 15) == 3) {
    const std::int64_t distance = bench.get(AxisParameter::end_switch_distance);
    EXPECT_NEAR(static_cast<double>(distance), 80'000, 300);
  }
  return bench.module.world().rotor_angle();
}

constexpr double one_full_step = 256;

TEST(ReferenceSearch, FindsTheEdgeOfTheLimitSwitch) {
  for (const std::int32_t start : {0, 15'000, -20'000}) {
    EXPECT_NEAR(static_cast<double>(origin_found({}, 1, start)), -40'000, one_full_step);
    EXPECT_NEAR(static_cast<double>(origin_found({}, 2, start)), -40'000, one_full_step);
    EXPECT_NEAR(static_cast<double>(origin_found({}, 65, start)), 40'000, one_full_step);
    EXPECT_NEAR(static_cast<double>(origin_found({}, 66, start)), 40'000, one_full_step);
  }
}

TEST(ReferenceSearch, FindsTheMiddleOfALimitSwitchThatCanBePassed) {
  Stage stage;
  stage.left_limit_begin = -42'000;
  stage.right_limit_end = 42'000;
  EXPECT_NEAR(static_cast<double>(origin_found(stage, 4, 0)), -41'000, one_full_step);
  EXPECT_NEAR(static_cast<double>(origin_found(stage, 68, 0)), 41'000, one_full_step);
}

TEST(ReferenceSearch, FindsTheMiddleOfTheHomeSwitchFromBothSidesOfIt) {
  for (const int mode : {5, 6, 7, 8}) {
    for (const std::int32_t start : {20'000, -9'000, -30'000}) {
      // Without limit switches (7 and 8) home has to lie in the direction of the search.
      if ((mode == 7 && start < -10'000) || (mode == 8 && start > -8'000)) continue;
      EXPECT_NEAR(static_cast<double>(origin_found({}, mode, start)), -9'000, one_full_step)
          << "mode " << mode << " from " << start;
    }
  }
}

TEST(ReferenceSearch, TakesTheHomeSwitchInvertedWith128) {
  Stage stage;
  stage.home_inverted = true;
  EXPECT_NEAR(static_cast<double>(origin_found(stage, 128 + 5, 10'000)), -9'000, one_full_step);
}

TEST(ReferenceSearch, IsAbortedByRfsStopAndByMotionCommands) {
  const std::function<void(Bench&)> ways[] = {
      [](Bench& bench) { bench.command(Opcode::rfs, 1); },
      [](Bench& bench) { bench.command(Opcode::mst); },
      [](Bench& bench) { bench.command(Opcode::ror, 0, 0, 0); },
      [](Bench& bench) { bench.command(Opcode::mvp, 1, 0, 0); },
  };
  for (const auto& way : ways) {
    Bench bench(tmcm1110);
    bench.command(Opcode::rfs, 0);
    bench.wait(300 * one_millisecond);
    EXPECT_NE(bench.get(AxisParameter::actual_speed), 0);
    way(bench);
    EXPECT_EQ(bench.command(Opcode::rfs, 2).value, 15);
    bench.wait(1'000 * one_millisecond);
    EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0);
  }
}

TEST(ReferenceSearch, LeavesTheLimitStopsAsTheyWere) {
  Bench bench(pd1161);
  bench.set(AxisParameter::right_limit_switch_disable, 0);
  bench.command(Opcode::rfs, 0);
  bench.command(Opcode::rfs, 1);
  bench.wait(1'000 * one_millisecond);
  bench.module.world().set_right_switch(true);
  bench.command(Opcode::ror, 0, 0, 500);
  bench.wait(500 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0);
}

TEST(ReferenceSearch, IsWaitedForByAProgram) {
  Bench bench(pd1161);
  Stage stage;
  bench.run_program("RFS START, 0\nWAIT RFS, 0, 0\nRFS STATUS, 0\nJC NZ, Bad\nSGP 0, 2, 1\nBad: STOP\n");
  for (int i = 0; i < 60'000 && bench.command(Opcode::ggp, 0, 2).value == 0; ++i) {
    stage.apply_to(bench.module.world());
    bench.wait(200);
  }
  EXPECT_EQ(bench.command(Opcode::ggp, 0, 2).value, 1);
  EXPECT_NEAR(static_cast<double>(bench.module.world().rotor_angle()), -40'000, one_full_step);
}

}  // namespace
}  // namespace opentmcl::tests
