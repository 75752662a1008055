// Stepping a program in a twin, whose time stands still while the program does.

#include "debug/twin/twin_target.hpp"

#include <gtest/gtest.h>

#include "debug/twin/debugged_twin_test.hpp"

namespace opentmcl::debug {
namespace {

TEST(DebuggedTwin, StandsBeforeItsFirstInstruction) {
  Bench bench(counting);
  EXPECT_EQ(0, bench.engine.stop().address);
  EXPECT_EQ(Stop::Reason::entry, bench.engine.stop().reason);
  EXPECT_EQ(0, value_of(bench.engine.variable(1)));
}

TEST(DebuggedTwin, StepsIntoASubroutine) {
  Bench bench(counting);
  go(bench.engine, Motion::Kind::step);
  EXPECT_EQ(1, bench.engine.stop().address);
  EXPECT_EQ(3, value_of(bench.engine.variable(1)));
  EXPECT_EQ(4, go(bench.engine, Motion::Kind::step).address);
  const std::vector<Frame> frames = bench.engine.frames();
  ASSERT_EQ(2U, frames.size());
  EXPECT_EQ(4, frames[0].address);
  EXPECT_EQ(2, frames[1].address);
}

TEST(DebuggedTwin, StepsOverASubroutine) {
  Bench bench(counting);
  go(bench.engine, Motion::Kind::step);
  EXPECT_EQ(2, go(bench.engine, Motion::Kind::step_over).address);
  EXPECT_EQ(5, value_of(bench.engine.variable(2)));
}

TEST(DebuggedTwin, StepsOutOfASubroutine) {
  Bench bench(counting);
  go(bench.engine, Motion::Kind::run_to, 5);
  EXPECT_EQ(2, go(bench.engine, Motion::Kind::step_out).address);
  const auto outside = bench.engine.go({Motion::Kind::step_out, 0, {}}, always);
  ASSERT_FALSE(outside);
  EXPECT_EQ(client::ErrorKind::usage, outside.error().kind);
}

TEST(DebuggedTwin, EndsAtStop) {
  Bench bench(counting);
  const Stop end = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(Stop::Reason::ended, end.reason);
  EXPECT_EQ(3, end.address);
  EXPECT_EQ(15, value_of(bench.engine.variable(2)));
  EXPECT_FALSE(bench.engine.go({Motion::Kind::step, 0, {}}, always));
  value_of(bench.engine.restart());
  EXPECT_EQ(0, bench.engine.stop().address);
  EXPECT_EQ(0, value_of(bench.engine.variable(2)));
}

TEST(DebuggedTwin, TimeStandsStillWhileTheProgramDoes) {
  Bench bench("ROR 0, 500\nWAIT TICKS, 0, 10\nLoop: JA Loop\n");
  go(bench.engine, Motion::Kind::run_to, 2);
  const auto position = value_of(bench.engine.evaluate("GAP 1, 0"));
  EXPECT_GT(position, 0);
  for (int look = 0; look < 100; ++look) EXPECT_EQ(position, value_of(bench.engine.evaluate("GAP(1)")));
  go(bench.engine, Motion::Kind::step);
  EXPECT_GT(value_of(bench.engine.evaluate("GAP(1)")), position);
}

TEST(DebuggedTwin, AStepOverAWaitEndsWhenTheWaitDoes) {
  Bench bench("WAIT TICKS, 0, 100\nSTOP\n");
  const Moment begin = bench.engine.target().twin()->now();
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::step).address);
  EXPECT_GE(bench.engine.target().twin()->now().time - begin.time, 1'000'000U);
}

TEST(DebuggedTwin, AWaitWithoutEndCanBePausedAndItsBeginGoneBackTo) {
  Bench bench("CALC LOAD, 7\nWAIT REFSW, 0, 0\nSTOP\n");
  go(bench.engine, Motion::Kind::step);
  int asked = 0;
  const Stop paused = value_of(bench.engine.go({Motion::Kind::run, 0, {}}, [&](const Underway& underway) {
    EXPECT_TRUE(underway.waiting);
    return ++asked < 10;
  }));
  EXPECT_EQ(Stop::Reason::pause, paused.reason);
  EXPECT_TRUE(paused.waiting);
  EXPECT_EQ(1, paused.address);
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::reverse_step).address);
  EXPECT_EQ(0, go(bench.engine, Motion::Kind::reverse_step).address);
  EXPECT_EQ(0, value_of(bench.engine.registers()).accumulator);
}

TEST(DebuggedTwin, AMotionHasALimit) {
  Bench bench("Loop: JA Loop\n");
  const client::Duration begin = bench.engine.target().now();
  const Stop stop =
      value_of(bench.engine.go({Motion::Kind::run, 0, client::Duration(std::chrono::seconds(2))}, always));
  EXPECT_EQ(Stop::Reason::limit, stop.reason);
  EXPECT_GE(bench.engine.target().now() - begin, std::chrono::seconds(2));
  EXPECT_LT(bench.engine.target().now() - begin, std::chrono::milliseconds(2500));
}

}  // namespace
}  // namespace opentmcl::debug
