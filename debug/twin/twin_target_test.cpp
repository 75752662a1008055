// An engine with a twin: whatever it does forward it can undo, and stepping is the same as running.

#include "debug/twin/twin_target.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <utility>

#include "debug/debugging_test.hpp"
#include "debug/random_program_test.hpp"
#include "scenario/scenario_file.hpp"

namespace opentmcl::debug {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Bench {
  explicit Bench(std::string_view source, TwinSetup setup = {})
      : twin(std::move(setup)),
        engine(twin, program_of(source), [this](const std::string& text) { output.push_back(text); }) {
    launch(engine);
  }

  TwinTarget twin;
  std::vector<std::string> output;
  Engine engine;
};

/// All that is to be seen of a program that stands.
struct Seen {
  std::uint16_t address;
  std::int32_t accumulator;
  std::int32_t x;
  std::vector<std::int32_t> variables;
  std::vector<std::uint16_t> frames;
  std::uint8_t flags;
  Comparison comparison;
  Moment moment;

  friend bool operator==(const Seen&, const Seen&) = default;
};

Seen see(Engine& engine) {
  const RegisterValues registers = value_of(engine.registers());
  Seen seen{
      registers.program_counter,   registers.accumulator,        registers.x, {}, {}, registers.inner->error_flags,
      registers.inner->comparison, engine.target().twin()->now()};
  for (std::uint8_t number = 0; number < 6; ++number) seen.variables.push_back(value_of(engine.variable(number)));
  for (const Frame& frame : engine.frames()) seen.frames.push_back(frame.address);
  return seen;
}

// ---- Stepping

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

// ---- Breakpoints

TEST(DebuggedTwin, StopsBeforeAnInstructionWithABreakpoint) {
  Bench bench(counting);
  const int number = break_at(bench.engine, 6);
  const Stop stop = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(Stop::Reason::breakpoint, stop.reason);
  EXPECT_THAT(stop.breakpoints, ElementsAre(number));
  EXPECT_EQ(5, value_of(bench.engine.registers()).accumulator);
  EXPECT_EQ(0, value_of(bench.engine.variable(2)));
}

TEST(DebuggedTwin, AConditionIsAskedAtTheBreakpoint) {
  Bench bench(counting);
  BreakpointRequest request;
  request.address = 6;
  request.condition = "A > 5 && VAR(1) == 2 && GAP(1, 0) < 500";
  value_of(bench.engine.add(request));
  go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(6, bench.engine.stop().address);
  EXPECT_EQ(10, value_of(bench.engine.registers()).accumulator);
  EXPECT_EQ(Stop::Reason::ended, go(bench.engine, Motion::Kind::run).reason);
}

TEST(DebuggedTwin, AConditionThatFailsStopsAndSaysWhy) {
  Bench bench(counting);
  BreakpointRequest request;
  request.address = 4;
  request.condition = "1 / A > 3";
  value_of(bench.engine.add(request));
  const Stop stop = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(4, stop.address);
  EXPECT_THAT(stop.description, HasSubstr("division by zero"));
}

TEST(DebuggedTwin, HitsAreCounted) {
  Bench bench(counting);
  BreakpointRequest request;
  request.address = 5;
  request.hit_condition = "3";
  value_of(bench.engine.add(request));
  go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(10, value_of(bench.engine.variable(2)));
}

TEST(DebuggedTwin, ALogpointSpeaksAndLetsTheProgramGo) {
  Bench bench(counting);
  BreakpointRequest request;
  request.address = 6;
  request.log_message = "{{A}} is {A}";
  value_of(bench.engine.add(request));
  EXPECT_EQ(Stop::Reason::ended, go(bench.engine, Motion::Kind::run).reason);
  EXPECT_THAT(bench.output, ElementsAre("{A} is 5", "{A} is 10", "{A} is 15"));
}

TEST(DebuggedTwin, AWatchedValueStopsTheProgramWhenItChanges) {
  Bench bench(counting);
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::change;
  request.subject = "VAR(2)";
  value_of(bench.engine.add(request));
  const Stop stop = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(Stop::Reason::change, stop.reason);
  EXPECT_EQ(7, stop.address);
  EXPECT_EQ("VAR(2): 0 -> 5", stop.description);
}

TEST(DebuggedTwin, AConditionIsAskedWhenAWatchedValueChanges) {
  Bench bench(counting);
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::change;
  request.subject = "VAR(2)";
  request.condition = "VAR(1) < 3";
  value_of(bench.engine.add(request));
  EXPECT_EQ("VAR(2): 5 -> 10", go(bench.engine, Motion::Kind::run).description);
}

TEST(DebuggedTwin, WhatAPersonChangesIsNoChangeOfTheProgram) {
  Bench bench(counting);
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::change;
  request.subject = "VAR(5)";
  value_of(bench.engine.add(request));
  go(bench.engine, Motion::Kind::step);
  expect_done(bench.engine.set_variable(5, 9));
  EXPECT_EQ(Stop::Reason::ended, go(bench.engine, Motion::Kind::run).reason);
}

TEST(DebuggedTwin, SaysAllThatStoppedItAtOnce) {
  Bench bench(counting);
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::change;
  request.subject = "VAR(2)";
  const int at_address = break_at(bench.engine, 7);
  const int disabled = break_at(bench.engine, 7);
  const int at_change = value_of(bench.engine.add(request));
  ASSERT_TRUE(bench.engine.enable(disabled, false));
  const Stop stop = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(Stop::Reason::breakpoint, stop.reason);
  EXPECT_THAT(stop.breakpoints, ElementsAre(at_address, at_change));
  EXPECT_EQ("VAR(2): 0 -> 5", stop.description);
}

TEST(DebuggedTwin, ABreakpointThatIsDisabledDoesNotStopAndCountsNothing) {
  Bench bench(counting);
  const int number = break_at(bench.engine, 6);
  EXPECT_TRUE(bench.engine.enable(number, false));
  EXPECT_EQ(Stop::Reason::ended, go(bench.engine, Motion::Kind::run).reason);
  EXPECT_EQ(0U, bench.engine.breakpoints().at(number).hits);
  const int other = break_at(bench.engine, 0);
  EXPECT_TRUE(bench.engine.enable(number, true));
  EXPECT_FALSE(bench.engine.enable(other + 1, true));
  value_of(bench.engine.restart());
  EXPECT_EQ(6, go(bench.engine, Motion::Kind::run).address);
}

TEST(DebuggedTwin, HitsAreCountedAnewAfterARestart) {
  Bench bench(counting);
  BreakpointRequest request;
  request.address = 5;
  request.hit_condition = "2";
  value_of(bench.engine.add(request));
  for (int run = 0; run < 2; ++run) {
    EXPECT_EQ(5, go(bench.engine, Motion::Kind::run).address);
    EXPECT_EQ(5, value_of(bench.engine.variable(2)));
    value_of(bench.engine.restart());
  }
}

TEST(DebuggedTwin, ABreakpointAtTheLastInstructionStopsBeforeItAndNotBehindIt) {
  Bench bench(counting);
  break_at(bench.engine, 3);
  EXPECT_EQ(Stop::Reason::breakpoint, go(bench.engine, Motion::Kind::run).reason);
  EXPECT_EQ(Stop::Reason::ended, go(bench.engine, Motion::Kind::run).reason);
}

TEST(DebuggedTwin, AConditionIsAskedWhenASignalBecomesTrue) {
  Bench bench("ROR 0, 1000\nLoop: JA Loop\n");
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::signal;
  request.subject = "velocity > 500";
  request.condition = "PC > 1";
  value_of(bench.engine.add(request));
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(2)}, always));
  EXPECT_EQ(Stop::Reason::limit, stop.reason);
}

