// The ramp and pulse generators of the TMC429 model against the formulas of the datasheet.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "twin/chip/tmc429.hpp"
#include "twin/chip/tmc429_choices.hpp"
#include "twin/chip/tmc429_test_bench.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::ActualPosition;
using tmc429::ActualVelocity;
using tmc429::MaximumAcceleration;
using tmc429::MaximumVelocity;
using tmc429::MinimumVelocity;
using tmc429::RampMode;
using tmc429::TargetPosition;
using tmc429::TargetVelocity;

constexpr std::uint64_t second = tmc429::clock_frequency;
constexpr std::uint64_t millisecond = second / 1000;

struct PulseRate {
  std::int32_t velocity;
  int pulse_divider;
  double steps_per_second;  ///< fCLK v / (2^PULSE_DIV 2048 32), page 36
};

class Tmc429PulseRate : public testing::TestWithParam<PulseRate> {};

TEST_P(Tmc429PulseRate, IsThatOfTheFormulaOverTenSeconds) {
  const PulseRate& rate = GetParam();
  Tmc429Bench bench;
  bench.set_dividers(rate.pulse_divider, 0);
  bench.hold_velocity(rate.velocity);
  bench.chip.advance(10 * second);
  // The time does not end on a pulse tick, and the phase not on a step: less than one step is lost by each.
  EXPECT_NEAR(static_cast<double>(bench.steps.events.size()), 10 * rate.steps_per_second, 2.0);
}

INSTANTIATE_TEST_SUITE_P(WorkedExamples, Tmc429PulseRate,
                         testing::Values(PulseRate{1678, 3, 51208.5}, PulseRate{2047, 0, 499755.859},
                                         PulseRate{2047, 3, 62469.482}, PulseRate{1, 5, 7.629395},
                                         PulseRate{2047, 13, 61.005}, PulseRate{1000, 7, 1907.349}));

TEST(Tmc429Acceleration, IsThatOfTheFormulaWithinOneRampTick) {
  // a = fCLK² A_MAX / 2^(PULSE_DIV + RAMP_DIV + 29), page 37: 100, 3, 7 give 46566 steps/s².
  Tmc429Bench bench;
  bench.set_dividers(3, 7);
  bench.set_mode(RampMode::velocity);
  bench.set<MaximumVelocity>(2047);
  bench.set<MaximumAcceleration>(100);
  bench.set<TargetVelocity>(1678);
  std::uint64_t ticks = 0;
  const std::uint64_t ramp_tick = 32 << 7;
  for (; bench.get<ActualVelocity>() != 1678; ++ticks) {
    bench.chip.advance(ramp_tick);
  }
  const double seconds = static_cast<double>(ticks * ramp_tick) / static_cast<double>(second);
  const double expected = 51208.5 / 46566.13;
  EXPECT_NEAR(seconds, expected, static_cast<double>(ramp_tick) / static_cast<double>(second));
}

TEST(Tmc429Acceleration, TakesTheStepsOfTheFormula) {
  // S = v² / A_MAX * 2^(RAMP_DIV - PULSE_DIV) / 16, page 37. Only integer velocities reach the pulse generator, which
  // costs up to half a unit on average.
  Tmc429Bench bench;
  bench.set_dividers(3, 7);
  bench.set_mode(RampMode::velocity);
  bench.set<MaximumVelocity>(2047);
  bench.set<MaximumAcceleration>(100);
  bench.set<TargetVelocity>(2047);
  while (bench.get<ActualVelocity>() != 2047) {
    bench.chip.advance(32 << 7);
  }
  const double expected = 2047.0 * 2047 / 100 * 16 / 16;
  EXPECT_NEAR(bench.get<ActualPosition>(), expected, expected * 0.5 / 1024 + 2);
}

TEST(Tmc429Velocity, IsLimitedByTheMaximumAlsoInVelocityMode) {
  Tmc429Bench bench;
  bench.set_mode(RampMode::velocity);
  bench.set<MaximumVelocity>(300);
  bench.set<MaximumAcceleration>(2047);
  bench.set<TargetVelocity>(-1000);
  bench.chip.advance(100 * millisecond);
  EXPECT_EQ(bench.get<ActualVelocity>(), -300);
}

TEST(Tmc429Velocity, CannotChangeWithoutAcceleration) {
  Tmc429Bench bench;
  bench.hold_velocity(500);
  bench.set<TargetVelocity>(0);
  bench.set_mode(RampMode::velocity);
  bench.chip.advance(second);
  EXPECT_EQ(bench.get<ActualVelocity>(), 500);
}

TEST(Tmc429Velocity, StopsAtOnceWhenZeroIsWrittenInVelocityMode) {
  Tmc429Bench bench;
  bench.set_mode(RampMode::velocity);
  bench.set<MaximumVelocity>(2047);
  bench.set<MaximumAcceleration>(2047);
  bench.set<TargetVelocity>(2047);
  bench.chip.advance(millisecond);
  bench.set<TargetVelocity>(0);
  bench.set<ActualVelocity>(0);
  const std::int32_t position = bench.get<ActualPosition>();
  bench.chip.advance(second);
  EXPECT_EQ(bench.get<ActualPosition>(), position);
}

TEST(Tmc429Velocity, ReadsAsZeroBelowOneInBothDirections) {
  static_assert(tmc429_choices::integer_velocity(255) == 0);
  static_assert(tmc429_choices::integer_velocity(-255) == 0);
  static_assert(tmc429_choices::integer_velocity(-256) == -1);
}

struct RampParameters {
  std::int32_t acceleration;
  int ramp_divider;
  int pulse_divider;
  int multiplier;  ///< with p reduced by 5 %, reference results of the vendor's method
  int divisor;
};

