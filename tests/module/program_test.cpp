#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

std::int32_t variable(Bench& bench, std::uint8_t number) {
  return bench.command(Opcode::ggp, number, 2).value;
}

/// Runs a program to its end. @return user variable 0
std::int32_t result_of(const std::string& source, const ModuleDescription& module = pd1161,
                       Microseconds time = 500 * one_millisecond) {
  Bench bench(module);
  bench.run_program(source);
  bench.wait(time);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0) << "the program did not end: " << source;
  return variable(bench, 0);
}

TEST(Calc, WrapsAt32BitsAndLeavesTheAccumulatorOnDivisionByZero) {
  const struct {
    const char* operations;
    std::int32_t result;
  } rows[] = {
      {"CALC LOAD, 7\nCALC ADD, 5", 12},
      {"CALC LOAD, 2147483647\nCALC ADD, 1", int32_minimum},
      {"CALC LOAD, 5\nCALC SUB, 8", -3},
      {"CALC LOAD, 65536\nCALC MUL, 65536", 0},
      {"CALC LOAD, -7\nCALC DIV, 2", -3},
      {"CALC LOAD, -7\nCALC MOD, 2", -1},
      {"CALC LOAD, 9\nCALC DIV, 0", 9},
      {"CALC LOAD, 9\nCALC MOD, 0", 9},
      {"CALC LOAD, -2147483648\nCALC DIV, -1", int32_minimum},
      {"CALC LOAD, -2147483648\nCALC MOD, -1", 0},
      {"CALC LOAD, 12\nCALC AND, 10", 8},
      {"CALC LOAD, 12\nCALC OR, 10", 14},
      {"CALC LOAD, 12\nCALC XOR, 10", 6},
      {"CALC LOAD, 0\nCALC NOT, 99", -1},
      {"CALC LOAD, 3\nCALCX LOAD\nCALC LOAD, 10\nCALCX SUB", 7},
      {"CALC LOAD, 3\nCALCX LOAD\nCALC LOAD, 10\nCALCX SWAP", 3},
      {"CALC LOAD, 3\nCALCX LOAD\nCALCX NOT\nCALCX SWAP", -4},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(result_of(std::string(row.operations) + "\nAGP 0, 2\n", tmcm1110), row.result) << row.operations;
  }
}

TEST(Conditions, FollowTheLastComparison) {
  const struct {
    const char* condition;
    bool lower, equal, greater;
  } rows[] = {{"ZE", false, true, false}, {"NZ", true, false, true},  {"EQ", false, true, false},
              {"NE", true, false, true},  {"GT", false, false, true}, {"GE", false, true, true},
              {"LT", true, false, false}, {"LE", true, true, false}};
  for (const auto& row : rows) {
    for (const int value : {-5, 3, 8}) {
      const std::string source = "CALC LOAD, " + std::to_string(value) + "\nCOMP 3\nJC " + row.condition +
                                 ", Yes\nSGP 0, 2, 2\nSTOP\nYes: SGP 0, 2, 1\n";
      const bool holds = value < 3 ? row.lower : value == 3 ? row.equal : row.greater;
      EXPECT_EQ(result_of(source), holds ? 1 : 2) << row.condition << ' ' << value;
    }
  }
}

TEST(Flags, AreSetByReadsAndLeftAloneBySwapAndCalc) {
  EXPECT_EQ(result_of("SGP 9, 2, 0\nGGP 9, 2\nJC ZE, Yes\nSTOP\nYes: SGP 0, 2, 1\n"), 1);
  EXPECT_EQ(result_of("COMP 0\nCALC LOAD, 5\nCALCX SWAP\nJC ZE, Yes\nSTOP\nYes: SGP 0, 2, 1\n"), 1);
}

TEST(DirectReads, LeaveTheAccumulatorOfTheProgramAlone) {
  Bench bench(pd1161);
  bench.run_program("CALC LOAD, 1234\nLoop: JA Loop\n");
  bench.get(AxisParameter::maximum_positioning_speed);
  EXPECT_EQ(bench.command(Opcode::get_application_status, 2).value, 1234);
}

