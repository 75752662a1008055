// Every mode of the reference search on every machine on which it makes sense, with switches at random places. What is
// asked of each of the thousand searches: the zero is within one full step of where the dimensions of the machine say.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/machines/search_trial.hpp"

namespace opentmcl::tests {
namespace {

constexpr int searches_of_each_mode = 50;

class ReferenceSearchOn : public testing::TestWithParam<Search> {};

TEST_P(ReferenceSearchOn, PutsItsZeroWithinAFullStep) {
  const Search search = GetParam();
  Dice dice = dice_for(search);
  for (int i = 0; i < searches_of_each_mode; ++i) {
    const Trial trial = random_trial(search, dice);
    SCOPED_TRACE(testing::Message() << "search " << i << ": " << trial);
    EXPECT_LE(std::abs(error_of_zero(search, trial)), microsteps_per_full_step);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryMachine, ReferenceSearchOn, testing::ValuesIn(all_searches()), name_of);

TEST(ReferenceSearches, AreAThousandAtLeast) {
  EXPECT_GE(all_searches().size() * searches_of_each_mode, 1'000u);
}

}  // namespace
}  // namespace opentmcl::tests
