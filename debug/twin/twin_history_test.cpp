// Back in time: whatever an engine with a twin does forward it can undo, and stepping is the same as running.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <utility>

#include "debug/random_program_test.hpp"
#include "debug/twin/debugged_twin_test.hpp"
#include "scenario/scenario_file.hpp"

namespace opentmcl::debug {
namespace {

using testing::ElementsAre;

TEST(DebuggedTwin, StepsBackToTheBeginAndNoFurther) {
  Bench bench(counting);
  go(bench.engine, Motion::Kind::step);
  go(bench.engine, Motion::Kind::step);
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::reverse_step).address);
  EXPECT_EQ(0, go(bench.engine, Motion::Kind::reverse_step).address);
  EXPECT_EQ(0, value_of(bench.engine.variable(1)));
  EXPECT_EQ(Stop::Reason::beginning, go(bench.engine, Motion::Kind::reverse_step).reason);
}

TEST(DebuggedTwin, StepsBackFromItsEnd) {
  Bench bench(counting);
  go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(3, go(bench.engine, Motion::Kind::reverse_step).address);
  EXPECT_EQ(2, go(bench.engine, Motion::Kind::reverse_step).address);
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::reverse_step_over).address);
  EXPECT_EQ(10, value_of(bench.engine.variable(2)));
}

TEST(DebuggedTwin, GoesBackOutOfASubroutine) {
  Bench bench(counting);
  go(bench.engine, Motion::Kind::run_to, 6);
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::reverse_step_out).address);
}

TEST(DebuggedTwin, WhatTheUserDidIsDoneAgainOnTheWayForth) {
  Bench bench(counting);
  go(bench.engine, Motion::Kind::run_to, 6);
  expect_done(bench.engine.set_variable(2, 100));
  expect_done(bench.engine.set_accumulator(1000));
  go(bench.engine, Motion::Kind::step);
  EXPECT_EQ(1000, value_of(bench.engine.variable(2)));
  for (int i = 0; i < 3; ++i) go(bench.engine, Motion::Kind::reverse_step);
  EXPECT_EQ(0, value_of(bench.engine.variable(2)));
  for (int i = 0; i < 3; ++i) go(bench.engine, Motion::Kind::step);
  EXPECT_EQ(1000, value_of(bench.engine.variable(2)));
  // Something new makes another future.
  for (int i = 0; i < 3; ++i) go(bench.engine, Motion::Kind::reverse_step);
  expect_done(bench.engine.set_variable(2, 7));
  go(bench.engine, Motion::Kind::run_to, 7);
  EXPECT_EQ(12, value_of(bench.engine.variable(2)));
}

TEST(DebuggedTwin, WhatWasSetAtTheBenchIsSetAgainOnTheWayForth) {
  Bench bench("Loop: GIO 1, 0\nJA Loop\n");
  for (int i = 0; i < 4; ++i) go(bench.engine, Motion::Kind::step);
  expect_done(bench.engine.target().twin()->set_quantity("input.1", 1));
  go(bench.engine, Motion::Kind::step);
  const Seen after = see(bench.engine);
  EXPECT_EQ(1, after.accumulator);
  for (int i = 0; i < 3; ++i) go(bench.engine, Motion::Kind::reverse_step);
  EXPECT_EQ(0, see(bench.engine).accumulator);
  for (int i = 0; i < 3; ++i) go(bench.engine, Motion::Kind::step);
  EXPECT_EQ(after, see(bench.engine));
}

/// Parameter 207 says what has stopped the motor, and forgets it.
TEST(DebuggedTwin, AReadThatAcknowledgesIsDoneAgainOnTheWayForth) {
  Bench bench(into_the_end, near_the_end());
  constexpr auto stall = static_cast<std::uint8_t>(Trouble::stall);
  bench.engine.stop_at_troubles(stall);
  ASSERT_EQ(Stop::Reason::trouble,
            value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(10)}, always)).reason);
  TwinPowers& twin = *bench.engine.target().twin();
  EXPECT_EQ(stall, twin.troubles());
  EXPECT_EQ(1, value_of(bench.engine.evaluate("GAP 207, 0")));
  EXPECT_EQ(0, twin.troubles());
  for (int i = 0; i < 3; ++i) go(bench.engine, Motion::Kind::step);
  for (int i = 0; i < 2; ++i) go(bench.engine, Motion::Kind::reverse_step);
  EXPECT_EQ(0, twin.troubles());
}

