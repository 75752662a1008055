// Members of a farm with a wall clock that the test moves, and that moves by itself while somebody works.
#include "server/farm.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <memory>

#include "boards/twin/virtual_module.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/memory_line.hpp"

namespace opentmcl::server {
namespace {

using namespace std::chrono_literals;

constexpr Request get_position{
    1, {static_cast<std::uint8_t>(Opcode::gap), static_cast<std::uint8_t>(AxisParameter::actual_position), 0, 0}};

/// Has something to do at regular times, and takes the wall clock's time for it.
class Worker final : public Simulated {
 public:
  Worker(Microseconds period, WallTime& wall, WallTime::duration cost) : period_(period), wall_(wall), cost_(cost) {}

  Microseconds now() const override { return now_; }
  Microseconds next_turn() const override { return next_; }
  void wake() override { next_ = now_; }
  void advance_to(Microseconds time) override {
    for (; next_ <= time; next_ += period_) {
      ++work;
      wall_ += cost_;
    }
    now_ = std::max(now_, time);
  }

  int work = 0;

 private:
  Microseconds period_;
  WallTime& wall_;
  WallTime::duration cost_;
  Microseconds now_ = 0;
  Microseconds next_ = 0;
};

struct FarmTest : testing::Test {
  Farm make(std::size_t count, Farm::Options options = {}) {
    return {events, count, options, [this] { return wall; }};
  }
  /// Lets the farm have its turns until the wall clock says `end`.
  void run_until(Farm& farm, WallTime end) {
    while (wall < end) {
      if (farm.next_turn() > wall) wall = std::min(end, farm.next_turn());
      farm.advance(wall);
    }
  }

  boost::asio::io_context events;
  WallTime wall{1h};
};

/// Real modules, each with a host in memory.
struct FarmOfModulesTest : FarmTest {
  struct Member {
    MemoryLine line;
    VirtualModule module{pd1161, {{&line.port(), hal::PortKind::usb}}};
  };

  explicit FarmOfModulesTest(std::size_t count = 3) {
    for (std::size_t i = 0; i < count; ++i) members.push_back(std::make_unique<Member>());
  }
  void set_all(Farm& farm) {
    for (std::size_t i = 0; i < members.size(); ++i) {
      farm.set(i, members[i]->module, {&members[i]->line.port()});
    }
  }
  void send(std::size_t member, const Request& request) { members[member]->line.send(encode(request)); }
  std::size_t replies_of(std::size_t member) { return members[member]->line.received().size() / datagram_size; }

