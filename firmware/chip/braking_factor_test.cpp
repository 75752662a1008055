#include "firmware/chip/braking_factor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace opentmcl::tmc429 {
namespace {

struct Reference {
  std::int32_t acceleration, ramp_divisor, pulse_divisor;
  BrakingPair pair;
};

// Worked out from the datasheet's description with p reduced by 5 %.
constexpr Reference references[] = {
    {500, 3, 2, {237, 4}}, {500, 7, 5, {237, 5}}, {10, 3, 3, {152, 8}},   {2047, 0, 0, {243, 1}},
    {1, 0, 0, {243, 12}},  {100, 9, 5, {190, 9}}, {2047, 7, 3, {243, 5}}, {1000, 11, 11, {237, 2}},
};

TEST(BrakingFactor, EqualsTheReferenceResults) {
  for (const Reference& reference : references) {
    EXPECT_EQ(braking_pair(reference.acceleration, reference.ramp_divisor, reference.pulse_divisor), reference.pair)
        << reference.acceleration << ' ' << reference.ramp_divisor << ' ' << reference.pulse_divisor;
  }
}

TEST(BrakingFactor, IsAtMostTheIdealFactorAndWithinSixPercentOfItInsideTheLimits) {
  for (std::int32_t ramp = 0; ramp <= maximum_divider; ++ramp) {
    for (std::int32_t pulse = 0; pulse <= maximum_divider; ++pulse) {
      for (std::int32_t acceleration = 1; acceleration <= 2047; ++acceleration) {
        const double ideal = acceleration / (128.0 * std::ldexp(1.0, ramp - pulse));
        const double lower_limit = std::ldexp(1.0, ramp - pulse - 1);
        const double upper_limit = std::ldexp(1.0, ramp - pulse + 12) - 1;
        if (acceleration <= lower_limit * 1.06 || acceleration > upper_limit) continue;
        const BrakingPair pair = braking_pair(acceleration, ramp, pulse);
        const double chosen = pair.multiplier / std::ldexp(8.0, pair.divisor);
        ASSERT_LE(chosen, ideal) << acceleration << ' ' << ramp << ' ' << pulse;
        ASSERT_GE(chosen, ideal * 0.94) << acceleration << ' ' << ramp << ' ' << pulse;
      }
    }
  }
}

TEST(BrakingFactor, IsTheNearestRepresentableOneOutsideTheLimits) {
  EXPECT_EQ(braking_pair(0, 7, 3), (BrakingPair{128, 13}));
  EXPECT_EQ(braking_pair(2047, 0, 13), (BrakingPair{255, 0}));
}

}  // namespace
}  // namespace opentmcl::tmc429
