#include "twin/physics/linear_stage.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {
namespace {

/// Shaft angle at a place of the default stage, µm from the middle: 2 mm a turn.
constexpr std::int64_t angle_at(std::int64_t place) {
  return place * microsteps_per_turn / 2000;
}

TEST(LinearStage, HasItsSwitchesWhereTheDefaultMachineHasThem) {
  const LinearStage stage{LinearStageDimensions{}};
  EXPECT_EQ(stage.travel().lowest, angle_at(-50'000));
  EXPECT_EQ(stage.travel().highest, angle_at(50'000));
  struct Row {
    std::int64_t place;  // µm
    LinearStage::Contacts open;
  };
  const Row rows[] = {
      {-50'000, {false, false, false}}, {-49'000, {true, false, false}},  {-48'000, {true, false, false}},
      {-47'000, {false, false, false}}, {-11'000, {false, false, false}}, {-10'500, {false, false, true}},
      {-9'500, {false, false, true}},   {-9'000, {false, false, false}},  {0, {false, false, false}},
      {47'000, {false, false, false}},  {48'000, {false, true, false}},   {49'000, {false, true, false}},
      {50'000, {false, false, false}},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(stage.contacts_at(angle_at(row.place)), row.open) << row.place << " um";
    EXPECT_EQ(stage.place_at(angle_at(row.place)), row.place);
  }
}

TEST(LinearStage, SwitchesWithinOneMicrostep) {
  const LinearStage stage{LinearStageDimensions{}};
  EXPECT_TRUE(stage.contacts_at(angle_at(-48'000)).left);
  EXPECT_FALSE(stage.contacts_at(angle_at(-48'000) + 1).left);
  EXPECT_TRUE(stage.contacts_at(angle_at(-49'000)).left);
  EXPECT_FALSE(stage.contacts_at(angle_at(-49'000) - 1).left);
}

TEST(LinearStage, StartsWhereItIsTold) {
  LinearStageDimensions dimensions;
  dimensions.start = -30'000;
  const LinearStage stage(dimensions);
  EXPECT_EQ(stage.place_at(0), -30'000);
  EXPECT_EQ(stage.travel().lowest, angle_at(-20'000));
  EXPECT_TRUE(stage.contacts_at(angle_at(20'000)).home);
}

TEST(LinearStage, MovesTheOtherWayWithTheMotorAtTheOtherEnd) {
  LinearStageDimensions dimensions;
  dimensions.mirrored = true;
  const LinearStage stage(dimensions);
  EXPECT_TRUE(stage.contacts_at(angle_at(48'500)).left);
  EXPECT_TRUE(stage.contacts_at(angle_at(-48'500)).right);
  EXPECT_TRUE(stage.contacts_at(angle_at(10'000)).home);
  EXPECT_EQ(stage.place_at(angle_at(10'000)), -10'000);
}

TEST(LinearStage, OpensNormallyOpenContactsAwayFromTheSwitches) {
  LinearStageDimensions dimensions;
  dimensions.contact = LinearStageDimensions::Contact::normally_open;
  const LinearStage stage(dimensions);
  EXPECT_EQ(stage.contacts_at(0), (LinearStage::Contacts{true, true, true}));
  EXPECT_EQ(stage.contacts_at(angle_at(48'500)), (LinearStage::Contacts{true, false, true}));
}

RC_GTEST_PROP(LinearStage, HoldsASwitchExactlyWhileTheSliderIsWithinItsWidth, ()) {
  LinearStageDimensions dimensions;
  dimensions.pitch = *rc::gen::inRange(1, 20'000);
  dimensions.start = *rc::gen::inRange(-50'000, 50'000);
  dimensions.mirrored = *rc::gen::arbitrary<bool>();
  const LinearStage stage(dimensions);
  const auto angle = *rc::gen::inRange<std::int64_t>(stage.travel().lowest, stage.travel().highest + 1);
  // The slider's place in units of 1/microsteps_per_turn µm, which no rounding touches.
  const std::int64_t place =
      dimensions.start * microsteps_per_turn + (dimensions.mirrored ? -angle : angle) * dimensions.pitch;
  const auto within = [place](std::int64_t from, std::int64_t to) {
    return from * microsteps_per_turn <= place && place <= to * microsteps_per_turn;
  };
  RC_ASSERT(within(-50'000, 50'000));
  RC_ASSERT(stage.contacts_at(angle).left == within(-49'000, -48'000));
  RC_ASSERT(stage.contacts_at(angle).right == within(48'000, 49'000));
  RC_ASSERT(stage.contacts_at(angle).home == within(-10'500, -9'500));
  RC_ASSERT(stage.place_at(angle) == floor_quotient(place, microsteps_per_turn));
}

}  // namespace
}  // namespace opentmcl::twin
