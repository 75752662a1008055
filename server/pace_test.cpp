#include "server/pace.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace opentmcl::server {
namespace {

using namespace std::chrono_literals;

constexpr WallTime start{1h};

TEST(Pace, RunsAsFastAsTheWallClockTimesItsSpeed) {
  for (const auto& [speed, expected] :
       {std::pair{1.0, 2'000'000U}, std::pair{10.0, 20'000'000U}, std::pair{0.1, 200'000U}}) {
    Pace pace(speed);
    pace.anchor(start, 500);
    EXPECT_NEAR(500 + expected, static_cast<double>(pace.simulated_at(start + 2s)), 1);
  }
}

TEST(Pace, HasNoGoalAtMaximumSpeed) {
  Pace pace(Pace::maximum);
  pace.anchor(start, 500);
  EXPECT_EQ(never, pace.simulated_at(start));
  EXPECT_EQ(start, pace.wall_at(1'000'000));
}

TEST(Pace, NeverWaitsForNever) {
  Pace pace(0.1);
  pace.anchor(start, 0);
  EXPECT_EQ(WallTime::max(), pace.wall_at(never));
  EXPECT_EQ(WallTime::max(), pace.wall_at(never - 1));
}

TEST(Pace, IsThereThoughTheWaitIsNoRoundNumberOfMicroseconds) {
  Pace pace(1000);
  pace.anchor(start, 1000);
  EXPECT_GE(pace.simulated_at(pace.wall_at(131'073'028)), 131'073'028U);
}

RC_GTEST_PROP(Pace, IsThereWhenItSaidItWouldBe, ()) {
  const double speed = *rc::gen::element(0.01, 0.1, 1.0, 3.0, 10.0, 1000.0);
  const auto target = *rc::gen::inRange<Microseconds>(1000, 10'000'000'000);
  Pace pace(speed);
  pace.anchor(start, 1000);
  RC_ASSERT(pace.simulated_at(pace.wall_at(target)) >= target);
  RC_ASSERT(pace.simulated_at(std::max(start, pace.wall_at(target) - 2us)) <= target);
}

}  // namespace
}  // namespace opentmcl::server