TEST(Subroutines, NestToEightLevelsAndTheNinthCallIsIgnored) {
  std::string source = "CSUB L1\nAGP 0, 2\nSTOP\n";
  for (int level = 1; level <= 8; ++level) {
    source += "L" + std::to_string(level) + ": CALC ADD, 1\nCSUB L" + std::to_string(level + 1) + "\nRSUB\n";
  }
  source += "L9: CALC ADD, 100\nRSUB\n";
  EXPECT_EQ(result_of(source), 8);
}

TEST(Subroutines, ReturnWithAnEmptyStackIsIgnored) {
  EXPECT_EQ(result_of("RSUB\nSGP 0, 2, 5\n"), 5);
}

TEST(Wait, ForTicksTakesTenMillisecondsEach) {
  Bench bench(pd1161);
  bench.run_program("SGP 132, 0, 0\nWAIT TICKS, 0, 25\nGGP 132, 0\nAGP 0, 2\n");
  bench.wait(400 * one_millisecond);
  EXPECT_NEAR(variable(bench, 0), 250, 1);
}

TEST(Wait, TakesTheTicksFromTheAccumulatorWhenItIsMinusOne) {
  Bench bench(pd1161);
  bench.run_program("SGP 132, 0, 0\nCALC LOAD, 12\nWAIT TICKS, 0, -1\nGGP 132, 0\nAGP 0, 2\n");
  bench.wait(400 * one_millisecond);
  EXPECT_NEAR(variable(bench, 0), 120, 1);
}

TEST(Wait, ForAPositionGoesOnWhenItIsReached) {
  Bench bench(tmcm1110);
  bench.run_program("MVP ABS, 0, 4000\nWAIT POS, 0, 0\nGAP 1, 0\nAGP 0, 2\n");
  bench.wait(2'000 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 4000);
}

TEST(Wait, SetsTheTimeoutFlagAndGoesOn) {
  EXPECT_EQ(result_of("ROR 0, 100\nMVP ABS, 0, 1000000\nWAIT POS, 0, 3\nJC ETO, Late\nSTOP\nLate: CLE ETO\n"
                      "JC ETO, Wrong\nSGP 0, 2, 1\nWrong: STOP\n"),
            1);
}

TEST(Wait, ForSwitchesGoesOnWhenTheyAreActive) {
  Bench bench(pd1161);
  bench.run_program("WAIT LIMSW, 0, 0\nSGP 0, 2, 1\nWAIT REFSW, 0, 0\nSGP 0, 2, 2\n");
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 0);
  bench.module.world().set_left_switch(true);
  bench.wait(10 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 1);
  bench.module.world().set_inputs(1U << static_cast<unsigned>(hal::InputPin::home_switch));
  bench.wait(10 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 2);
}

TEST(NewInstructions, CalculateWithVariables) {
  EXPECT_EQ(result_of("SGP 0, 2, 40\nSGP 1, 2, 2\nCALCVV ADD, 0, 1\n"), 42);
  EXPECT_EQ(result_of("SGP 0, 2, 40\nSGP 1, 2, 2\nCALCVV SWAP, 0, 1\n"), 2);
  EXPECT_EQ(result_of("SGP 0, 2, 84\nSGP 1, 2, 2\nCALCVV DIV, 0, 1\n"), 42);
  EXPECT_EQ(result_of("SGP 0, 2, 40\nCALC LOAD, 2\nCALCVA SUB, 0\n"), 38);
  EXPECT_EQ(result_of("SGP 1, 2, 40\nCALC LOAD, 2\nCALCAV SUB, 1\nAGP 0, 2\n"), -38);
  EXPECT_EQ(result_of("SGP 0, 2, 40\nCALC LOAD, 2\nCALCX LOAD\nCALCVX MUL, 0\n"), 80);
  EXPECT_EQ(result_of("SGP 1, 2, 40\nCALC LOAD, 2\nCALCX LOAD\nCALCXV MUL, 1\nCALCX SWAP\nAGP 0, 2\n"), 80);
  EXPECT_EQ(result_of("SGP 0, 2, 40\nCALCV MOD, 0, 7\n"), 5);
  EXPECT_EQ(result_of("SGP 0, 2, 40\nCALCV NOT, 0, 7\n"), -41);
  EXPECT_EQ(result_of("SGP 0, 2, 5\nCALCV COMP, 0, 7\nJC LT, Yes\nSTOP\nYes: SGP 0, 2, 1\n"), 1);
}