TEST(DebuggedTwin, NoTimePassesForSomebodyWhoWaitsWhileTheProgramStands) {
  Bench bench(counting);
  const Moment moment = bench.engine.target().twin()->now();
  bench.twin.client().transport().pause(std::chrono::seconds(1));
  EXPECT_EQ(moment, bench.engine.target().twin()->now());
}

TEST(DebuggedTwin, GoesBackOverAWaitAsAWhole) {
  Bench bench("CSUB Sub\nSTOP\nSub: WAIT TICKS, 0, 10\nRSUB\n");
  go(bench.engine, Motion::Kind::step);
  const Seen before = see(bench.engine);
  go(bench.engine, Motion::Kind::step);
  go(bench.engine, Motion::Kind::reverse_step_over);
  EXPECT_EQ(before, see(bench.engine));
}

TEST(DebuggedTwin, GoesBackToAChangeBeforeThisOne) {
  Bench bench(counting);
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::change;
  request.subject = "VAR(2)";
  value_of(bench.engine.add(request));
  for (int i = 0; i < 2; ++i) go(bench.engine, Motion::Kind::run);
  EXPECT_EQ("VAR(2): 0 -> 5", go(bench.engine, Motion::Kind::reverse_run).description);
  EXPECT_EQ(Stop::Reason::beginning, go(bench.engine, Motion::Kind::reverse_run).reason);
}

TEST(DebuggedTwin, ALongJourneyInTimeCanBeInterrupted) {
  Bench bench("Loop: CALC ADD, 1\nJA Loop\n");
  value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(2)}, always));
  TwinPowers& twin = *bench.engine.target().twin();
  const Moment moment = twin.now();
  const auto never_on = [] { return false; };
  expect_done(twin.go_to(twin.beginning(), never_on));
  const auto interrupted = twin.go_to(moment, never_on);
  ASSERT_FALSE(interrupted);
  EXPECT_EQ(client::ErrorKind::interrupted, interrupted.error().kind);
}

TEST(DebuggedTwin, AWayBackThatIsInterruptedLeavesTheProgramWhereItWas) {
  Bench bench("Loop: CALC ADD, 1\nJA Loop\n");
  value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(2)}, always));
  const Seen before = see(bench.engine);
  const Stop stop =
      value_of(bench.engine.go({Motion::Kind::reverse_run, 0, {}}, [](const Underway&) { return false; }));
  EXPECT_EQ(Stop::Reason::pause, stop.reason);
  EXPECT_EQ(before, see(bench.engine));
}

TEST(DebuggedTwin, NothingIsCountedOrSaidOnTheWayBack) {
  Bench bench(counting);
  BreakpointRequest request;
  request.address = 6;
  request.log_message = "A is {A}";
  value_of(bench.engine.add(request));
  const int number = break_at(bench.engine, 5);
  for (int i = 0; i < 3; ++i) go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(5, go(bench.engine, Motion::Kind::reverse_run).address);
  EXPECT_EQ(3U, bench.engine.breakpoints().at(number).hits);
  EXPECT_THAT(bench.output, ElementsAre("A is 5", "A is 10"));
}

TEST(DebuggedTwin, AScenarioSpeaksOnceForEachHistory) {
  TwinSetup setup;
  scenario::ScenarioFile file = scenario::read_scenario(R"(
module = "pd1161"
duration = "1 s"
[[event]]
at = "1 ms"
set = { "input.1" = 1 }
note = "soon"
[[event]]
at = "300 ms"
set = { "input.1" = 0 }
note = "not before the restart"
)");
  setup.scenario = file.scenario.value();
  std::vector<std::string> said;
  TwinTarget twin(std::move(setup), [&said](const scenario::Report& report) { said.push_back(report.text); });
  Engine engine(twin, program_of("Loop: CALC ADD, 1\nJA Loop\n"));
  launch(engine);
  EXPECT_THAT(said, ElementsAre());
  const Motion for_10_ms{Motion::Kind::run, 0, std::chrono::milliseconds(10)};
  value_of(engine.go(for_10_ms, always));
  EXPECT_EQ(1U, said.size());
  // Back to the begin and forth again, where it is the same again; then in another future.
  go(engine, Motion::Kind::reverse_run);
  value_of(engine.go(for_10_ms, always));
  EXPECT_EQ(1U, said.size());
  go(engine, Motion::Kind::reverse_run);
  expect_done(engine.set_variable(1, 1));
  value_of(engine.go(for_10_ms, always));
  EXPECT_EQ(2U, said.size());
  value_of(engine.restart());
  EXPECT_EQ(2U, said.size());
}

