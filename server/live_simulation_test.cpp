#include "server/live_simulation.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/memory_line.hpp"

namespace opentmcl::server {
namespace {

using namespace std::chrono_literals;

constexpr Microseconds one_second = 1'000'000;

/// A module at a port in memory, and a wall clock that the test moves.
struct LiveSimulationTest : testing::Test {
  LiveSimulation make(LiveSimulation::Options options) {
    return {events, module, {&line.port()}, options, [this] { return now(); }};
  }
  WallTime now() { return wall += clock_cost; }
  std::int32_t get(LiveSimulation& simulation, AxisParameter parameter) {
    line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), static_cast<std::uint8_t>(parameter), 0, 0}}));
    simulation.serve(now());
    return take_reply().value;
  }
  Reply take_reply() {
    Datagram datagram;
    EXPECT_EQ(datagram_size, line.received().size());
    std::copy(line.received().begin(), line.received().end(), datagram.bytes);
    line.received().clear();
    EXPECT_TRUE(datagram.checksum_is_right());
    return decode_reply(datagram);
  }
  /// Until the module only waits for commands: some seconds after the start it lowers the motor's current.
  void settle(LiveSimulation& simulation) {
    for (int i = 0; i < 100'000 && simulation.next_turn() != WallTime::max(); ++i) {
      wall = std::max(wall, simulation.next_turn());
      simulation.advance(now());
    }
  }
  void rotate(LiveSimulation& simulation) {
    line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::ror), 0, 0, 500}}));
    simulation.serve(now());
    take_reply();
  }

  boost::asio::io_context events;
  MemoryLine line;
  VirtualModule module{pd1161, {{&line.port(), hal::PortKind::usb}}};
  WallTime wall{1h};
  WallTime::duration clock_cost{0};  // how much later it is at each look at the clock
};

TEST_F(LiveSimulationTest, FollowsTheWallClockAtItsSpeed) {
  LiveSimulation simulation = make({.speed = 10});
  simulation.start();
  wall += 2s;
  while (module.now() < 20 * one_second) simulation.advance(now());
  EXPECT_EQ(20 * one_second, module.now());
}

TEST_F(LiveSimulationTest, AnswersAtOnceAtTheTimeThatHasCome) {
  LiveSimulation simulation = make({});
  simulation.start();
  wall += 123456us;
  EXPECT_EQ(0, get(simulation, AxisParameter::actual_position));
  EXPECT_EQ(123456u, module.now());
}

TEST_F(LiveSimulationTest, AnswersEveryRequestThatIsThere) {
  LiveSimulation simulation = make({});
  simulation.start();
  for (int i = 0; i < 100; ++i) {
    line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}}));
  }
  simulation.serve(now());
  EXPECT_EQ(100 * datagram_size, line.received().size());
}

TEST_F(LiveSimulationTest, SleepsUntilAnEventWhileTheModuleOnlyWaitsForCommands) {
  for (const double speed : {1.0, Pace::maximum}) {
    LiveSimulation simulation = make({.speed = speed});
    simulation.start();
    settle(simulation);
    EXPECT_EQ(WallTime::max(), simulation.next_turn()) << speed;
  }
}

TEST_F(LiveSimulationTest, NeedsNoTimerAfterARequestThatChangesNothing) {
  LiveSimulation simulation = make({.speed = 1});
  simulation.start();
  settle(simulation);
  get(simulation, AxisParameter::actual_position);
  EXPECT_EQ(WallTime::max(), simulation.next_turn());
}

TEST_F(LiveSimulationTest, AnswersRequestsAndStopsInItsOwnLoop) {
  LiveSimulation simulation = make({.speed = 1});
  boost::asio::post(events, [&] {
    line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}}));
    simulation.serve(now());
    boost::asio::post(events, [&] { simulation.stop(); });
  });
  simulation.run();
  EXPECT_EQ(datagram_size, line.received().size());
}

TEST_F(LiveSimulationTest, LeavesTheComputerAMillisecondBetweenTurns) {
  LiveSimulation simulation = make({.speed = 1});
  simulation.start();
  rotate(simulation);
  simulation.advance(now());
  EXPECT_GE(simulation.next_turn(), wall + LiveSimulation::shortest_turn);
}

