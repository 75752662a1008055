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