  std::vector<std::unique_ptr<Member>> members;
};

TEST_F(FarmOfModulesTest, AnswersEachMemberAtOnceAtTheTimeThatHasCome) {
  Farm farm = make(3);
  set_all(farm);
  farm.start();
  for (std::size_t i = 0; i < 3; ++i) {
    wall += 12'345us;
    send(i, get_position);
    farm.serve(i, wall);
    EXPECT_EQ(1u, replies_of(i));
  }
}

TEST_F(FarmOfModulesTest, CostsNothingWhileItsMembersWaitForCommands) {
  for (const double speed : {1.0, Pace::maximum}) {
    Farm farm = make(3, {.speed = speed});
    set_all(farm);
    farm.start();
    for (int i = 0; i < 100'000 && farm.next_turn() != WallTime::max(); ++i) {
      wall = std::max(wall, farm.next_turn());
      farm.advance(wall);
    }
    EXPECT_EQ(WallTime::max(), farm.next_turn()) << speed;
  }
}

TEST_F(FarmOfModulesTest, FollowsTheWallClockWithEachMember) {
  Farm farm = make(3, {.speed = 10});
  set_all(farm);
  farm.start();
  for (std::size_t i = 0; i < 3; ++i) {
    send(i, Request{1, {static_cast<std::uint8_t>(Opcode::ror), 0, 0, 500}});
    farm.serve(i, wall);
  }
  run_until(farm, wall + 2s);
  for (const auto& member : members) {
    EXPECT_NEAR(static_cast<double>(member->module.now()), 20e6, 0.1e6);
  }
}

TEST_F(FarmOfModulesTest, EndsAfterTheDurationOfEachMember) {
  Farm farm = make(3, {.speed = Pace::maximum, .duration = 5'000'000});
  set_all(farm);
  farm.run();
  EXPECT_TRUE(farm.is_finished());
  for (const auto& member : members) EXPECT_EQ(5'000'000u, member->module.now());
}

TEST_F(FarmOfModulesTest, EndsWhenItIsStopped) {
  Farm farm = make(3);
  set_all(farm);
  boost::asio::post(events, [&] { farm.stop(); });
  farm.run();
  EXPECT_FALSE(farm.is_finished());
}

TEST_F(FarmOfModulesTest, IsNotDisturbedByAMemberWhosePortIsFlooded) {
  Farm farm = make(3);
  set_all(farm);
  farm.start();
  for (int round = 0; round < 100; ++round) {
    while (!members[0]->line.port().is_full()) send(0, get_position);
    farm.serve(0, wall);
    send(1, get_position);
    farm.serve(1, wall);
    EXPECT_EQ(static_cast<std::size_t>(round + 1), replies_of(1));
    EXPECT_LE(members[0]->line.port().size(), RequestPort::capacity);
    members[0]->line.received().clear();
    wall += 1ms;
  }
}

TEST_F(FarmOfModulesTest, IsNotDisturbedByAMemberWhoseProgramIsBroken) {
  Farm farm = make(3);
  set_all(farm);
  farm.start();
  const auto ask = [&](std::size_t member, const Request& request) {
    send(member, request);
    farm.serve(member, wall);
    run_until(farm, wall + 20ms);
  };
  // A jump to itself, and behind it bytes that are no instruction: the program memory holds whatever it is sent.
  const Request download[] = {{1, {132, 0, 0, 0}}, {1, {22, 0, 0, 0}},  {1, {133, 0, 0, 0}},
                              {1, {132, 0, 0, 1}}, {1, {99, 77, 5, 1}}, {1, {133, 0, 0, 0}}};
  for (const Request& request : download) {
    ask(0, request);
    ask(2, request);
  }
  ask(0, {1, {129, 0, 0, 0}});
  ask(2, {1, {129, 1, 0, 1}});
  const std::size_t before = replies_of(1);
  for (int i = 0; i < 50; ++i) {
    send(1, get_position);
    farm.serve(1, wall);
    run_until(farm, wall + 10ms);
  }
  EXPECT_EQ(before + 50, replies_of(1));
  // The broken ones still answer.
  for (const std::size_t broken : {std::size_t{0}, std::size_t{2}}) {
    const std::size_t answered = replies_of(broken);
    ask(broken, get_position);
    EXPECT_EQ(answered + 1, replies_of(broken));
  }
}

TEST_F(FarmTest, SpreadsTheTurnsOfMembersThatAreAllAlike) {
  constexpr std::size_t count = 2000;
  constexpr Microseconds as_the_firmware_of_a_moving_motor = 10'000;
  Farm farm = make(count);
  std::vector<std::unique_ptr<Worker>> workers;
  for (std::size_t i = 0; i < count; ++i) {
    workers.push_back(std::make_unique<Worker>(as_the_firmware_of_a_moving_motor, wall, 0us));
    farm.set(i, *workers.back(), {});
  }
  farm.start();
  run_until(farm, wall + 100ms);
  std::uint64_t most = 0;
  for (int millisecond = 0; millisecond < 100; ++millisecond) {
    const std::uint64_t before = farm.turns();
    run_until(farm, wall + 1ms);
    most = std::max(most, farm.turns() - before);
  }
  // 200 a millisecond on average.
  EXPECT_LT(most, 500u);
  for (const auto& worker : workers) EXPECT_NEAR(worker->work, 20, 2);
}

TEST_F(FarmTest, LetsOthersKeepTheirTimeWhileOneIsFarTooSlow) {
  Farm farm = make(3);
  Worker slow(100, wall, 300us);
  Worker first(10'000, wall, 1us);
  Worker second(10'000, wall, 1us);
  farm.set(0, slow, {});
  farm.set(1, first, {});
  farm.set(2, second, {});
  farm.start();
  const WallTime begin = wall;
  run_until(farm, begin + 2s);
  EXPECT_NEAR(first.work, 200, 3);
  EXPECT_NEAR(second.work, 200, 3);
  EXPECT_GT(slow.work, 1000) << "it gets what is left";
}

TEST_F(FarmTest, HasTheirTurnsQuicklyWhenAllAreLate) {
  constexpr std::size_t count = 2000;
  Farm farm = make(count);
  std::vector<std::unique_ptr<Worker>> workers;
  for (std::size_t i = 0; i < count; ++i) {
    workers.push_back(std::make_unique<Worker>(10'000, wall, 3us));
    farm.set(i, *workers.back(), {});
  }
  farm.start();
  // The computer has had no time for the farm.
  wall += 30s;
  const WallTime begin = wall;
  while (farm.turns() < 2 * count) farm.advance(wall);
  EXPECT_LT(wall - begin, 150ms) << "a request would wait that long in the worst case";
}

TEST_F(FarmTest, GivesEachTheSameShareAtMaximumSpeed) {
  Farm farm = make(3, {.speed = Pace::maximum});
  std::vector<std::unique_ptr<Worker>> workers;
  for (std::size_t i = 0; i < 3; ++i) {
    workers.push_back(std::make_unique<Worker>(1'000, wall, 10us));
    farm.set(i, *workers.back(), {});
  }
  farm.start();
  run_until(farm, wall + 1s);
  for (const auto& worker : workers) EXPECT_NEAR(worker->work, 33'333, 200);
}

TEST_F(FarmTest, EndsARoundAfterAMillisecondHoweverManyAreDue) {
  Farm farm = make(100);
  std::vector<std::unique_ptr<Worker>> workers;
  for (std::size_t i = 0; i < 100; ++i) {
    workers.push_back(std::make_unique<Worker>(1'000, wall, 100us));
    farm.set(i, *workers.back(), {});
  }
  farm.start();
  wall += 50ms;
  const WallTime begin = wall;
  farm.advance(wall);
  EXPECT_LE(wall - begin, Farm::longest_round + Farm::longest_slice + 1ms);
  EXPECT_LE(farm.next_turn(), wall) << "the rest follows when hosts have been heard";
}

}  // namespace
}  // namespace opentmcl::server
