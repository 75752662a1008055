#include "twin/physics/contact.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace opentmcl::twin {
namespace {

TEST(Contact, OpensOrClosesWhileItsSwitchIsHeld) {
  for (const bool held : {false, true}) {
    BouncingContact::State state;
    BouncingContact::change(state, held, 100);
    EXPECT_EQ(BouncingContact(Contact::normally_closed, 0, 0).is_open(state, 100), held);
    EXPECT_EQ(BouncingContact(Contact::normally_open, 0, 0).is_open(state, 100), !held);
  }
}

TEST(Contact, StandsStillWithoutBounceAndBeforeItsFirstChange) {
  BouncingContact::State state;
  EXPECT_EQ(BouncingContact(Contact::normally_closed, 16'000, 0).next_change(state, 5), never_tick);
  EXPECT_FALSE(BouncingContact(Contact::normally_closed, 16'000, 0).is_open(state, 5));
  BouncingContact::change(state, true, 10);
  EXPECT_EQ(BouncingContact(Contact::normally_closed, 0, 0).next_change(state, 10), never_tick);
}

TEST(Contact, ChattersDifferentlyEachTimeAndInEachSwitch) {
  const auto pattern = [](std::uint32_t seed, std::uint32_t changes) {
    const BouncingContact contact(Contact::normally_open, BouncingContact::parts, seed);
    std::uint32_t levels = 0;
    for (Tick tick = 0; tick < BouncingContact::parts; ++tick) {
      levels = levels * 2 + (contact.is_open({true, changes, 0}, tick) ? 1 : 0);
    }
    return levels;
  };
  EXPECT_NE(pattern(0, 1), pattern(0, 3));
  EXPECT_NE(pattern(0, 1), pattern(1, 1));
  EXPECT_EQ(pattern(0, 1), pattern(0, 1));
}

RC_GTEST_PROP(Contact, ChattersForItsTimeAndEndsInTheTrueState, (std::uint32_t seed, std::uint8_t changes_before)) {
  const auto bounce = *rc::gen::inRange<Tick>(1, 200'000);
  const BouncingContact contact(Contact::normally_open, bounce, seed);
  BouncingContact::State state{false, changes_before, 0};
  const Tick begin = *rc::gen::inRange<Tick>(1, 1'000'000);
  BouncingContact::change(state, true, begin);
  RC_ASSERT(!contact.is_open(state, begin));
  RC_ASSERT(contact.next_change(state, begin) == begin + contact.shortest_change());

  // From one announced change to the next: every announced one is one, and none comes too early.
  unsigned changes = 0;
  bool open = false;
  Tick last = begin;
  for (Tick tick = contact.next_change(state, begin); tick != never_tick; tick = contact.next_change(state, tick)) {
    RC_ASSERT(tick - last >= contact.shortest_change());
    RC_ASSERT(contact.is_open(state, tick - 1) == open);
    RC_ASSERT(contact.is_open(state, tick) == !open);
    open = !open;
    last = tick;
    ++changes;
  }
  RC_ASSERT(changes >= 2u);
  RC_ASSERT(!open);
  RC_ASSERT(last < begin + bounce + BouncingContact::parts);
  RC_ASSERT(!contact.is_open(state, *rc::gen::inRange<Tick>(last, last + 10 * bounce + 1)));
}

RC_GTEST_PROP(Contact, AnnouncesTheNextChangeWheneverItIsAsked, (std::uint32_t seed)) {
  const BouncingContact contact(Contact::normally_closed, 160, seed);
  const BouncingContact::State state{true, 7, 1'000};
  const auto tick = *rc::gen::inRange<Tick>(1'000, 1'200);
  const Tick next = contact.next_change(state, tick);
  const Tick end = next == never_tick ? 1'300 : next;
  for (Tick between = tick; between < end; ++between) {
    RC_ASSERT(contact.is_open(state, between) == contact.is_open(state, tick));
  }
  if (next != never_tick) RC_ASSERT(contact.is_open(state, next) != contact.is_open(state, tick));
}

}  // namespace
}  // namespace opentmcl::twin