TEST(DebuggedTwin, ASignalThatStaysTrueStopsOnce) {
  Bench bench("ROR 0, 1000\nLoop: JA Loop\n");
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::signal;
  request.subject = "velocity > 500";
  value_of(bench.engine.add(request));
  EXPECT_EQ(Stop::Reason::signal, go(bench.engine, Motion::Kind::run).reason);
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(2)}, always));
  EXPECT_EQ(Stop::Reason::limit, stop.reason);
}

TEST(DebuggedTwin, ASignalThatIsTrueWhenItIsAddedDoesNotStop) {
  Bench bench("ROR 0, 1000\nLoop: JA Loop\n");
  bool added = false;
  const auto add_once = [&](const Underway&) {
    if (std::exchange(added, true)) return true;
    BreakpointRequest request;
    request.kind = BreakpointRequest::Kind::signal;
    request.subject = "velocity > -1";
    value_of(bench.engine.add(request));
    return true;
  };
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(2)}, add_once));
  EXPECT_EQ(Stop::Reason::limit, stop.reason);
}

TEST(DebuggedTwin, ShowsAnInterruptRoutineBetweenSubroutines) {
  Bench bench(R"(
        VECT 0, Tick
        SGP 0, 3, 20
        EI 0
        EI 255
        CSUB Work         // 4
        STOP              // 5
Work:   CALC ADD, 1       // 6
        JA Work           // 7
Tick:   CSUB Sub          // 8
        RETI              // 9
Sub:    CALC ADD, 2       // 10
        RSUB              // 11
)");
  break_at(bench.engine, 10);
  go(bench.engine, Motion::Kind::run);
  const std::vector<Frame> frames = bench.engine.frames();
  ASSERT_EQ(4U, frames.size());
  EXPECT_EQ(10, frames[0].address);
  EXPECT_EQ(9, frames[1].address);
  EXPECT_TRUE(frames[1].is_interrupt);
  EXPECT_TRUE(frames[2].address == 6 || frames[2].address == 7);
  EXPECT_EQ(5, frames[3].address);
  for (const std::size_t subroutine : {0U, 2U, 3U}) EXPECT_FALSE(frames[subroutine].is_interrupt);
}

