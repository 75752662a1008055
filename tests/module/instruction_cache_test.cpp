// The interpreter keeps instructions that it has read: a program must be no different for it, only faster.
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

std::int32_t variable(Bench& bench, std::uint8_t number) {
  return bench.command(Opcode::ggp, number, static_cast<std::uint8_t>(Bank::user_variables)).value;
}

/// Puts instructions into the memory; leaves download mode unless the test wants to stay in it.
void load(Bench& bench, std::int32_t address, const std::vector<Command>& instructions, bool ends = true) {
  ASSERT_EQ(bench.command(Opcode::enter_download_mode, 0, 0, address).status, Status::ok);
  for (const Command& instruction : instructions) {
    ASSERT_EQ(bench.command(instruction).status, Status::command_loaded);
  }
  if (ends) {
    ASSERT_EQ(bench.command(Opcode::exit_download_mode).status, Status::ok);
  }
}

Command set_variable(std::int32_t value) {
  return {static_cast<std::uint8_t>(Opcode::sgp), 0, static_cast<std::uint8_t>(Bank::user_variables), value};
}
Command stop() {
  return {static_cast<std::uint8_t>(Opcode::stop), 0, 0, 0};
}

TEST(InstructionCache, LetsALoopRunOnWhileAPageIsWritten) {
  Bench bench(pd1161);
  bench.run_program("Loop: CALCV ADD, 0, 1\nJA Loop\n");
  bench.wait(100 * one_millisecond);
  for (std::uint8_t number = 1; number < 21; ++number) bench.command(Opcode::sgp, number, 2, 1000);
  // A command takes less time than a page, so that pages wait for each other when the last one is given.
  for (std::uint8_t number = 1; number < 21; ++number) bench.command(Opcode::stgp, number, 2);
  bench.command(Opcode::sgp, 0, 2, 0);
  const Microseconds start = bench.module.now();
  int busy = 0;
  for (int millisecond = 0; millisecond < 40; ++millisecond) {
    bench.wait(one_millisecond);
    if (bench.module.world().eeprom_busy()) ++busy;
  }
  EXPECT_GT(busy, 30) << "pages are written nearly all the time";
  const Microseconds loop = 2 * VirtualModule::Options{}.turn;
  const Microseconds passes = (bench.module.now() - start) / loop;
  EXPECT_NEAR(variable(bench, 0), static_cast<std::int32_t>(passes), 16);
}

TEST(InstructionCache, LetsInstructionsThatAreRefusedRunOnToo) {
  Bench bench(pd1161);
  // A velocity that does not exist, as programs for other modules have it.
  load(bench, 0,
       {{static_cast<std::uint8_t>(Opcode::sap), static_cast<std::uint8_t>(AxisParameter::maximum_positioning_speed), 0,
         51'200},
        {static_cast<std::uint8_t>(Opcode::ror), 0, 0, 51'200},
        {static_cast<std::uint8_t>(Opcode::calcv), 0, 0, 1},
        {static_cast<std::uint8_t>(Opcode::ja), 0, 0, 0}});
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(100 * one_millisecond);
  for (std::uint8_t parameter = 1; parameter < 20; ++parameter) bench.command(Opcode::stgp, parameter, 2);
  ASSERT_TRUE(bench.module.world().eeprom_busy());
  const std::int32_t before = variable(bench, 0);
  bench.wait(8 * one_millisecond);
  EXPECT_GT(variable(bench, 0), before + 15);
}

TEST(InstructionCache, ForgetsWhatIsOverwritten) {
  Bench bench(tmcm1110);
  for (const std::int32_t value : {1, 2, 3}) {
    load(bench, 0, {set_variable(value), stop()});
    bench.command(Opcode::run_application, 1, 0, 0);
    bench.wait(30 * one_millisecond);
    EXPECT_EQ(variable(bench, 0), value);
  }
}

TEST(InstructionCache, ForgetsWhatIsOverwrittenWhileTheProgramRuns) {
  Bench bench(pd1161);
  load(bench, 0, {set_variable(1), {static_cast<std::uint8_t>(Opcode::ja), 0, 0, 0}});
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(20 * one_millisecond);
  // Control commands are executed in download mode: the program can be started again while it is being changed.
  load(bench, 0, {}, false);
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(20 * one_millisecond);
  EXPECT_EQ(bench.command(set_variable(2)).status, Status::command_loaded);
  bench.wait(20 * one_millisecond);
  bench.command(Opcode::exit_download_mode);
  bench.wait(20 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 2);
}

TEST(InstructionCache, ForgetsAProgramThatLosesItsProtection) {
  Bench bench(pd1161);
  load(bench, 0, {set_variable(1), stop()});
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(20 * one_millisecond);
  ASSERT_EQ(variable(bench, 0), 1);
  bench.set(GlobalParameter::code_protection, 1);
  bench.set(GlobalParameter::code_protection, 0);
  bench.command(Opcode::sgp, 0, 2, 0);
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(3'000 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 0) << "nothing of the program is left to be executed";
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
}

TEST(InstructionCache, IsSmallerThanAProgramMayBe) {
  Bench bench(pd1161);
  const Command add{static_cast<std::uint8_t>(Opcode::calcv), 0, 0, 1};
  std::vector<Command> program(pd1161.program_capacity - 2U, add);
  // Twice through all of it: DJNZ counts variable 1.
  program.push_back({static_cast<std::uint8_t>(Opcode::djnz), 1, 0, 0});
  program.push_back(stop());
  load(bench, 0, program);
  bench.command(Opcode::sgp, 1, 2, 2);
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(1'000 * one_millisecond);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  EXPECT_EQ(variable(bench, 0), 2 * (pd1161.program_capacity - 2));
}

TEST(InstructionCache, LetsAProgramThatRunsOverTheEndOfTheMemoryEnd) {
  Bench bench(pd1161);
  const std::int32_t last = pd1161.program_capacity - 1;
  load(bench, last, {{static_cast<std::uint8_t>(Opcode::calcv), 0, 0, 1}});
  for (int pass = 1; pass <= 2; ++pass) {
    bench.command(Opcode::run_application, 1, 0, last);
    bench.wait(20 * one_millisecond);
    EXPECT_EQ(variable(bench, 0), pass);
    EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  }
}

}  // namespace
}  // namespace opentmcl::tests