TEST_F(LiveSimulationTest, RunsAtMaximumSpeedOnlyWhileThereIsSomethingToSimulate) {
  LiveSimulation simulation = make({.speed = Pace::maximum});
  clock_cost = 100us;
  simulation.start();
  settle(simulation);
  const Microseconds idle_since = module.now();
  wall += 1h;
  simulation.advance(now());
  EXPECT_EQ(idle_since, module.now());

  rotate(simulation);
  simulation.advance(now());
  EXPECT_GT(module.now(), idle_since);
  EXPECT_LE(simulation.next_turn(), wall);
}

TEST_F(LiveSimulationTest, LooksAtTheEventLoopBetweenSlices) {
  LiveSimulation simulation = make({.speed = Pace::maximum});
  clock_cost = 500us;
  simulation.start();
  rotate(simulation);
  const WallTime begin = wall;
  simulation.advance(now());
  EXPECT_LE(wall - begin, 2 * LiveSimulation::longest_slice);
}

TEST_F(LiveSimulationTest, GoesOnFromWhereItIsWhenTheComputerIsTooSlow) {
  LiveSimulation simulation = make({.speed = 1000});
  clock_cost = 1ms;
  simulation.start();
  rotate(simulation);
  for (int i = 0; i < 200; ++i) simulation.advance(now());
  const Microseconds reached = module.now();
  clock_cost = 0us;
  EXPECT_LE(simulation.next_turn(), wall + 50ms);
  wall += 1ms;
  while (simulation.next_turn() <= wall) simulation.advance(now());
  EXPECT_LE(module.now(), reached + 60 * one_second);
}

TEST_F(LiveSimulationTest, EndsAfterItsDurationOfSimulatedTime) {
  module.advance_to(one_second);
  LiveSimulation simulation = make({.speed = Pace::maximum, .duration = 5 * one_second});
  simulation.run();
  EXPECT_EQ(6 * one_second, module.now());
  EXPECT_TRUE(simulation.is_finished());
}

TEST_F(LiveSimulationTest, StandsStillAndAnswersNothingWhilePaused) {
  LiveSimulation simulation = make({});
  simulation.start();
  simulation.pause();
  wall += 5s;
  line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}}));
  simulation.serve(now());
  simulation.advance(now());
  EXPECT_EQ(0u, module.now());
  EXPECT_TRUE(line.received().empty());
  EXPECT_EQ(WallTime::max(), simulation.next_turn());

  simulation.resume();
  EXPECT_EQ(0u, module.now());
  EXPECT_EQ(datagram_size, line.received().size());
  wall += 1s;
  simulation.advance(now());
  EXPECT_EQ(one_second, module.now());
}

TEST_F(LiveSimulationTest, ChangesItsSpeedFromNowOn) {
  LiveSimulation simulation = make({.speed = 1});
  simulation.start();
  rotate(simulation);
  wall += 1s;
  simulation.advance(now());
  simulation.set_speed(10);
  EXPECT_EQ(10, simulation.speed());
  wall += 1s;
  simulation.advance(now());
  EXPECT_EQ(11 * one_second, module.now());
}

TEST_F(LiveSimulationTest, RunsToAGoalFlatOutAndIsPausedThen) {
  LiveSimulation simulation = make({});
  clock_cost = 100us;
  simulation.start();
  rotate(simulation);
  std::optional<LiveSimulation::Outcome> outcome;
  simulation.run_to({.time = 100 * one_second}, 1h, [&](LiveSimulation::Outcome how) { outcome = how; });
  EXPECT_FALSE(outcome) << "the event loop has to be looked at in between";
  while (!outcome) simulation.advance(now());
  EXPECT_EQ(LiveSimulation::Outcome::reached, outcome);
  EXPECT_EQ(100 * one_second, module.now());
  EXPECT_TRUE(simulation.is_paused());
  EXPECT_FALSE(simulation.is_running_to_goal());
}

TEST_F(LiveSimulationTest, AnswersRequestsOnTheWayToAGoal) {
  LiveSimulation simulation = make({});
  simulation.start();
  simulation.pause();
  line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}}));
  int done = 0;
  simulation.run_to({.time = 1000}, 1h, [&](LiveSimulation::Outcome) { ++done; });
  EXPECT_EQ(1, done);
  EXPECT_EQ(datagram_size, line.received().size());
  EXPECT_EQ(1000u, module.now());
}

