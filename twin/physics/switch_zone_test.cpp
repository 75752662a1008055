#include "twin/physics/switch_zone.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace opentmcl::twin {
namespace {

/// One unit of place is 1 microstep, from 100 to 200.
SwitchZone zone_with(std::int64_t hysteresis, std::int64_t period = 0) {
  return SwitchZone({.from = 100, .to = 200, .hysteresis = hysteresis, .period = period},
                    PlaceScale(microsteps_per_turn, 1, 0));
}

TEST(SwitchZone, IsLeftFurtherOutThanItIsEntered) {
  const SwitchZone zone = zone_with(10);
  EXPECT_FALSE(zone.holds_after(false, 0, 99));
  EXPECT_TRUE(zone.holds_after(false, 99, 100));
  EXPECT_TRUE(zone.holds_after(true, 150, 210));
  EXPECT_FALSE(zone.holds_after(true, 210, 211));
  EXPECT_FALSE(zone.holds_after(false, 211, 201));
  EXPECT_TRUE(zone.holds_after(false, 201, 200));
  EXPECT_TRUE(zone.holds_after(true, 100, 90));
  EXPECT_FALSE(zone.holds_after(true, 90, 89));
}

TEST(SwitchZone, IsHeldWithinTheHysteresisByAWayThatLeadsThroughIt) {
  const SwitchZone zone = zone_with(10);
  EXPECT_TRUE(zone.holds_after(false, 0, 205));
  EXPECT_TRUE(zone.holds_after(false, 300, 95));
  EXPECT_FALSE(zone.holds_after(false, 0, 300)) << "passed without a trace";
}

TEST(SwitchZone, IsNeverHeldWhenItIsNarrowerThanAMicrostep) {
  const SwitchZone zone({.from = 101, .to = 102, .hysteresis = 50, .period = 0},
                        PlaceScale(100 * microsteps_per_turn, 1, 0));
  EXPECT_FALSE(zone.holds_after(false, 0, 2));
  EXPECT_EQ(zone.next_change(false, 0), EventDistance{});
}

/// Random zones, and a way through several periods of them.
RC_GTEST_PROP(SwitchZone, ChangesWhereItSaysAndInLeapsAsInMicrosteps, ()) {
  const auto width = *rc::gen::inRange<std::int64_t>(0, 50'000);
  const auto hysteresis = *rc::gen::element<std::int64_t>(0, *rc::gen::inRange(0, 5'000));
  const auto gap = *rc::gen::inRange<std::int64_t>(1'000, 60'000);
  const SwitchPlaces places{.from = *rc::gen::inRange(-20'000, 20'000),
                            .to = 0,
                            .hysteresis = hysteresis,
                            .period = *rc::gen::arbitrary<bool>() ? width + 2 * hysteresis + gap : 0};
  SwitchPlaces placed = places;
  placed.to = placed.from + width;
  const SwitchZone zone(placed, PlaceScale(*rc::gen::inRange(500'000, 20'000'000), *rc::gen::inRange(1, 9), 7));

  std::int64_t angle = *rc::gen::inRange(-3'000, 3'000);
  bool held = zone.presses_at(angle);
  for (int leap = 0; leap < 20; ++leap) {
    const std::int64_t before = angle;
    const bool held_before = held;
    const std::int64_t target = angle + *rc::gen::inRange(-2'000, 2'000);
    while (angle != target) {
      const EventDistance distance = zone.next_change(held, angle);
      const std::int64_t step = target > angle ? 1 : -1;
      const bool now = zone.holds_after(held, angle, angle + step);
      RC_ASSERT((now != held) == ((step > 0 ? distance.up : distance.down) == 1));
      held = now;
      angle += step;
    }
    RC_ASSERT(zone.holds_after(held_before, before, target) == held);
  }
}

}  // namespace
}  // namespace opentmcl::twin
