#include "twin/physics/regime_comparison.hpp"

#include <gtest/gtest.h>

namespace opentmcl::twin {
namespace {

// A share of what regime_comparison measures over 2 x 600 moves (docs/performance.md).
class RegimeComparison : public testing::TestWithParam<double> {};

TEST_P(RegimeComparison, TheFastWayStallsWhenAndOnlyWhenTheFullOneDoes) {
  const auto tables = std::make_shared<TorqueTables>();
  RandomMoves moves(1, GetParam());
  int stalls = 0;
  constexpr int count = 40;
  for (int i = 0; i < count; ++i) {
    const ComparedMove move = moves.next(*tables);
    const MoveResult fast = result_of(move, tables, false);
    const MoveResult full = result_of(move, tables, true);
    ASSERT_EQ(fast.stall_time.has_value(), full.stall_time.has_value()) << "move " << i;
    if (fast.stall_time) {
      ++stalls;
      EXPECT_NEAR(*fast.stall_time, *full.stall_time, 0.020) << "move " << i;
    } else {
      EXPECT_NEAR(fast.mean_lead * 360, full.mean_lead * 360, 1) << "move " << i;
    }
  }
  EXPECT_GT(stalls, count / 8);
  EXPECT_LT(stalls, count * 7 / 8);
}

INSTANTIATE_TEST_SUITE_P(HighestRpm, RegimeComparison, testing::Values(293.0, 586.0));

}  // namespace
}  // namespace opentmcl::twin
