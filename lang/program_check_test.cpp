// Cases beyond the examples of docs/diagnostics.md, which diagnostics_page_test.cpp tries.
#include "lang/program_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

AssemblyResult assemble_program(const std::string& text, bool append_stop = true) {
  MemoryFiles files;
  files.set("part.tmc", "PartSpeed = 5\nPart: MST 0\n RSUB\nOther: RSUB\n");
  AssemblerOptions options;
  options.append_stop = append_stop;
  return assemble("test.tmc", text, options, files);
}

std::vector<Problem> problems_of_program(const std::string& text, bool append_stop = true) {
  const AssemblyResult result = assemble_program(text, append_stop);
  return problems_of(result.diagnostics, result.sources);
}

TEST(Reachability, TakesEveryLabelForAnEntryOfTheHost) {
  EXPECT_THAT(problems_of_program("JA Main\nFirst: ROR 0, 100\nSTOP\nSecond: MST 0\nJA Second\nMain: STOP\n"),
              IsEmpty());
}

TEST(Reachability, KnowsTablesOfJumps) {
  EXPECT_THAT(problems_of_program("JA A\nJA B\nJA C\nA: STOP\nB: ROR 0, 1\nSTOP\nC: MST 0\nSTOP\n"), IsEmpty());
}

TEST(Reachability, LetsStopMarkAnEnd) {
  EXPECT_THAT(problems_of_program("Loop: ROR 0, 1\nJA Loop\nSTOP\n"), IsEmpty());
}

TEST(Reachability, ReportsAStretchOnce) {
  EXPECT_THAT(problems_of_program("STOP\nMST 0\nMST 0\nMST 0\nBack: MST 0\nJA Back\nMST 0\n"),
              ElementsAre(Problem{DiagnosticKind::unreachable_code, {2, 1}, "MST 0"},
                          Problem{DiagnosticKind::unreachable_code, {7, 1}, "MST 0"}));
}

TEST(Reachability, FollowsComputedAddressesVectorsAndRestarts) {
  EXPECT_THAT(problems_of_program("VECT 0, 4\nJC ZE, 2 + 4\nRST 8\nMST 0\nMST 0\nRETI\nMST 0\nSTOP\nMST 0\n"),
              ElementsAre(Problem{DiagnosticKind::unreachable_code, {4, 1}, "MST 0"}));
}

TEST(Reachability, KnowsThatASubroutineComesBack) {
  EXPECT_THAT(problems_of_program("CSUB Sub\nMST 0\nSTOP\nSub: RSUB\n"), IsEmpty());
}

TEST(Reachability, WarnsOfAnEndWithoutStopOnlyIfItIsReached) {
  EXPECT_THAT(problems_of_program("JA 0\nSub: RSUB\n", false),
              ElementsAre(Problem{DiagnosticKind::unused_label, {2, 1}, "Sub"}));
  EXPECT_THAT(problems_of_program("MST 0\nCSUB 0", false),
              ElementsAre(Problem{DiagnosticKind::no_stop_at_end, {2, 1}, "CSUB 0"},
                          Problem{DiagnosticKind::recursive_subroutine, {2, 1}, "CSUB 0"}));
}

std::string nested_calls(int depth) {
  std::string text = "CSUB S1\nSTOP\n";
  for (int i = 1; i < depth; ++i) {
    text += "S" + std::to_string(i) + ": CSUB S" + std::to_string(i + 1) + "\nRSUB\n";
  }
  return text + "S" + std::to_string(depth) + ": MST 0\nRSUB\n";
}

TEST(Subroutines, NestUpToTheStack) {
  EXPECT_THAT(problems_of_program(nested_calls(maximum_open_calls)), IsEmpty());
  EXPECT_THAT(problems_of_program(nested_calls(maximum_open_calls + 1)),
              ElementsAre(Problem{DiagnosticKind::subroutines_nested_too_deep, {17, 5}, "CSUB S9"}));
}

TEST(Subroutines, CountThoseThatAnInterruptFindsOpen) {
  const std::string interrupt = "Tick: CSUB Sub\nRETI\nSub: RSUB\n";
  EXPECT_THAT(problems_of_program("VECT 0, Tick\n" + nested_calls(maximum_open_calls - 1) + interrupt), IsEmpty());
  EXPECT_THAT(problems_of_program("VECT 0, Tick\n" + nested_calls(maximum_open_calls) + interrupt),
              ElementsAre(Problem{DiagnosticKind::subroutines_nested_too_deep, {20, 7}, "CSUB Sub"}));
}

TEST(Subroutines, MayBeCalledFromManyPlacesAndFromEachOther) {
  EXPECT_THAT(problems_of_program("L: CSUB A\nCSUB B\nCSUB A\nJA L\nA: CSUB B\nCALL ZE, B\nRSUB\nB: RSUB\n"),
              IsEmpty());
}

TEST(Subroutines, AreRecursiveThroughOthersToo) {
  EXPECT_THAT(problems_of_program("CSUB A\nSTOP\nA: CSUB B\nRSUB\nB: CSUB A\nRSUB\n"),
              ElementsAre(Problem{DiagnosticKind::recursive_subroutine, {3, 4}, "CSUB B"},
                          Problem{DiagnosticKind::recursive_subroutine, {5, 4}, "CSUB A"}));
}

TEST(Subroutines, AreForgottenByRst) {
  EXPECT_THAT(problems_of_program("L: CSUB A\nJA L\nA: RST L\n"), IsEmpty());
}

