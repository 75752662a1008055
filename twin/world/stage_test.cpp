// The world with a linear stage on the shaft.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "twin/physics/ideal_rotor.hpp"
#include "twin/physics/shaft.hpp"
#include "twin/world/world_test_bench.hpp"

namespace opentmcl::twin {
namespace {

World::Mounted stage_from(std::int32_t start) {
  LinearStageDimensions dimensions;
  dimensions.start = start;
  return {.machine = dimensions, .encoder = ShaftEncoder(ShaftEncoder::Kind::absolute)};
}

/// Angle of the shaft at a place when the slider stood at `start` in the beginning, µm.
std::int64_t angle_at(std::int64_t place, std::int64_t start) {
  return (place - start) * microsteps_per_turn / 2000;
}

void rotate(World& world, std::int32_t velocity) {
  write(world, tmc429::Mode::of(tmc429::RampMode::velocity));
  set<tmc429::TargetVelocity>(world, velocity);
}

TEST(Stage, StopsTheMotorAtTheStepThatReachesALimitSwitch) {
  for (const int side : {-1, 1}) {
    const std::int32_t begin = side * 47'000;
    World world(nullptr, stage_from(begin));
    start(world);
    rotate(world, side * 1000);
    world.advance_to(3000 * millisecond);
    EXPECT_EQ(world.rotor_angle(), angle_at(side * 48'000, begin));
    EXPECT_EQ(get<tmc429::ActualVelocity>(world), 0);
    rotate(world, -side * 100);
    world.advance_to(3100 * millisecond);
    EXPECT_EQ(get<tmc429::ActualVelocity>(world), -side * 100) << "the way back is free";
  }
}

TEST(Stage, HoldsTheSliderAtItsHardEndsAndLosesStepsThere) {
  for (const int side : {-1, 1}) {
    const std::int32_t begin = side * 49'500;
    World world(nullptr, stage_from(begin));
    start(world);
    const std::int32_t beyond = static_cast<std::int32_t>(angle_at(side * 50'000, begin)) + side * 100'300;
    set<tmc429::TargetPosition>(world, beyond);
    world.advance_to(4000 * millisecond);
    ASSERT_EQ(get<tmc429::ActualPosition>(world), beyond);
    EXPECT_LE(world.machine().place() * side, 50'000);
    set<tmc429::TargetPosition>(world, beyond - side * 5'000);
    world.advance_to(5000 * millisecond);
    EXPECT_EQ((beyond - side * 5'000 - world.rotor_angle()) % IdealRotor::field_turn, 0);
    EXPECT_GT((beyond - side * 5'000 - world.rotor_angle()) * side, 90'000) << "most steps beyond the end are lost";
  }
}

TEST(Stage, LetsAHandOpenASwitchButNotCloseIt) {
  TraceText trace;
  World world(&trace, stage_from(-48'500));
  EXPECT_EQ(trace.text(), "0 left_switch 1\n0 stage -48500\n");
  world.set_left_switch(true);
  world.set_left_switch(false);
  world.set_home_switch(true);
  EXPECT_TRUE(world.home_switch());
  world.set_home_switch(false);
  EXPECT_FALSE(world.home_switch());
  EXPECT_EQ(trace.text(), "0 left_switch 1\n0 stage -48500\n0 home_switch 1\n0 home_switch 0\n");
}

TEST(Stage, HasNoHighSwitchInputWithoutPullUps) {
  TraceText trace;
  World world(&trace, stage_from(48'500));
  world.set_home_switch(true);
  world.set_pull_ups(false);
  EXPECT_FALSE(world.home_switch());
  world.power_cycle();
  EXPECT_TRUE(world.home_switch());
  EXPECT_EQ(trace.text(),
            "0 right_switch 1\n0 stage 48500\n0 home_switch 1\n0 right_switch 0\n0 home_switch 0\n0 power 0\n"
            "0 right_switch 1\n0 home_switch 1\n0 power 1\n");
}

TEST(Stage, ReportsSwitchesPlaceAndEncoderAtTheStepThatChangesThem) {
  TraceText trace;
  World world(&trace, stage_from(-9'495));
  start(world);
  rotate(world, -1000);
  world.advance_to(100 * millisecond);
  const std::string text = trace.text();
  const std::size_t home = text.find(" home_switch 1\n");
  ASSERT_NE(home, std::string::npos);
  const std::size_t line = text.rfind('\n', home) + 1;
  EXPECT_NE(text.find("\n" + text.substr(line, home - line) + " step 1\n"), std::string::npos);
  // Exactly at -9500: places are rounded down.
  EXPECT_LT(text.find(" stage -9500\n"), home);
  EXPECT_GT(text.find(" stage -9501\n"), home);
  EXPECT_NE(text.find(" encoder -1\n"), std::string::npos);
}

TEST(Stage, KeepsTheAngleOfAnAbsoluteEncoderWithoutSupply) {
  World world(nullptr, stage_from(0));
  start(world);
  set<tmc429::TargetPosition>(world, 51'200 + 25'600);
  world.advance_to(3000 * millisecond);
  EXPECT_EQ(world.encoder().count(), 1024 + 512);
  world.power_cycle();
  EXPECT_EQ(world.encoder().count(), 512);
}

/// Moves around the edge of the left switch, which stands at angle 0; time advances in pieces of at most `stride`.
/// @param bounce µs
std::string trace_at_the_edge(const std::vector<std::int8_t>& targets, Tick stride, std::int32_t bounce = 0) {
  TraceText trace;
  World::Mounted mounted = stage_from(-48'000);
  std::get<LinearStageDimensions>(mounted.machine).switch_bounce = bounce;
  World world(&trace, mounted);
  start(world);
  for (const std::int8_t target : targets) {
    set<tmc429::TargetPosition>(world, target % 16);
    const Tick end = world.now() + 7 * millisecond;
    while (world.now() < end) world.advance_to(std::min(world.now() + stride, end));
  }
  return trace.text();
}

RC_GTEST_PROP(Stage, GivesTheSameTraceAtEverySpeedAlsoWhereAStepBackPressesASwitch,
              (const std::vector<std::int8_t>& targets)) {
  const std::string in_leaps = trace_at_the_edge(targets, millisecond * 1000);
  RC_ASSERT(trace_at_the_edge(targets, *rc::gen::inRange<Tick>(1, 3000)) == in_leaps);
}

RC_GTEST_PROP(Stage, GivesTheSameTraceAtEverySpeedWithContactsThatBounce, ()) {
  const std::vector<std::int8_t> targets = {-3, 5, -7, *rc::gen::arbitrary<std::int8_t>()};
  const auto bounce = *rc::gen::inRange(100, 10'000);
  const std::string in_leaps = trace_at_the_edge(targets, millisecond * 1000, bounce);
  RC_ASSERT(trace_at_the_edge(targets, *rc::gen::inRange<Tick>(1, 3000), bounce) == in_leaps);
}

TEST(Stage, ShowsTheChatterOfAContactAtItsInput) {
  const std::string trace = trace_at_the_edge({5}, millisecond, 1'000);  // off the switch, with 1 ms of bounce
  const std::size_t first = trace.find(" left_switch 0\n");
  ASSERT_NE(first, std::string::npos);
  const std::size_t second = trace.find(" left_switch 1\n", first);
  ASSERT_NE(second, std::string::npos) << "closed, and open again";
  EXPECT_EQ(trace.substr(trace.rfind("left_switch"), 13), "left_switch 0") << "closed in the end";
}

TEST(Stage, MovesAnEncoderOnItsLoadSideOnlyWhenTheBacklashIsTakenUp) {
  for (const bool on_load_side : {false, true}) {
    LinearStageDimensions dimensions;
    dimensions.backlash = 200;  // a tenth of a turn
    World world(nullptr, {.machine = dimensions, .encoder = ShaftEncoder({.on_load_side = on_load_side})});
    start(world);
    set<tmc429::TargetPosition>(world, 25'600);
    world.advance_to(1000 * millisecond);
    EXPECT_EQ(world.machine().place(), 800);
    EXPECT_EQ(world.encoder().count(), on_load_side ? 512 - 103 : 512);
  }
}

}  // namespace
}  // namespace opentmcl::twin
