// Interrupts where a host has a hand in them; those that a program sees alone are in tests/programs.
#include <gtest/gtest.h>

#include "firmware/spec/interrupts.hpp"
#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

std::int32_t variable(Bench& bench, std::uint8_t number) {
  return bench.command(Opcode::ggp, number, static_cast<std::uint8_t>(Bank::user_variables)).value;
}

constexpr std::uint8_t input_0 = static_cast<std::uint8_t>(Interrupt::input_0);
constexpr std::uint8_t global = static_cast<std::uint8_t>(Interrupt::global);
constexpr std::int32_t rising = 1;

/// A loop at 0, and a routine at 2 that counts in variable 0.
constexpr const char* counting_program =
    "Loop: CALC ADD, 0\n"
    "JA Loop\n"
    "CALCV ADD, 0, 1\n"
    "RETI\n";

void set_up(Bench& bench) {
  bench.download(counting_program);
  EXPECT_EQ(bench.command(Opcode::vect, input_0, 0, 2).status, Status::ok);
  EXPECT_EQ(bench.command(Opcode::sgp, input_0, static_cast<std::uint8_t>(Bank::interrupt_settings), rising).status,
            Status::ok);
  EXPECT_EQ(bench.command(Opcode::ei, input_0).status, Status::ok);
  EXPECT_EQ(bench.command(Opcode::ei, global).status, Status::ok);
}

void start(Bench& bench) {
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(10 * one_millisecond);
}

void pulse(Bench& bench) {
  bench.module.world().set_inputs(1);
  bench.wait(10 * one_millisecond);
  bench.module.world().set_inputs(0);
  bench.wait(10 * one_millisecond);
}

TEST(InterruptsSetUpByAHost, AreTakenByAProgram) {
  Bench bench(pd1161);
  set_up(bench);
  start(bench);
  pulse(bench);
  pulse(bench);
  EXPECT_EQ(variable(bench, 0), 2);
  bench.command(Opcode::di, input_0);
  pulse(bench);
  EXPECT_EQ(variable(bench, 0), 2);
}

TEST(InterruptsSetUpByAHost, OutliveAResetOfTheProgram) {
  Bench bench(pd1161);
  set_up(bench);
  bench.command(Opcode::reset_application);
  start(bench);
  pulse(bench);
  EXPECT_EQ(variable(bench, 0), 1);
}

TEST(Interrupts, ThatHappenWhileNoProgramRunsAreForgottenAtTheStart) {
  Bench bench(pd1161);
  set_up(bench);
  start(bench);
  pulse(bench);
  bench.command(Opcode::stop_application);
  bench.module.world().set_inputs(1);
  bench.wait(10 * one_millisecond);
  start(bench);
  EXPECT_EQ(variable(bench, 0), 1);
}

TEST(Interrupts, ThatHappenWhileAProgramIsStoppedAreSeenWhenItGoesOn) {
  Bench bench(pd1161);
  set_up(bench);
  start(bench);
  bench.command(Opcode::stop_application);
  bench.module.world().set_inputs(1);
  bench.wait(10 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 0) << "only a running program is interrupted";
  bench.command(Opcode::run_application);
  bench.wait(10 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 1);
}

TEST(Interrupts, WorkAgainAfterAProgramThatEndedInARoutine) {
  Bench bench(pd1161);
  bench.download("Loop: JA Loop\nCALCV ADD, 0, 1\nSTOP\n");
  bench.command(Opcode::vect, input_0, 0, 1);
  bench.command(Opcode::sgp, input_0, static_cast<std::uint8_t>(Bank::interrupt_settings), rising);
  bench.command(Opcode::ei, input_0);
  bench.command(Opcode::ei, global);
  for (int run = 1; run <= 3; ++run) {
    start(bench);
    pulse(bench);
    EXPECT_EQ(variable(bench, 0), run);
    EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  }
}

TEST(Interrupts, AreTakenInSingleStepsToo) {
  Bench bench(pd1161);
  set_up(bench);
  bench.command(Opcode::reset_application);
  bench.command(Opcode::step_application);
  bench.module.world().set_inputs(1);
  bench.command(Opcode::step_application);
  EXPECT_EQ(variable(bench, 0), 1) << "the step was the first instruction of the routine";
  EXPECT_EQ(bench.get(GlobalParameter::program_counter), 3);
  bench.command(Opcode::step_application);
  EXPECT_EQ(bench.get(GlobalParameter::program_counter), 1) << "back where it was interrupted";
}

TEST(SingleSteps, StayAtAWaitUntilItIsOver) {
  Bench bench(pd1161);
  bench.download("WAIT TICKS, 0, 5\nSGP 0, 2, 1\n");
  bench.wait(20 * one_millisecond);  // until the last page is written
  bench.command(Opcode::reset_application);
  constexpr std::int32_t waiting = 1 << 16;
  constexpr std::uint8_t with_program_counter = 1;
  bench.command(Opcode::step_application);
  EXPECT_EQ(bench.command(Opcode::get_application_status, with_program_counter).value, waiting | 0);
  bench.command(Opcode::step_application);
  EXPECT_EQ(bench.command(Opcode::get_application_status, with_program_counter).value, waiting | 0);
  bench.wait(50 * one_millisecond);
  bench.command(Opcode::step_application);
  EXPECT_EQ(bench.command(Opcode::get_application_status, with_program_counter).value, 1);
  EXPECT_EQ(variable(bench, 0), 0);
  bench.command(Opcode::step_application);
  EXPECT_EQ(variable(bench, 0), 1);
}

TEST(Subroutines, LeftOpenByAnEarlierRunAreClosedByAStart) {
  Bench bench(pd1161);
  bench.download("CSUB Sub\nSTOP\nSub: CALCV ADD, 0, 1\nSTOP\n");
  for (int run = 1; run <= 10; ++run) {
    start(bench);
    EXPECT_EQ(variable(bench, 0), run);
  }
}

}  // namespace
}  // namespace opentmcl::tests