TEST(Interrupts, MayEndByRestartOrByAStopOfTheirOwn) {
  const std::string main = "VECT 0, Tick\nEI 0\nEI 255\nL: JA L\n";
  EXPECT_THAT(problems_of_program(main + "Tick: RST L\n"), IsEmpty());
  EXPECT_THAT(problems_of_program(main + "Tick: MST 0\nSTOP\n"), IsEmpty());
  EXPECT_THAT(problems_of_program(main + "Tick: MST 0\n"),
              ElementsAre(Problem{DiagnosticKind::interrupt_without_return, {5, 7}, "MST 0"}));
}

TEST(Interrupts, AreNoEndOfTheProgramsOwnStop) {
  EXPECT_THAT(problems_of_program("VECT 0, Tick\nJC ZE, End\nMST 0\nEnd: STOP\nTick: JA End\n"),
              ElementsAre(Problem{DiagnosticKind::interrupt_without_return, {5, 7}, "JA End"}));
}

TEST(Interrupts, ShowWhereTheyWereMade) {
  const AssemblyResult result = assemble_program("VECT 0, Tick\nL: JA L\nTick: MST 0\n");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  ASSERT_TRUE(result.diagnostics[0].related.has_value());
  EXPECT_EQ(result.sources.text_of(*result.diagnostics[0].related), "VECT 0, Tick");
}

TEST(Interrupts, WaitEndlesslyInSubroutinesToo) {
  EXPECT_THAT(problems_of_program("VECT 0, Tick\nL: CSUB Pause\nJA L\nTick: CSUB Wait\nRETI\n"
                                  "Wait: WAIT POS, 0, 0\nRSUB\nPause: WAIT POS, 0, 0\nRSUB\n"),
              ElementsAre(Problem{DiagnosticKind::endless_wait_in_interrupt, {6, 7}, "WAIT POS, 0, 0"}));
}

TEST(Interrupts, MayWaitForTicks) {
  EXPECT_THAT(problems_of_program("VECT 0, Tick\nL: JA L\nTick: WAIT TICKS, 0, 5\nWAIT TICKS, 0, -1\n"
                                  "WAIT POS, 0, 10\nRETI\n"),
              IsEmpty());
}

TEST(Interrupts, AreNotRunBySettingTheirVectors) {
  EXPECT_THAT(problems_of_program("VECT 0, A\nVECT 1, A\nVECT 3, B\nL: JA L\nA: RETI\nB: RETI\n"), IsEmpty());
}

TEST(Stores, InLoopsAndWhatLoopsCall) {
  EXPECT_THAT(problems_of_program("L: CSUB Save\nJA L\nSave: STGP 1, 2\nRSUB\n"),
              ElementsAre(Problem{DiagnosticKind::stored_in_loop, {3, 7}, "STGP 1, 2"}));
  EXPECT_THAT(problems_of_program("L: SGP 77, 0, 1\nDJNZ 1, L\nSGP 77, 0, 0\n"),
              ElementsAre(Problem{DiagnosticKind::stored_in_loop, {1, 4}, "SGP 77, 0, 1"}));
  EXPECT_THAT(problems_of_program("L: SCO 1, 255, 0\nRST L\n"),
              ElementsAre(Problem{DiagnosticKind::stored_in_loop, {1, 4}, "SCO 1, 255, 0"}));
}

TEST(Stores, InRoutinesOfTimersButNotOfOtherInterrupts) {
  const std::string rest = "L: JA L\nR: STAP 4, 0\nRETI\n";
  EXPECT_THAT(problems_of_program("VECT 1, R\n" + rest),
              ElementsAre(Problem{DiagnosticKind::stored_in_loop, {3, 4}, "STAP 4, 0"}));
  EXPECT_THAT(problems_of_program("VECT 40, R\n" + rest), IsEmpty());
}

TEST(Stores, OnceAreNoWear) {
  EXPECT_THAT(problems_of_program("STAP 4, 0\nSGP 77, 0, 1\nCSUB S\nL: SGP 5, 2, 1\nAGP 6, 2\nSCO 1, 0, 5\nJA L\n"
                                  "S: STGP 1, 2\nRSUB\n"),
              IsEmpty());
}

TEST(Names, OfIncludedFilesNeedNotBeUsed) {
  EXPECT_THAT(problems_of_program("#include TMCLParam.tmc\nCSUB Part\nSTOP\n#include part.tmc\n"), IsEmpty());
}

TEST(Names, AreUsedByConstantsAndExpressions) {
  EXPECT_THAT(problems_of_program("A = 5\nB = A\nCOMP B + 1\nL: JA L + 0\n"), IsEmpty());
}

TEST(Names, OfRoutinesNobodyCallsAreUnused) {
  EXPECT_THAT(problems_of_program("Start: STOP\nSub: MST 0\nRSUB\nHost: MST 0\nSTOP\n"),
              ElementsAre(Problem{DiagnosticKind::unused_label, {2, 1}, "Sub"}));
}

TEST(Names, CanBeTakenAway) {
  const AssemblyResult result = assemble_program("MST 0\nUnused : MST 0\n");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  const std::optional<Fix> fix = result.diagnostics[0].fix;
  ASSERT_TRUE(fix.has_value());
  EXPECT_EQ(result.sources.text_of(fix->span), "Unused :");
  EXPECT_EQ(fix->replacement, "");
}

TEST(Checks, AreOnlyForProgramsWithoutErrors) {
  EXPECT_THAT(problems_of_program("A = 5\nFOO\nSTOP\nMST 0\n"),
              ElementsAre(Problem{DiagnosticKind::unknown_instruction, {2, 1}, "FOO"}));
}

TEST(Checks, TakeEmptyPrograms) {
  EXPECT_THAT(problems_of_program("", false), IsEmpty());
  EXPECT_THAT(problems_of_program("End:", false), ElementsAre(Problem{DiagnosticKind::label_after_end, {1, 1}, "End"}));
}

}  // namespace
}  // namespace opentmcl::lang
