#include "firmware/tmcl/instruction_cache.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstddef>
#include <map>
#include <vector>

namespace opentmcl {
namespace {

constexpr std::uint16_t capacity = 2048;

DecodedInstruction instruction_with(std::int32_t value) {
  return {nullptr, {0, 0, 0, value}};
}

TEST(InstructionCache, IsEmptyAtTheStart) {
  const InstructionCache cache;
  // One more than there are: the address a program reaches that runs over its end.
  for (std::uint16_t address = 0; address <= capacity; ++address) {
    ASSERT_EQ(cache.find(address), nullptr) << address;
    ASSERT_EQ(cache.find_contained(address), nullptr) << address;
  }
}

TEST(InstructionCache, HoldsAProgramOfItsSizeWhereverThatLies) {
  for (const int start : {0, 1, 255, 1000, 1792}) {
    InstructionCache cache;
    for (std::uint16_t n = 0; n < InstructionCache::line_count; ++n) {
      cache.insert(static_cast<std::uint16_t>(start + n), instruction_with(n), Reach::program);
    }
    for (std::uint16_t n = 0; n < InstructionCache::line_count; ++n) {
      const DecodedInstruction* const found = cache.find(static_cast<std::uint16_t>(start + n));
      ASSERT_NE(found, nullptr) << start << " + " << n;
      ASSERT_EQ(found->command.value, n);
    }
  }
}

TEST(InstructionCache, FindsAsContainedOnlyWhatReachesNoFurtherThanTheProgram) {
  InstructionCache cache;
  cache.insert(7, instruction_with(1), Reach::program);
  cache.insert(8, instruction_with(2), Reach::module);
  EXPECT_EQ(cache.find_contained(7), cache.find(7));
  EXPECT_EQ(cache.find_contained(8), nullptr);
  ASSERT_NE(cache.find(8), nullptr);
  EXPECT_EQ(cache.find(8)->command.value, 2);
}

RC_GTEST_PROP(InstructionCache, NeverGivesAnythingButWhatWasInsertedLast, ()) {
  InstructionCache cache;
  std::map<std::uint16_t, std::int32_t> inserted;
  const auto addresses = *rc::gen::container<std::vector<std::uint16_t>>(*rc::gen::inRange<std::size_t>(0, 400),
                                                                         rc::gen::inRange<std::uint16_t>(0, capacity));
  std::int32_t value = 0;
  for (const std::uint16_t address : addresses) {
    const int action = *rc::gen::weightedElement<int>({{8, 0}, {3, 1}, {1, 2}});
    if (action == 0) {
      cache.insert(address, instruction_with(++value), *rc::gen::element(Reach::program, Reach::module));
      inserted[address] = value;
    } else if (action == 1) {
      cache.forget(address);
      inserted.erase(address);
    } else {
      cache.clear();
      inserted.clear();
    }
    for (std::uint16_t asked = 0; asked < capacity; ++asked) {
      const DecodedInstruction* const found = cache.find(asked);
      if (found == nullptr) continue;
      RC_ASSERT(inserted.count(asked) == 1U);
      RC_ASSERT(found->command.value == inserted[asked]);
    }
  }
}

}  // namespace
}  // namespace opentmcl