TEST_F(LiveSimulationTest, GivesUpAGoalThatTakesTooLong) {
  LiveSimulation simulation = make({});
  clock_cost = 100us;
  simulation.start();
  rotate(simulation);
  std::optional<LiveSimulation::Outcome> outcome;
  const WallTime begin = wall;
  simulation.run_to({.time = never - 1}, 50ms, [&](LiveSimulation::Outcome how) { outcome = how; });
  while (!outcome) simulation.advance(now());
  EXPECT_EQ(LiveSimulation::Outcome::out_of_time, outcome);
  EXPECT_LE(wall - begin, 50ms + 2 * LiveSimulation::longest_slice);
  EXPECT_TRUE(simulation.is_paused());
}

TEST_F(LiveSimulationTest, GivesUpAGoalWhenSomebodyPauses) {
  LiveSimulation simulation = make({});
  clock_cost = 100us;
  simulation.start();
  rotate(simulation);
  std::optional<LiveSimulation::Outcome> outcome;
  simulation.run_to({.time = never - 1}, 1h, [&](LiveSimulation::Outcome how) { outcome = how; });
  simulation.pause();
  EXPECT_EQ(LiveSimulation::Outcome::given_up, outcome);
}

TEST_F(LiveSimulationTest, TakesAsManyTurnsAsItIsTold) {
  LiveSimulation simulation = make({});
  simulation.start();
  rotate(simulation);
  for (const std::uint64_t turns : {1U, 1U, 5U, 100U}) {
    const std::uint64_t goal = module.turns() + turns;
    std::optional<LiveSimulation::Outcome> outcome;
    simulation.run_to({.turns = goal}, 1h, [&](LiveSimulation::Outcome how) { outcome = how; });
    EXPECT_EQ(LiveSimulation::Outcome::reached, outcome);
    EXPECT_EQ(goal, module.turns());
  }
}

TEST_F(LiveSimulationTest, SaysThatThereAreNoMoreTurnsToTake) {
  LiveSimulation simulation = make({});
  simulation.start();
  settle(simulation);
  const Microseconds before = module.now();
  std::optional<LiveSimulation::Outcome> outcome;
  simulation.run_to({.turns = module.turns() + 1}, 1h, [&](LiveSimulation::Outcome how) { outcome = how; });
  EXPECT_EQ(LiveSimulation::Outcome::nothing_to_do, outcome);
  EXPECT_EQ(before, module.now());
}

struct NotingWatcher final : Watcher {
  explicit NotingWatcher(const VirtualModule& watched) : module(watched) {}
  Microseconds next_look() const override { return next; }
  void look() override {
    looks.push_back(module.now());
    next += 777;
  }
  const VirtualModule& module;
  Microseconds next = 777;
  std::vector<Microseconds> looks;
};

TEST_F(LiveSimulationTest, LetsAWatcherLookAtItsTimesAtAnySpeed) {
  for (const double speed : {1.0, 100.0, Pace::maximum}) {
    VirtualModule watched{pd1161, {}};
    NotingWatcher watcher(watched);
    LiveSimulation simulation{events, watched, {}, {.speed = speed, .duration = 50'000}, [this] { return now(); }};
    simulation.set_watcher(&watcher);
    simulation.start();
    while (!simulation.is_finished()) {
      ASSERT_NE(WallTime::max(), simulation.next_turn());
      wall = std::max(wall, simulation.next_turn());
      simulation.advance(now());
    }
    std::vector<Microseconds> expected;
    for (Microseconds time = 777; time <= 50'000; time += 777) expected.push_back(time);
    EXPECT_EQ(expected, watcher.looks) << speed;
  }
}

TEST_F(LiveSimulationTest, RunsAnotherModuleFromWhereThatIs) {
  LiveSimulation simulation = make({});
  simulation.start();
  wall += 1s;
  simulation.advance(now());
  VirtualModule other{pd1161, {}};
  simulation.carry(other);
  wall += 1s;
  simulation.advance(now());
  EXPECT_EQ(one_second, module.now());
  EXPECT_EQ(one_second, other.now());
}

TEST_F(LiveSimulationTest, EndsWhenItIsStopped) {
  LiveSimulation simulation = make({});
  int turns = 0;
  simulation.after_turn([&] { ++turns; });
  boost::asio::post(events, [&] { simulation.stop(); });
  simulation.run();
  EXPECT_GT(turns, 0);
}

}  // namespace
}  // namespace opentmcl::server
