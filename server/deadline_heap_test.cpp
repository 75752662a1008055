#include "server/deadline_heap.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

namespace opentmcl::server {
namespace {

WallTime at(int milliseconds) {
  return WallTime{std::chrono::milliseconds(milliseconds)};
}

TEST(DeadlineHeap, KnowsNobodyWhoIsDueAtFirst) {
  EXPECT_EQ(WallTime::max(), DeadlineHeap(0).first_deadline());
  EXPECT_EQ(WallTime::max(), DeadlineHeap(7).first_deadline());
}

TEST(DeadlineHeap, GivesTheEarliestHoweverDeadlinesChange) {
  EXPECT_TRUE(rc::check("the first deadline is the earliest, and that of the first member", [] {
    const auto count = *rc::gen::inRange<std::size_t>(1, 50);
    DeadlineHeap heap(count);
    std::vector<WallTime> expected(count, WallTime::max());
    const auto changes = *rc::gen::container<std::vector<std::pair<std::size_t, int>>>(
        rc::gen::pair(rc::gen::inRange<std::size_t>(0, count), rc::gen::inRange(0, 100)));
    for (const auto& [member, time] : changes) {
      expected[member] = time == 0 ? WallTime::max() : at(time);
      heap.set(member, expected[member]);
      RC_ASSERT(heap.first_deadline() == *std::min_element(expected.begin(), expected.end()));
      RC_ASSERT(expected[heap.first()] == heap.first_deadline());
    }
  }));
}

}  // namespace
}  // namespace opentmcl::server
