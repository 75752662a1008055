#include "twin/chip/floor_sum.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace opentmcl::twin {
namespace {

std::uint64_t added_up(std::uint64_t count, std::uint64_t first, std::uint64_t slope, std::uint64_t divisor) {
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    sum += (first + slope * i) / divisor;
  }
  return sum;
}

TEST(FloorSum, OfNothingIsZero) {
  EXPECT_EQ(floor_sum(0, 7, 3, 2), 0u);
}

TEST(FloorSum, OfALevelLineIsAProduct) {
  EXPECT_EQ(floor_sum(1000, 7, 0, 2), 3000u);
}

RC_GTEST_PROP(FloorSum, IsWhatAddingUpGives, ()) {
  const auto count = *rc::gen::inRange<std::uint64_t>(0, 3000);
  const auto first = *rc::gen::inRange<std::uint64_t>(0, 1 << 20);
  const auto slope = *rc::gen::inRange<std::uint64_t>(0, 1 << 24);
  const auto divisor = *rc::gen::element<std::uint64_t>(1, 2, 3, 7, 255, 256, 2048, 1'000'003);
  RC_ASSERT(floor_sum(count, first, slope, divisor) == added_up(count, first, slope, divisor));
}

}  // namespace
}  // namespace opentmcl::twin
