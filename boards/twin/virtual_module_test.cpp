#include "boards/twin/virtual_module.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "firmware/hal/pins.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl {
namespace {

// The world's table of quantities names the lines of the board.
static_assert(hal::bit(hal::InputPin::in0) == 1 && hal::bit(hal::OutputPin::out0) == 1);
static_assert(hal::bit(hal::InputPin::step_dir_enable) == 1U << twin::step_direction_enable_bit);
static_assert(hal::bit(hal::OutputPin::pull_ups) == 1U << 8 && hal::bit(hal::OutputPin::driver_disable) == 1U << 9);

using testing::ElementsAre;

/// Notes the times at which it was called.
class Visitor : public BenchActor {
 public:
  explicit Visitor(std::vector<Microseconds> times) : times_(std::move(times)) {}

  Microseconds next_act() const override { return came_.size() < times_.size() ? times_[came_.size()] : never; }
  void act(VirtualModule& module) override { came_.push_back(module.now()); }

  const std::vector<Microseconds>& came() const { return came_; }

 private:
  std::vector<Microseconds> times_;
  std::vector<Microseconds> came_;
};

TEST(BenchActor, ComesAtItsTimesHoweverTimeIsCut) {
  for (const Microseconds slice : {Microseconds{1}, Microseconds{7}, Microseconds{100'000}}) {
    VirtualModule module(pd1161, {});
    Visitor visitor({0, 10, 10, 5'000, 99'999});
    module.add_actor(visitor);
    while (module.now() < 100'000) module.advance_to(module.now() + slice);
    EXPECT_THAT(visitor.came(), ElementsAre(0u, 10u, 10u, 5'000u, 99'999u));
    EXPECT_EQ(visitor.next_act(), never);
  }
}

TEST(BenchActor, IsExpectedByTheModule) {
  VirtualModule module(pd1161, {});
  module.advance_to(one_millisecond);
  Visitor visitor({20 * one_millisecond});
  EXPECT_GT(module.next_turn(), 20 * one_millisecond);
  module.add_actor(visitor);
  EXPECT_EQ(module.next_turn(), 20 * one_millisecond);
}

TEST(BenchActor, WhoComesTooLateActsAtOnceAndLosesNothing) {
  VirtualModule module(pd1161, {});
  module.advance_to(one_millisecond);
  Visitor visitor({10, 20, 2 * one_millisecond});
  module.add_actor(visitor);
  module.advance_to(3 * one_millisecond);
  EXPECT_THAT(visitor.came(), ElementsAre(one_millisecond, one_millisecond, 2 * one_millisecond));
}

/// Notes when the firmware takes turns that it would not take by itself.
class Listener : public ExtraTurnObserver {
 public:
  void extra_turn(Microseconds now) override { heard.push_back(now); }

  std::vector<Microseconds> heard;
};

TEST(ExtraTurns, AreTakenWhenSomebodyWakesTheModule) {
  Listener listener;
  VirtualModule::Options options;
  options.extra_turns = &listener;
  VirtualModule module(pd1161, {}, options);
  module.advance_to(1'234'567);
  EXPECT_THAT(listener.heard, ElementsAre());
  const std::uint64_t turns = module.turns();
  module.wake();
  module.wake();
  module.advance_to(module.now());
  module.wake();
  module.advance_to(2'000'000);
  EXPECT_THAT(listener.heard, ElementsAre(1'234'567u, 1'234'567u));
  EXPECT_GE(module.turns(), turns + 2);
}

TEST(ExtraTurns, AreNoneThatAreDueAnyway) {
  Listener listener;
  VirtualModule::Options options;
  options.extra_turns = &listener;
  VirtualModule module(pd1161, {}, options);
  module.wake();  // the first turn after power-on is still to come
  module.advance_to(1'000'000);
  module.power_cycle();
  module.wake();
  module.advance_to(module.now());
  EXPECT_THAT(listener.heard, ElementsAre());
}

/// Wakes the module whenever it comes.
class Waker : public Visitor {
 public:
  using Visitor::Visitor;

  void act(VirtualModule& module) override {
    Visitor::act(module);
    module.wake();
  }
};

TEST(ExtraTurns, AreNotThoseForWhichSomebodyAtTheBenchWakesTheModule) {
  Listener listener;
  VirtualModule::Options options;
  options.extra_turns = &listener;
  VirtualModule module(pd1161, {}, options);
  Waker waker({1'234'567, 1'300'000});
  module.add_actor(waker);
  module.advance_to(1'234'566);
  const std::uint64_t turns = module.turns();
  module.advance_to(1'234'567);
  EXPECT_EQ(module.turns(), turns + 1);
  module.advance_to(2'000'000);
  EXPECT_THAT(listener.heard, ElementsAre());
}

}  // namespace
}  // namespace opentmcl