TEST(DebuggedTwin, AScenarioIsAPartOfTheHistory) {
  TwinSetup setup;
  scenario::ScenarioFile file = scenario::read_scenario(R"(
module = "pd1161"
duration = "1 s"
[[event]]
at = "20 ms"
set = { "input.1" = 1 }
)");
  if (!file.scenario) {
    GTEST_FAIL() << scenario::format(file.problems, "bench.toml");
  }
  setup.scenario = *file.scenario;
  Bench bench("Loop: GIO 1, 0\nJC ZE, Loop\nSTOP\n", std::move(setup));
  const Stop end = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(Stop::Reason::ended, end.reason);
  const Moment moment = bench.engine.target().twin()->now();
  EXPECT_GE(moment.time, 20'000U);
  go(bench.engine, Motion::Kind::reverse_run);
  EXPECT_EQ(Stop::Reason::ended, go(bench.engine, Motion::Kind::run).reason);
  EXPECT_EQ(moment, bench.engine.target().twin()->now());
}

const std::vector<std::string> moving_lines = {"WAIT TICKS, 0, 1", "ROR 0, 300", "GAP 1, 0",
                                               "MVP REL, 0, 40\nWAIT POS, 0, 5"};

RC_GTEST_PROP(DebuggedTwin, SteppingBackGivesTheStateBefore, ()) {
  Bench bench(random_program(moving_lines));
  std::vector<Seen> seen{see(bench.engine)};
  const auto steps = *rc::gen::inRange(1, 60);
  for (int i = 0; i < steps; ++i) {
    go(bench.engine, Motion::Kind::step);
    seen.push_back(see(bench.engine));
  }
  for (std::size_t i = seen.size() - 1; i-- > 0;) {
    go(bench.engine, Motion::Kind::reverse_step);
    RC_ASSERT(see(bench.engine) == seen[i]);
  }
}

RC_GTEST_PROP(DebuggedTwin, RunningToABreakpointEqualsSingleSteps, ()) {
  const std::string source = random_program(moving_lines);
  Bench stepped(source);
  const auto steps = *rc::gen::inRange(1, 60);
  for (int i = 0; i < steps; ++i) go(stepped.engine, Motion::Kind::step);
  const Seen goal = see(stepped.engine);

  Bench run(source);
  break_at(run.engine, goal.address);
  while (run.engine.target().twin()->now() < goal.moment) go(run.engine, Motion::Kind::run);
  RC_ASSERT(see(run.engine) == goal);
}

RC_GTEST_PROP(DebuggedTwin, ReverseRunLandsAtTheLastBreakpointBefore, ()) {
  Bench bench(random_program(moving_lines));
  const auto size = static_cast<int>(bench.engine.program().size());
  for (int i = *rc::gen::inRange(1, 4); i > 0; --i) {
    break_at(bench.engine, static_cast<std::uint16_t>(*rc::gen::inRange(1, size)));
  }
  std::vector<Seen> stops;
  for (int i = 0; i < 6; ++i) {
    const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, client::Duration(200'000)}, always));
    if (stop.reason != Stop::Reason::breakpoint) break;
    stops.push_back(see(bench.engine));
  }
  for (int i = *rc::gen::inRange(1, 20); i > 0 && !bench.engine.has_ended(); --i) go(bench.engine, Motion::Kind::step);
  // Steps may have met some more.
  while (true) {
    const Stop stop = go(bench.engine, Motion::Kind::reverse_run);
    if (stop.reason == Stop::Reason::beginning) break;
    const Seen here = see(bench.engine);
    while (!stops.empty() && here.moment < stops.back().moment) RC_FAIL("went past a breakpoint");
    if (!stops.empty() && stops.back() == here) stops.pop_back();
  }
  RC_ASSERT(stops.empty());
}

}  // namespace
}  // namespace opentmcl::debug