TEST(NewInstructions, CountCallAndIndex) {
  EXPECT_EQ(result_of("SGP 9, 2, 10\nLoop: CALCV ADD, 0, 3\nDJNZ 9, Loop\n"), 30);
  EXPECT_EQ(result_of("COMP 1\nCALL LT, Sub\nCALL GT, Sub\nSTOP\nSub: CALCV ADD, 0, 1\nRSUB\n"), 1);
  EXPECT_EQ(result_of("CALC LOAD, 3\nCALCX LOAD\nSIV 99\nGIV\nAGP 0, 2\n"), 99);
  EXPECT_EQ(result_of("CALC LOAD, 256\nCALCX LOAD\nSIV 99\nCALC LOAD, 7\nGIV\nAGP 0, 2\n"), 7);
  EXPECT_EQ(result_of("CALC LOAD, 0\nCALCX LOAD\nCALC LOAD, 55\nAIV\n"), 55);
  EXPECT_EQ(result_of("CALCV ADD, 0, 1\nCALCV COMP, 0, 3\nJC GE, End\nCSUB Sub\nEnd: STOP\nSub: RST 0\n"), 3);
}

TEST(NewInstructions, DoNotExistOnTheTmcm1110) {
  Bench bench(tmcm1110);
  for (const InstructionSpec& row : instructions) {
    if (row.modules != Modules::pd1161) continue;
    EXPECT_EQ(bench.command(row.opcode).status, Status::invalid_command) << static_cast<int>(row.opcode);
  }
}

TEST(ProgramOnlyInstructions, AreNotAvailableInDirectMode) {
  Bench bench(pd1161);
  for (const InstructionSpec& row : instructions) {
    if (row.where != Where::program_only) continue;
    EXPECT_EQ(bench.command(row.opcode).status, Status::command_not_available) << row.mnemonic;
  }
}