TEST(DebuggedTwin, StopsWhenASignalBecomesTrue) {
  Bench bench("ROR 0, 1000\nLoop: JA Loop\n");
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::signal;
  request.subject = "velocity > 500";
  value_of(bench.engine.add(request));
  const Stop stop = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(Stop::Reason::signal, stop.reason);
  EXPECT_THAT(stop.description, HasSubstr("velocity is 50"));
  request.subject = "velocty > 500";
  EXPECT_FALSE(bench.engine.add(request));
}

TEST(DebuggedTwin, SaysThatTheSupplyHasFailedWhenThatEndsTheProgram) {
  Bench bench("Loop: JA Loop\n");
  bench.engine.stop_at_troubles(static_cast<std::uint8_t>(Trouble::under_voltage));
  const auto take_the_supply = [&](const Underway&) {
    expect_done(bench.engine.target().twin()->set_quantity("supply_voltage", 5));
    return true;
  };
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, {}}, take_the_supply));
  EXPECT_EQ(Stop::Reason::trouble, stop.reason);
  EXPECT_EQ("under-voltage", stop.description);
  EXPECT_TRUE(bench.engine.has_ended());
}

TEST(DebuggedTwin, SaysThatTheProgramHasEndedWhenTheSupplyHadFailedBefore) {
  Bench bench("Loop: JA Loop\n");
  bench.engine.stop_at_troubles(static_cast<std::uint8_t>(Trouble::under_voltage));
  expect_done(bench.engine.target().twin()->set_quantity("supply_voltage", 5));
  EXPECT_EQ(Stop::Reason::ended, go(bench.engine, Motion::Kind::run).reason);
}

/// On the default stage, 5 mm before its hard end.
TwinSetup near_the_end() {
  scenario::ScenarioFile file =
      scenario::read_scenario("module = \"pd1161\"\nduration = \"10 s\"\n[machine]\nstart = \"-45 mm\"\n");
  TwinSetup setup;
  setup.scenario = file.scenario.value();
  return setup;
}

/// 150 rpm to the left; a stall stops the motor.
constexpr std::string_view into_the_end = R"(
#include TMCLParam.tmc
        SAP APPulseDivisor, 0, 0
        SAP APMaxCurrent, 0, 128
        SAP APStallGuardFilter, 0, 0
        SAP APStallGuardThreshold, 0, -18
        ROL 0, 524
        WAIT TICKS, 0, 20
        SAP APStopOnStall, 0, 500
Loop:   JA Loop
)";

TEST(DebuggedTwin, StopsWhenTheMotorStalls) {
  Bench bench(into_the_end, near_the_end());
  bench.engine.stop_at_troubles(static_cast<std::uint8_t>(Trouble::stall));
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(10)}, always));
  EXPECT_EQ(Stop::Reason::trouble, stop.reason);
  EXPECT_EQ("stall", stop.description);
}

TEST(DebuggedTwin, DoesNotStopAtATroubleNobodyAskedFor) {
  Bench bench(into_the_end, near_the_end());
  bench.engine.stop_at_troubles(static_cast<std::uint8_t>(Trouble::deviation));
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(10)}, always));
  EXPECT_EQ(Stop::Reason::limit, stop.reason);
}

TEST(DebuggedTwin, StopsWhenTheEncoderDeviates) {
  Bench bench(R"(
        SAP 212, 0, 2000
        ROR 0, 500
Loop:   JA Loop
)");
  bench.engine.stop_at_troubles(static_cast<std::uint8_t>(Trouble::deviation));
  const auto jam_the_shaft = [&](const Underway&) {
    expect_done(bench.engine.target().twin()->set_quantity("load.jammed", 1));
    return true;
  };
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(10)}, jam_the_shaft));
  EXPECT_EQ(Stop::Reason::trouble, stop.reason);
  EXPECT_EQ("deviation", stop.description);
}

// ---- Back in time

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
