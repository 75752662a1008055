// An engine with a module that is known by its commands alone: a virtual one at the other end of a connection.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "boards/twin/virtual_module.hpp"
#include "debug/debugging_test.hpp"
#include "debug/module_target.hpp"
#include "debug/random_program_test.hpp"
#include "debug/twin/twin_target.hpp"
#include "scenario/scenario.hpp"
#include "server/memory_line.hpp"
#include "server/simulated_transport.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::debug {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Bench {
  explicit Bench(std::string_view source, const VirtualModule::Options& board = {})
      : module(pd1161, std::vector<hal::Port>{{&line.port(), hal::PortKind::usb}}, board),
        engine(target, program_of(source)) {}

  server::MemoryLine line;
  VirtualModule module;
  server::SimulatedTransport transport{module, line, "sim:pd1161"};
  client::Client client{transport};
  ModuleTarget target{client, pd1161};
  Engine engine;
};

struct LoadedBench : Bench {
  explicit LoadedBench(std::string_view source, const VirtualModule::Options& board = {}) : Bench(source, board) {
    launch(engine);
  }
};

// ---- Loading

TEST(Loading, SendsOnlyWhatDiffers) {
  LoadedBench bench(counting);
  EXPECT_TRUE(value_of(bench.engine.compare(every_progress)).is_same());
  std::string changed(counting);
  changed.replace(changed.find("ADD, 5"), 6, "ADD, 7");
  Engine again(bench.target, program_of(changed));
  const MemoryComparison comparison = value_of(again.compare(every_progress));
  EXPECT_THAT(comparison.differing, ElementsAre(5));
  EXPECT_EQ(1U, value_of(again.download(comparison, every_progress)));
  EXPECT_TRUE(value_of(again.compare(every_progress)).is_same());
  value_of(again.restart());
  EXPECT_EQ(Stop::Reason::ended, go(again, Motion::Kind::run).reason);
  EXPECT_EQ(21, value_of(again.variable(2)));
}

TEST(Loading, SeveralPiecesArriveWhole) {
  std::string before;
  std::string after;
  for (int i = 0; i < 100; ++i) {
    before += "CALC ADD, " + std::to_string(i) + "\n";
    after += "CALC ADD, " + std::to_string(i % 17 == 3 ? -i : i) + "\n";
  }
  LoadedBench bench(before);
  Engine engine(bench.target, program_of(after));
  const MemoryComparison comparison = value_of(engine.compare(every_progress));
  EXPECT_EQ(6U, comparison.differing.size());
  EXPECT_EQ(6U, value_of(engine.download(comparison, every_progress)));
  EXPECT_TRUE(value_of(engine.compare(every_progress)).is_same());
}

TEST(Loading, LeavesNothingOfALongerProgramBehindTheEnd) {
  LoadedBench bench(counting);
  Engine shorter(bench.target, program_of("SGP 1, 2, 3\n"));
  // The first instruction of the longer program, and a STOP.
  EXPECT_EQ(1U, value_of(shorter.download(value_of(shorter.compare(every_progress)), every_progress)));
  EXPECT_EQ(shorter.program().commands(),
            value_of(client::read_program(bench.client, pd1161.program_capacity, every_progress)));
  EXPECT_TRUE(value_of(shorter.compare(every_progress)).is_loaded());
}

TEST(Loading, AMissingEndMarkIsNoOtherProgram) {
  Bench bench(counting);
  expect_done(client::download(bench.client, bench.engine.program().commands(), 0, every_progress));
  const MemoryComparison comparison = value_of(bench.engine.compare(every_progress));
  EXPECT_TRUE(comparison.is_same());
  EXPECT_FALSE(comparison.is_loaded());
  EXPECT_EQ(0U, value_of(bench.engine.download(comparison, every_progress)));
  EXPECT_TRUE(value_of(bench.engine.compare(every_progress)).is_loaded());
}