TEST(Interrupts, OfATimerComeAtTheirPeriodAndKeepTheContext) {
  Bench bench(pd1161);
  bench.run_program(
      "VECT 0, Timer\nSGP 0, 3, 100\nEI 0\nEI 255\nCALC LOAD, 5\nCOMP 5\nLoop: JC NE, Bad\nCOMP 5\nJA Loop\n"
      "Bad: SGP 9, 2, 1\nSTOP\n"
      "Timer: GGP 1, 2\nCALC ADD, 1\nAGP 1, 2\nCOMP 0\nRETI\n");
  bench.wait(1'050 * one_millisecond);
  EXPECT_NEAR(variable(bench, 1), 10, 1);
  EXPECT_EQ(variable(bench, 9), 0) << "accumulator and flags were saved";
}

TEST(Interrupts, OfAnInputComeOnTheChosenEdge) {
  for (const int edge : {1, 2, 3}) {
    Bench bench(pd1161);
    bench.run_program("VECT 39, In\nSGP 39, 3, " + std::to_string(edge) +
                      "\nEI 39\nEI 255\nLoop: JA Loop\nIn: CALCV ADD, 0, 1\nRETI\n");
    bench.wait(20 * one_millisecond);
    bench.module.world().set_inputs(1);
    bench.wait(20 * one_millisecond);
    EXPECT_EQ(variable(bench, 0), edge & 1);
    bench.module.world().set_inputs(0);
    bench.wait(20 * one_millisecond);
    EXPECT_EQ(variable(bench, 0), edge == 3 ? 2 : 1);
  }
}

TEST(Interrupts, OfAReachedPositionComeOnce) {
  Bench bench(pd1161);
  bench.run_program("VECT 3, Reached\nEI 3\nEI 255\nMVP ABS, 0, 2000\nLoop: JA Loop\nReached: CALCV ADD, 0, 1\nRETI\n");
  bench.wait(2'000 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 1);
}

TEST(Application, StopsContinuesStepsAndResets) {
  Bench bench(pd1161);
  bench.download("Loop: CALCV ADD, 0, 1\nCALCV ADD, 1, 1\nCALCV ADD, 2, 1\nJA Loop\n");
  bench.command(Opcode::reset_application);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  for (int step = 1; step <= 6; ++step) bench.command(Opcode::step_application);
  EXPECT_EQ(variable(bench, 0), 2);
  EXPECT_EQ(variable(bench, 1), 2);
  EXPECT_EQ(variable(bench, 2), 1);
  EXPECT_EQ(bench.get(GlobalParameter::program_counter), 2);
  bench.command(Opcode::run_application);
  EXPECT_EQ(bench.command(Opcode::get_application_status).value >> 24, 1) << "state in the top byte";
  bench.command(Opcode::stop_application);
  const std::int32_t address = bench.get(GlobalParameter::program_counter);
  bench.wait(20 * one_millisecond);
  EXPECT_EQ(bench.get(GlobalParameter::program_counter), address);
  bench.command(Opcode::reset_application);
  EXPECT_EQ(bench.get(GlobalParameter::program_counter), 0);
  EXPECT_EQ(bench.command(Opcode::run_application, 1, 0, 2048).status, Status::invalid_value);
}

TEST(Download, FillsTheWholeMemoryAndReadsBackWhatWasWritten) {
  Bench bench(tmcm1110);
  ASSERT_EQ(bench.command(Opcode::enter_download_mode).status, Status::ok);
  const auto instruction = [](std::int32_t n) { return Command{30, static_cast<std::uint8_t>(n % 21), 0, n * 99'991}; };
  for (std::int32_t n = 0; n < 2048; ++n) {
    ASSERT_EQ(bench.command(instruction(n)).status, Status::command_loaded) << n;
  }
  EXPECT_EQ(bench.command(instruction(0)).status, Status::program_memory_full);
  ASSERT_EQ(bench.command(Opcode::exit_download_mode).status, Status::ok);
  bench.wait(100 * one_millisecond);
  for (std::int32_t n = 0; n < 2048; ++n) {
    const auto reply = bench.exchange(encode(Request{1, {134, 0, 0, n}}));
    ASSERT_TRUE(reply.has_value());
    Datagram expected = encode(Request{2, instruction(n)});
    ASSERT_EQ(*reply, expected) << n;
  }
}

TEST(Download, StartsAtTheGivenAddress) {
  Bench bench(pd1161);
  for (const int address : {50, 60, 80}) {
    bench.command(Opcode::enter_download_mode, 0, 0, address);
    bench.command(Opcode::sgp, 0, 2, address);
    bench.command(Command{28, 0, 0, 0});
    bench.command(Opcode::exit_download_mode);
  }
  for (const int address : {80, 50, 60}) {
    bench.command(Opcode::run_application, 1, 0, address);
    bench.wait(20 * one_millisecond);
    EXPECT_EQ(variable(bench, 0), address);
  }
}

TEST(EndMarker, EndsTheProgram) {
  Bench bench(pd1161);
  bench.command(Opcode::enter_download_mode);
  bench.command(Opcode::sgp, 0, 2, 9);
  EXPECT_EQ(bench.command(Command{0, 0, 0, 0}).status, Status::command_loaded);
  bench.command(Opcode::exit_download_mode);
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(20 * one_millisecond);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  EXPECT_EQ(variable(bench, 0), 9);
}

TEST(ErrorsInAProgram, DoNotKeepItFromGoingOn) {
  Bench bench(pd1161);
  bench.command(Opcode::enter_download_mode);
  bench.command(Opcode::sap, 4, 0, 51200);
  bench.command(Opcode::sgp, 0, 2, 1);
  bench.command(Command{28, 0, 0, 0});
  bench.command(Opcode::exit_download_mode);
  bench.command(Opcode::run_application, 1, 0, 0);
  bench.wait(20 * one_millisecond);
  EXPECT_EQ(variable(bench, 0), 1);
  EXPECT_EQ(bench.get(AxisParameter::maximum_positioning_speed), 1000);
}

TEST(SoftwareReset, AnswersFirstAndThenRestarts) {
  Bench bench(pd1161);
  bench.set(AxisParameter::maximum_positioning_speed, 77);
  EXPECT_EQ(bench.command(Opcode::software_reset, 0, 0, 1).status, Status::invalid_value);
  EXPECT_EQ(bench.command(Opcode::software_reset, 0, 0, confirmation_code).status, Status::ok);
  EXPECT_EQ(bench.get(AxisParameter::maximum_positioning_speed), 1000);
}

}  // namespace
}  // namespace opentmcl::tests
