// The encoder parameters 209, 210 and 215 over the wire, with the encoder on the twin's shaft.
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr std::int32_t turn = 51'200;  // microsteps
constexpr std::int32_t count = 50;     // microsteps, 1024 counts a turn

class Encoder : public testing::TestWithParam<ModuleId> {
 protected:
  void move_to(std::int32_t position) {
    bench.command(Opcode::mvp, 0, 0, position);
    bench.wait_until_reached(60'000 * one_millisecond);
  }
  std::int32_t encoder() { return bench.get(AxisParameter::encoder_position); }

  Bench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, Encoder, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(Encoder, FollowsTheMotorToACount) {
  for (const std::int32_t position : {10 * count, turn, -turn, 3 * turn + 25, 0}) {
    move_to(position);
    EXPECT_NEAR(encoder(), position, count) << position;
  }
}

TEST_P(Encoder, MatchesTheMicrostepResolutionWithThePrescalerOfTheTable) {
  for (int resolution = 4; resolution <= 8; ++resolution) {
    bench.set(AxisParameter::microstep_resolution, resolution);
    bench.set(AxisParameter::encoder_prescaler, 100 << resolution);
    bench.command(Opcode::mst);
    bench.set(AxisParameter::actual_position, 0);
    bench.set(AxisParameter::encoder_position, 0);
    const std::int32_t full_turn = 200 << resolution;
    move_to(full_turn);
    EXPECT_NEAR(encoder(), full_turn, count) << resolution;
  }
}

TEST_P(Encoder, CanBeSetToAnyPosition) {
  bench.set(AxisParameter::encoder_position, -123'456);
  EXPECT_EQ(encoder(), -123'456);
  move_to(20 * count);
  EXPECT_NEAR(encoder(), -123'456 + 20 * count, count);
}

TEST_P(Encoder, IsReversedTogetherWithTheMotor) {
  bench.set(GlobalParameter::reverse_shaft, 1);
  move_to(40 * count);
  EXPECT_EQ(bench.module.world().rotor_angle(), -40 * count);
  EXPECT_NEAR(encoder(), 40 * count, count);
}

TEST_P(Encoder, LosesItsPositionWithThePowerAndKeepsNothingElseOfIt) {
  move_to(10 * count);
  bench.module.power_cycle();
  bench.wait(10 * one_millisecond);
  EXPECT_EQ(encoder(), 0);
}

/// The encoder with three channels, whose null position is where the shaft starts.
struct NullChannel : testing::Test {
  void move_to(std::int32_t position) {
    bench.command(Opcode::mvp, 0, 0, position);
    bench.wait_until_reached(60'000 * one_millisecond);
  }

  Bench bench{tmcm1110};
};

constexpr std::int32_t clear_on_null = 4;
constexpr std::int32_t every_time = 8;
constexpr std::int32_t high_active = 16;

TEST_F(NullChannel, ClearsThePositionAtTheNextPassAndNoOther) {
  move_to(10'000);
  bench.set(AxisParameter::encoder_position, 777'777);
  bench.set(AxisParameter::encoder_prescaler, 25'600 + clear_on_null);
  move_to(-3'000);
  EXPECT_NEAR(bench.get(AxisParameter::encoder_position), -3'000, count);
  EXPECT_EQ(bench.get(AxisParameter::encoder_prescaler), 25'600) << "done";
  bench.set(AxisParameter::encoder_position, 500'000);
  move_to(3'000);
  EXPECT_NEAR(bench.get(AxisParameter::encoder_position), 506'000, count);
}

TEST_F(NullChannel, ClearsThePositionWhileNobodyReadsIt) {
  move_to(10'000);
  bench.set(AxisParameter::encoder_position, 0);
  bench.set(AxisParameter::encoder_prescaler, 25'600 + clear_on_null);
  move_to(2 * turn + 1'000);
  EXPECT_NEAR(bench.get(AxisParameter::encoder_position), turn + 1'000, count) << "at the first of two passes";
}

TEST_F(NullChannel, ClearsThePositionAtEveryPassWithBothBits) {
  bench.set(AxisParameter::encoder_prescaler, 25'600 + clear_on_null + every_time);
  for (const std::int32_t position : {5'000, -3'000, 2 * turn + 1'000, turn + 500}) {
    move_to(position);
    const std::int32_t shown = bench.get(AxisParameter::encoder_position);
    EXPECT_NEAR(shown, position - (position > 2 * turn ? 2 * turn : position > turn ? 2 * turn : 0), count) << position;
  }
}

TEST_F(NullChannel, ClearsInEveryLineWhenToldTheWrongLevel) {
  bench.set(AxisParameter::encoder_prescaler, 25'600 + clear_on_null + every_time + high_active);
  constexpr std::int32_t line = 4 * count;
  move_to(10'000);
  EXPECT_LT(bench.get(AxisParameter::encoder_position), 2 * line);
}

struct SensOstep : testing::Test {
  Bench bench{pd1161};
};

TEST_F(SensOstep, ShowsTheAngleWithinATurnWhateverThePositionIsCalled) {
  const std::int32_t begin = bench.get(AxisParameter::absolute_encoder_value);
  bench.set(AxisParameter::encoder_position, 999'999);
  bench.set(AxisParameter::encoder_prescaler, 512);
  for (const std::int32_t counts : {100, 1000, 1034, -10}) {
    bench.command(Opcode::mvp, 0, 0, counts * count);
    bench.wait_until_reached(60'000 * one_millisecond);
    const std::int32_t expected = (begin + counts + 2048) % 1024;
    EXPECT_NEAR(bench.get(AxisParameter::absolute_encoder_value), expected, 1) << counts;
  }
}

TEST_F(SensOstep, ClearsItsPositionAtEveryPassOfZero) {
  bench.set(AxisParameter::encoder_prescaler, 25'600 + 4);
  for (const std::int32_t position : {turn + 5'000, 3 * turn + 2'000, -turn + 10'000}) {
    bench.command(Opcode::mvp, 0, 0, position);
    bench.wait_until_reached(60'000 * one_millisecond);
    const std::int32_t angle = bench.get(AxisParameter::absolute_encoder_value) * count;
    const std::int32_t shown = bench.get(AxisParameter::encoder_position);
    EXPECT_EQ((shown - angle) % turn, 0) << position;
    EXPECT_LE(shown, turn) << position;
    EXPECT_GE(shown, -turn) << position;
  }
}

}  // namespace
}  // namespace opentmcl::tests