TEST(Loading, CodeProtectionIsNoticed) {
  LoadedBench bench(counting);
  constexpr auto code_protection = static_cast<std::uint8_t>(GlobalParameter::code_protection);
  expect_done(bench.client.set_global_parameter(code_protection, Bank::module_settings, 3));
  const MemoryComparison comparison = value_of(bench.engine.compare(every_progress));
  EXPECT_FALSE(comparison.readable);
  EXPECT_FALSE(comparison.writable);
  EXPECT_FALSE(comparison.is_same());
  const auto refused = bench.engine.download(comparison, every_progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(client::ErrorKind::refused, refused.error().kind);
  EXPECT_THAT(refused.error().message, HasSubstr("global parameter 81"));
  // Who trusts that it is the program can debug it all the same.
  value_of(bench.engine.restart());
  EXPECT_EQ(2, go(bench.engine, Motion::Kind::run_to, 2).address);
}

// ---- Motion

TEST(DebuggedModule, StepsIntoOverAndOutOfSubroutines) {
  LoadedBench bench(counting);
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::step).address);
  EXPECT_EQ(4, go(bench.engine, Motion::Kind::step).address);
  EXPECT_EQ(2U, bench.engine.frames().size());
  EXPECT_TRUE(bench.engine.frames_are_whole());
  EXPECT_EQ(2, go(bench.engine, Motion::Kind::step_out).address);
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::step).address);
  EXPECT_EQ(2, go(bench.engine, Motion::Kind::step_over).address);
  EXPECT_EQ(10, value_of(bench.engine.variable(2)));
  EXPECT_FALSE(bench.engine.go({Motion::Kind::step_out, 0, {}}, always));
}

TEST(DebuggedModule, StopsAtABreakpointAndRunsByItselfWithoutOne) {
  LoadedBench bench(counting);
  BreakpointRequest request;
  request.address = 6;
  request.condition = "A > 5";
  const int number = value_of(bench.engine.add(request));
  EXPECT_EQ(6, go(bench.engine, Motion::Kind::run).address);
  EXPECT_EQ(10, value_of(bench.engine.registers()).accumulator);
  EXPECT_TRUE(bench.engine.remove(number));
  const Stop end = go(bench.engine, Motion::Kind::run);
  EXPECT_EQ(Stop::Reason::ended, end.reason);
  EXPECT_EQ(3, end.address);
  EXPECT_EQ(15, value_of(bench.engine.variable(2)));
}

TEST(DebuggedModule, AProgramThatRunsByItselfIsPaused) {
  LoadedBench bench("Loop: CSUB Sub\nJA Loop\nSub: RSUB\n");
  int asked = 0;
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, {}}, [&](const Underway&) { return ++asked < 3; }));
  EXPECT_EQ(Stop::Reason::pause, stop.reason);
  // Where it is nobody saw, so there may be more on the stack than is known.
  EXPECT_FALSE(bench.engine.frames_are_whole());
  EXPECT_EQ(client::ProgramStatus::State::stopped, value_of(bench.client.program_status()).state);
  go(bench.engine, Motion::Kind::run_to, 2);
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::step_out).address);
}

TEST(DebuggedModule, RunsByItselfWhenItsBreakpointsAreDisabled) {
  LoadedBench bench("Loop: CSUB Sub\nJA Loop\nSub: RSUB\n");
  ASSERT_TRUE(bench.engine.enable(break_at(bench.engine, 2), false));
  int asked = 0;
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, {}}, [&](const Underway&) { return ++asked < 3; }));
  EXPECT_EQ(Stop::Reason::pause, stop.reason);
  EXPECT_FALSE(bench.engine.frames_are_whole());
}

TEST(DebuggedModule, ABreakpointThatIsAddedWhileItRunsStopsIt) {
  LoadedBench bench("Loop: CALC ADD, 1\nJA Loop\n");
  bool added = false;
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, {}}, [&](const Underway&) {
    if (!added) break_at(bench.engine, 1);
    added = true;
    return true;
  }));
  EXPECT_EQ(Stop::Reason::breakpoint, stop.reason);
  EXPECT_EQ(1, stop.address);
}

