#include "twin/physics/elementary.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace opentmcl::twin {
namespace {

double arbitrary_between(double lowest, double highest) {
  const auto share = *rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 40U);
  return lowest + (highest - lowest) * static_cast<double>(share) / static_cast<double>(std::int64_t{1} << 40U);
}

TEST(Elementary, TurnsThroughTheQuadrantsExactly) {
  for (int turns = -3; turns <= 3; ++turns) {
    EXPECT_EQ(unit_phasor(turns).along, 1);
    EXPECT_EQ(unit_phasor(turns).across, 0);
    EXPECT_EQ(unit_phasor(turns + 0.25).along, 0);
    EXPECT_EQ(unit_phasor(turns + 0.25).across, 1);
    EXPECT_EQ(unit_phasor(turns + 0.5).along, -1);
    EXPECT_EQ(unit_phasor(turns + 0.75).across, -1);
  }
}

RC_GTEST_PROP(Elementary, SineAndCosineAreWithinFourBillionths, ()) {
  const double turns = arbitrary_between(-1000, 1000);
  const Phasor unit = unit_phasor(turns);
  RC_ASSERT(std::fabs(unit.along - std::cos(turns * radians_per_turn)) < 4e-9);
  RC_ASSERT(std::fabs(unit.across - std::sin(turns * radians_per_turn)) < 4e-9);
}

RC_GTEST_PROP(Elementary, ExponentialIsWithinOneInATrillion, ()) {
  const double exponent = arbitrary_between(-650, 650);
  RC_ASSERT(std::fabs(exponential(exponent) / std::exp(exponent) - 1) < 1e-12);
}

TEST(Elementary, ExponentialOfVeryLittleIsNothing) {
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(-1e9), 0);
}

RC_GTEST_PROP(Elementary, AngleOfAVectorGivesItsDirection, ()) {
  const double turns = arbitrary_between(-0.5, 0.5);
  const double length = arbitrary_between(1e-6, 1e6);
  const Phasor vector{length * std::cos(turns * radians_per_turn), length * std::sin(turns * radians_per_turn)};
  const double angle = angle_in_turns(vector);
  RC_ASSERT(std::fabs(angle - turns) < 1e-12 || std::fabs(std::fabs(angle - turns) - 1) < 1e-12);
}

TEST(Elementary, TheNearestIntegerOfAHalfIsEven) {
  EXPECT_EQ(nearest_integer(0.5), 0);
  EXPECT_EQ(nearest_integer(1.5), 2);
  EXPECT_EQ(nearest_integer(-1.5), -2);
  EXPECT_EQ(nearest_integer(-0.51), -1);
}

}  // namespace
}  // namespace opentmcl::twin
