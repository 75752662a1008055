#include "twin/physics/shaft_encoder.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {
namespace {

using Kind = ShaftEncoder::Kind;
constexpr std::int64_t microsteps_per_count = 50;

TEST(ShaftEncoder, Counts1024InATurn) {
  for (const Kind kind : {Kind::absolute, Kind::incremental}) {
    ShaftEncoder encoder(kind);
    encoder.follow(microsteps_per_turn * 3);
    EXPECT_EQ(encoder.count(), 3 * 1024);
    encoder.follow(-1);
    EXPECT_EQ(encoder.count(), -1);
    encoder.follow(microsteps_per_count - 1);
    EXPECT_EQ(encoder.count(), 0);
  }
}

TEST(ShaftEncoder, KnowsItsAngleAfterPowerOnOnlyWhenItIsAbsolute) {
  ShaftEncoder absolute(Kind::absolute);
  ShaftEncoder incremental(Kind::incremental);
  for (ShaftEncoder* encoder : {&absolute, &incremental}) {
    encoder->follow(-microsteps_per_turn * 7 / 4);
    encoder->power_up();
  }
  EXPECT_EQ(absolute.count(), 256);
  EXPECT_EQ(incremental.count(), 0);
  absolute.follow(-microsteps_per_turn * 2);
  EXPECT_EQ(absolute.count(), 0);
}

TEST(ShaftEncoder, SeesTheNullPositionEvenWhenTheShaftTurnsBackAtOnce) {
  ShaftEncoder encoder(Kind::absolute);
  encoder.follow(-1);
  EXPECT_EQ(encoder.take_null_event(true), std::nullopt);
  encoder.follow(0);
  encoder.follow(-1);
  EXPECT_EQ(encoder.take_null_event(true), 0);
  EXPECT_EQ(encoder.take_null_event(true), std::nullopt) << "taken";
}

TEST(ShaftEncoder, ReportsTheCountOfTheLastNullPositionPassed) {
  ShaftEncoder encoder(Kind::incremental);
  encoder.follow(microsteps_per_count * 100);
  encoder.power_up();
  encoder.follow(microsteps_per_turn * 5 / 2);
  EXPECT_EQ(encoder.take_null_event(false), 2 * 1024 - 100);
  encoder.follow(-microsteps_per_turn / 2);
  EXPECT_EQ(encoder.take_null_event(false), -100);
}

TEST(ShaftEncoder, GivesAnEventInEveryOtherLineAtTheWrongLevelOfTheNullChannel) {
  ShaftEncoder encoder(Kind::incremental);
  int events = 0;
  for (std::int64_t angle = 1; angle <= microsteps_per_turn; ++angle) {
    encoder.follow(angle);
    if (const auto count = encoder.take_null_event(true)) {
      ++events;
      EXPECT_EQ(*count % 4, 0);
      EXPECT_NE(*count % 1024, 0);
    }
  }
  EXPECT_EQ(events, 255);
  EXPECT_EQ(encoder.take_null_event(false), 1024);
}

TEST(ShaftEncoder, IsNearItsNullPositionWithinAFullStep) {
  ShaftEncoder encoder(Kind::absolute);
  for (std::int64_t count = -1024; count <= 2048; ++count) {
    encoder.follow(count * microsteps_per_count);
    const std::int64_t angle = (count + 1024) % 1024;
    EXPECT_EQ(encoder.near_null(), angle <= 5 || angle >= 1024 - 5) << count;
  }
}

RC_GTEST_PROP(ShaftEncoder, MissesNoEventInLeapsThatItSeesInMicrosteps, (bool level)) {
  ShaftEncoder in_leaps(Kind::incremental);
  ShaftEncoder in_microsteps(Kind::incremental);
  std::int64_t angle = 0;
  for (const auto leap : *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(-700, 700))) {
    const std::int64_t target = angle + leap;
    in_leaps.follow(target);
    while (angle != target) in_microsteps.follow(angle += target > angle ? 1 : -1);
    RC_ASSERT(in_leaps.count() == in_microsteps.count());
    RC_ASSERT(in_leaps.take_null_event(level) == in_microsteps.take_null_event(level));
  }
}

}  // namespace
}  // namespace opentmcl::twin