TEST(DebuggedModule, AStepOverAWaitTakesAsLongAsTheWait) {
  LoadedBench bench("WAIT TICKS, 0, 50\nSTOP\n");
  const client::Duration begin = bench.target.now();
  EXPECT_EQ(1, go(bench.engine, Motion::Kind::step).address);
  EXPECT_GE(bench.target.now() - begin, client::Duration(500'000));
  EXPECT_LT(bench.target.now() - begin, client::Duration(600'000));
}

TEST(DebuggedModule, AWaitForNothingEndsAtTheLimit) {
  LoadedBench bench("WAIT REFSW, 0, 0\nSTOP\n");
  const Stop stop =
      value_of(bench.engine.go({Motion::Kind::step, 0, client::Duration(std::chrono::seconds(1))}, always));
  EXPECT_EQ(Stop::Reason::limit, stop.reason);
  EXPECT_TRUE(stop.waiting);
}

TEST(DebuggedModule, EndsAtAnInstructionThatTheModuleDoesNotHave) {
  LoadedBench bench("CALC ADD, 1\nSTOP\n");
  expect_done(bench.client.stop_program());
  // What stands behind the program was never written.
  Engine engine(bench.target, Program::disassembled({{19, 0, 0, 1}, {28, 0, 0, 0}}, pd1161, "memory"));
  value_of(engine.restart());
  go(engine, Motion::Kind::step);
  EXPECT_EQ(Stop::Reason::ended, go(engine, Motion::Kind::step).reason);
}

TEST(DebuggedModule, AnInterruptRoutineIsAFrame) {
  LoadedBench bench(R"(
        VECT 0, Tick
        SGP 0, 3, 20
        EI 0
        EI 255
Loop:   CALC ADD, 1       // 4
        JA Loop           // 5
Tick:   SGP 5, 2, 1       // 6
        RETI              // 7
)");
  break_at(bench.engine, 7);
  bench.transport.pause(std::chrono::milliseconds(1));
  const Stop stop = value_of(bench.engine.go({Motion::Kind::run, 0, {}}, [&](const Underway&) {
    bench.transport.pause(std::chrono::milliseconds(1));
    return true;
  }));
  EXPECT_EQ(7, stop.address);
  const std::vector<Frame> frames = bench.engine.frames();
  ASSERT_EQ(2U, frames.size());
  EXPECT_TRUE(frames[0].is_interrupt);
  EXPECT_TRUE(frames[1].address == 4 || frames[1].address == 5);
  const Stop outside = go(bench.engine, Motion::Kind::step_out);
  EXPECT_EQ(frames[1].address, outside.address);
}

TEST(DebuggedModule, RegistersCanBeSetAndFlagsAreNotVisible) {
  LoadedBench bench(counting);
  expect_done(bench.engine.set_accumulator(-7));
  expect_done(bench.engine.set_x(12));
  const RegisterValues registers = value_of(bench.engine.registers());
  EXPECT_EQ(-7, registers.accumulator);
  EXPECT_EQ(12, registers.x);
  EXPECT_FALSE(registers.inner);
}

TEST(DebuggedModule, HasNeitherAPastNorSignals) {
  LoadedBench bench(counting);
  const auto back = bench.engine.go({Motion::Kind::reverse_step, 0, {}}, always);
  ASSERT_FALSE(back);
  EXPECT_THAT(back.error().message, HasSubstr("sim:pd1161"));
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::signal;
  request.subject = "velocity > 1";
  EXPECT_FALSE(bench.engine.add(request));
  EXPECT_FALSE(bench.engine.jump(3));
}

/// Turns the motor, fast enough for stallGuard2; no stall stops it.
constexpr std::string_view turning = R"(
#include TMCLParam.tmc
        SAP APPulseDivisor, 0, 0
        SAP APMaxCurrent, 0, 128
        SAP APStallGuardFilter, 0, 0
        SAP APStallGuardThreshold, 0, -18
        ROL 0, 524
        WAIT TICKS, 0, 50
        SAP 212, 0, 2000
Loop:   JA Loop             // 7
)";
constexpr std::uint16_t loop_of_turning = 7;

struct Mishap {
  Trouble trouble;
  std::string_view quantity;
  double value;
  const char* name;
};
constexpr Mishap mishaps[] = {{Trouble::stall, "load.jammed", 1, "stall"},
                              {Trouble::deviation, "load.jammed", 1, "deviation"},
                              {Trouble::under_voltage, "supply_voltage", 5, "under-voltage"}};

/// Lets the motor turn, and then the mishap happen while the program goes on. @param steps it is stepped
Stop run_into(const Mishap& mishap, std::uint8_t troubles, bool steps) {
  LoadedBench bench(turning, scenario::Scenario{}.board());
  go(bench.engine, Motion::Kind::run_to, loop_of_turning);
  bench.engine.stop_at_troubles(troubles);
  if (steps) break_at(bench.engine, 0);
  // All is well: asking changes nothing.
  int asked = 0;
  const Stop paused = value_of(bench.engine.go({Motion::Kind::run, 0, {}}, [&](const Underway&) {
    bench.transport.pause(std::chrono::milliseconds(1));
    return ++asked < 20;
  }));
  EXPECT_EQ(Stop::Reason::pause, paused.reason);
  return value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(2)}, [&](const Underway&) {
    twin::find_quantity(mishap.quantity)->write(bench.module.world(), mishap.value);
    bench.transport.pause(std::chrono::milliseconds(1));
    return true;
  }));
}

TEST(DebuggedModule, StopsAtATroubleThatIsAskedFor) {
  for (const bool steps : {false, true}) {
    for (const Mishap& mishap : mishaps) {
      SCOPED_TRACE(std::string(mishap.name) + (steps ? ", stepped" : ""));
      const Stop stop = run_into(mishap, static_cast<std::uint8_t>(mishap.trouble), steps);
      EXPECT_EQ(Stop::Reason::trouble, stop.reason);
      EXPECT_EQ(mishap.name, stop.description);
    }
  }
}

