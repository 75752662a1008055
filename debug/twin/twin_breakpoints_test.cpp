// What stops a program in a twin: breakpoints, watches, signals of the bench, and what goes wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "debug/twin/debugged_twin_test.hpp"

namespace opentmcl::debug {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

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

}  // namespace
}  // namespace opentmcl::debug