/// With these the braking law promises to end exactly.
constexpr RampParameters gentle_ramps[] = {{500, 3, 2, 237, 4}, {100, 7, 7, 190, 5}, {50, 9, 5, 190, 10},
                                           {500, 7, 5, 237, 5}, {10, 3, 3, 152, 8},  {1, 0, 0, 243, 12}};

/// So much acceleration that the last steps are taken faster than V_MIN.
constexpr RampParameters steep_ramps[] = {{2047, 0, 0, 243, 1}, {2047, 7, 3, 243, 5}, {1000, 11, 11, 237, 2}};

void prepare_positioning(Tmc429Bench& bench, const RampParameters& ramp, std::int32_t maximum_velocity) {
  bench.set<MinimumVelocity>(1);
  bench.set<MaximumVelocity>(maximum_velocity);
  bench.set<MaximumAcceleration>(ramp.acceleration);
  bench.set_dividers(ramp.pulse_divider, ramp.ramp_divider);
  bench.write(tmc429::BrakingFactor::Multiplier::of(ramp.multiplier) |
              tmc429::BrakingFactor::Divisor::of(ramp.divisor));
}

/// The number of steps of a move, which must end at the target.
std::size_t steps_of_move(const RampParameters& ramp, std::int32_t distance, std::int32_t maximum_velocity) {
  Tmc429Bench bench;
  prepare_positioning(bench, ramp, maximum_velocity);
  bench.set<TargetPosition>(distance);
  bool arrived = false;
  for (int slice = 0; slice < 10'000 && !arrived; ++slice) {
    bench.chip.advance(100 * millisecond);
    arrived = bench.get<ActualVelocity>() == 0 && tmc429::Status::AtTarget1::is_set(bench.status());
  }
  EXPECT_TRUE(arrived) << "distance " << distance;
  EXPECT_EQ(bench.get<ActualPosition>(), distance);
  return bench.steps.events.size();
}

class Tmc429GentleRamp : public testing::TestWithParam<RampParameters> {};

TEST_P(Tmc429GentleRamp, EndsExactlyAtTheTargetWithoutOvershoot) {
  for (const std::int32_t distance : {3, 51, -200, 2000, -10'000, 51'200}) {
    for (const std::int32_t maximum_velocity : {300, 2047}) {
      EXPECT_EQ(steps_of_move(GetParam(), distance, maximum_velocity), static_cast<std::size_t>(std::abs(distance)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ReferenceParameters, Tmc429GentleRamp, testing::ValuesIn(gentle_ramps));

class Tmc429SteepRamp : public testing::TestWithParam<RampParameters> {};

TEST_P(Tmc429SteepRamp, ReturnsAfterAnOvershootOfAtMostOneStep) {
  for (const std::int32_t distance : {3, 51, -200, 2000, -10'000}) {
    const auto magnitude = static_cast<std::size_t>(std::abs(distance));
    const std::size_t steps = steps_of_move(GetParam(), distance, 2047);
    EXPECT_TRUE(steps == magnitude || steps == magnitude + 2) << "distance " << distance << " steps " << steps;
  }
}

INSTANTIATE_TEST_SUITE_P(ReferenceParameters, Tmc429SteepRamp, testing::ValuesIn(steep_ramps));

TEST(Tmc429SoftMode, EndsExactlyAtTheTargetToo) {
  Tmc429Bench bench;
  prepare_positioning(bench, gentle_ramps[0], 1000);
  bench.set_mode(RampMode::soft);
  bench.set<TargetPosition>(-777);
  bench.chip.advance(60 * second);
  EXPECT_EQ(bench.get<ActualPosition>(), -777);
  EXPECT_EQ(bench.steps.events.size(), 777u);
}

TEST(Tmc429Positioning, CrossesTheEndOfTheCounterTheShortWay) {
  Tmc429Bench bench;
  bench.set_mode(RampMode::velocity);
  bench.set<ActualPosition>(0x7FFFF0);
  bench.set<TargetPosition>(-0x7FFFF0);
  prepare_positioning(bench, gentle_ramps[0], 1000);
  bench.set_mode(RampMode::ramp);
  bench.chip.advance(second);
  EXPECT_EQ(bench.get<ActualPosition>(), -0x7FFFF0);
  EXPECT_EQ(bench.steps.events.size(), 32u);
  EXPECT_FALSE(bench.steps.events.back().direction);
}

TEST(Tmc429Positioning, OvershootsByAtMostOneStepAndReturnsWhenTheFactorIsTooLarge) {
  // The datasheet names this behaviour of a p reduced by only 1 % (page 29).
  Tmc429Bench bench;
  prepare_positioning(bench, {2047, 0, 0, 253, 1}, 2047);
  bench.set<TargetPosition>(20'000);
  bench.chip.advance(second);
  EXPECT_EQ(bench.get<ActualPosition>(), 20'000);
  EXPECT_LE(bench.steps.events.size(), 20'002u);
}

TEST(Tmc429Positioning, DoesNotMoveWithAMaximumVelocityOfZero) {
  Tmc429Bench bench;
  prepare_positioning(bench, gentle_ramps[0], 0);
  bench.set<TargetPosition>(1000);
  bench.chip.advance(second);
  EXPECT_EQ(bench.get<ActualPosition>(), 0);
}

TEST(Tmc429Time, PassesAtNoCostWhileNothingMoves) {
  // A hundred years; an iteration over ticks would never end.
  Tmc429Bench bench;
  bench.chip.advance(second * 3600 * 24 * 36525);
  EXPECT_EQ(bench.get<ActualPosition>(), 0);
}

}  // namespace
}  // namespace opentmcl::twin