TEST(DebuggedModule, DoesNotStopAtATroubleNobodyAskedFor) {
  constexpr std::uint8_t jammed =
      static_cast<std::uint8_t>(Trouble::stall) | static_cast<std::uint8_t>(Trouble::deviation);
  constexpr auto unsupplied = static_cast<std::uint8_t>(Trouble::under_voltage);
  EXPECT_EQ(Stop::Reason::limit, run_into(mishaps[0], unsupplied, false).reason);
  EXPECT_EQ(Stop::Reason::ended, run_into(mishaps[2], jammed, false).reason);
}

TEST(DebuggedModule, StopsProgramAndMotor) {
  LoadedBench bench("ROR 0, 500\nLoop: JA Loop\n");
  value_of(bench.engine.go({Motion::Kind::run, 0, std::chrono::seconds(1)}, always));
  EXPECT_NE(0, value_of(bench.client.axis_parameter(AxisParameter::actual_speed)));
  expect_done(bench.engine.stop_all());
  bench.transport.pause(std::chrono::seconds(2));
  EXPECT_EQ(0, value_of(bench.client.axis_parameter(AxisParameter::actual_speed)));
  EXPECT_EQ(client::ProgramStatus::State::stopped, value_of(bench.client.program_status()).state);
}

TEST(DebuggedModule, IsLeftRunningUnlessItsProgramHasEnded) {
  LoadedBench bench(counting);
  go(bench.engine, Motion::Kind::step);
  expect_done(bench.engine.detach());
  bench.transport.pause(std::chrono::seconds(1));
  EXPECT_EQ(15, value_of(bench.engine.variable(2)));

  value_of(bench.engine.restart());
  go(bench.engine, Motion::Kind::run);
  ASSERT_TRUE(bench.engine.has_ended());
  expect_done(bench.engine.set_variable(2, 0));
  expect_done(bench.engine.detach());
  bench.transport.pause(std::chrono::seconds(1));
  EXPECT_EQ(0, value_of(bench.engine.variable(2)));
}

TEST(DebuggedModule, AttachesToAProgramThatRuns) {
  LoadedBench bench("Loop: CALC ADD, 1\nJA Loop\n");
  expect_done(bench.engine.detach());
  Engine engine(bench.target, program_of("Loop: CALC ADD, 1\nJA Loop\n"));
  EXPECT_EQ(Stop::Reason::entry, value_of(engine.attach()).reason);
  EXPECT_TRUE(engine.is_running());
  EXPECT_FALSE(engine.frames_are_whole());
  EXPECT_EQ(1, go(engine, Motion::Kind::run_to, 1).address);
  EXPECT_FALSE(engine.is_running());
  EXPECT_EQ(client::ProgramStatus::State::stopped, value_of(bench.client.program_status()).state);
}

TEST(DebuggedModule, AnUnansweredCommandIsAnErrorAndNoHang) {
  LoadedBench bench(counting);
  // Global parameter 255 keeps the module from answering anything but reads.
  constexpr auto suppress_reply = static_cast<std::uint8_t>(GlobalParameter::suppress_reply);
  static_cast<void>(bench.client.set_global_parameter(suppress_reply, Bank::module_settings, 1));
  const auto step = bench.engine.go({Motion::Kind::step, 0, {}}, always);
  ASSERT_FALSE(step);
  EXPECT_EQ(client::ErrorKind::timeout, step.error().kind);
}

RC_GTEST_PROP(DebuggedModule, GoesThroughTheSameAddressesAsATwinWithTheSameStack, ()) {
  const std::string source = random_program();
  LoadedBench module(source);
  TwinTarget target{TwinSetup{}};
  Engine twin(target, program_of(source));
  launch(twin);
  for (int i = *rc::gen::inRange(1, 80); i > 0; --i) {
    const auto kind = *rc::gen::element(Motion::Kind::step, Motion::Kind::step_over);
    RC_ASSERT(go(module.engine, kind).address == go(twin, kind).address);
    const std::vector<Frame> seen = module.engine.frames();
    const std::vector<Frame> real = twin.frames();
    RC_ASSERT(seen.size() == real.size());
    for (std::size_t frame = 0; frame < seen.size(); ++frame) RC_ASSERT(seen[frame].address == real[frame].address);
    RC_ASSERT(value_of(module.engine.registers()).accumulator == value_of(twin.registers()).accumulator);
  }
}

}  // namespace
}  // namespace opentmcl::debug
