#include "lang/assembler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lang/assembling_test.hpp"
#include "lang/lexer.hpp"

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Assembler, WritesOperandsWhereTheTableHasThem) {
  EXPECT_THAT(commands_of("MVP REL, 0, -1000\n"
                          "SIO 1, 2, 1\n"
                          "DJNZ 42, 0\n"
                          "CALCVV SUB, 65, 42\n"
                          "AIV"),
              ElementsAre(command(Opcode::mvp, 1, 0, -1000), command(Opcode::sio, 1, 2, 1),
                          command(Opcode::djnz, 42, 0, 0), command(Opcode::calcvv, 1, 65, 42), command(Opcode::aiv)));
}

TEST(Assembler, IgnoresCaseBlanksAndComments) {
  EXPECT_THAT(commands_of("  sPeEd = 100 // slow\n"
                          "\tLOOP :mvp aBs ,0 , SPEED;there\n"
                          "\n"
                          "// nothing\n"
                          "\tja loop//back\n"),
              ElementsAre(command(Opcode::mvp, 0, 0, 100), command(Opcode::ja, 0, 0, 0)));
}

TEST(Assembler, TakesEveryLineEndAndEncoding) {
  for (const char* text : {"MST 0\nSTOP\n", "MST 0\r\nSTOP", "MST 0\rSTOP\r", "\xEF\xBB\xBFMST 0\nSTOP",
                           "MST 0 // h\xC3\xA4lt\nSTOP", "MST 0 // h\xE4lt\nSTOP"}) {
    EXPECT_THAT(commands_of(text), ElementsAre(command(Opcode::mst), command(Opcode::stop))) << text;
  }
}

TEST(Assembler, TakesOperandsWithUsualMeaningsOfMinusOne) {
  EXPECT_THAT(commands_of("WAIT TICKS, 0, -1\nSIO 255, 2, -1"),
              ElementsAre(command(Opcode::wait, 0, 0, -1), command(Opcode::sio, 255, 2, -1)));
}

TEST(Assembler, TakesNumbersForWords) {
  EXPECT_THAT(commands_of("Relative = 1\nMVP Relative, 0, 5\nJC 12, 0"),
              ElementsAre(command(Opcode::mvp, 1, 0, 5), command(Opcode::jc, 12, 0, 0)));
}

TEST(Assembler, TakesOneSurplusOperandIfItIsZero) {
  EXPECT_THAT(commands_of("GAP 1, 0, 0\nRSUB 0\nCALCX ADD, 0"),
              ElementsAre(command(Opcode::gap, 1), command(Opcode::rsub), command(Opcode::calcx)));
  EXPECT_THAT(problems_of("GAP 1, 0, 3"), ElementsAre(Problem{DiagnosticKind::wrong_operand_count, {1, 11}, "3"}));
  EXPECT_THAT(problems_of("GAP 1, 0, 0, 0"), ElementsAre(Problem{DiagnosticKind::wrong_operand_count, {1, 1}, "GAP"}));
}

TEST(Assembler, LetsUserFunctionsGoWithoutOperands) {
  EXPECT_THAT(commands_of("UF0\nUF7 1, 2, 3\nUF3 9"),
              ElementsAre(command(Opcode::uf0), command(Opcode::uf7, 1, 2, 3), command(Opcode::uf3, 9)));
}

TEST(Assembler, RoundsOperandsButNotConstants) {
  EXPECT_THAT(commands_of("Third = 10 / 4\nCOMP Third\nCOMP Third * 2\nCOMP -Third\nCOMP 2.4"),
              ElementsAre(command(Opcode::comp, 0, 0, 3), command(Opcode::comp, 0, 0, 5),
                          command(Opcode::comp, 0, 0, -3), command(Opcode::comp, 0, 0, 2)));
}

TEST(Assembler, ReachesBothEndsOfThe32BitRange) {
  EXPECT_THAT(commands_of("COMP -2147483648\nCOMP 2147483647\nCOMP $FFFFFFFF"),
              ElementsAre(command(Opcode::comp, 0, 0, int32_minimum), command(Opcode::comp, 0, 0, int32_maximum),
                          command(Opcode::comp, 0, 0, -1)));
  EXPECT_THAT(problems_of("COMP 2147483648\nCOMP 2147483647.5\nCOMP -2147483649"),
              ElementsAre(Problem{DiagnosticKind::not_encodable, {1, 6}, "2147483648"},
                          Problem{DiagnosticKind::not_encodable, {2, 6}, "2147483647.5"},
                          Problem{DiagnosticKind::not_encodable, {3, 6}, "-2147483649"}));
}

TEST(Labels, CanBeUsedBeforeAndAfterTheirDefinition) {
  EXPECT_THAT(commands_of("Start:\n"
                          "JC ZE, End\n"
                          "VECT 0, End + 1\n"
                          "JA Start\n"
                          "End: RETI\n"
                          "STOP"),
              ElementsAre(command(Opcode::jc, 0, 0, 3), command(Opcode::vect, 0, 0, 4), command(Opcode::ja, 0, 0, 0),
                          command(Opcode::reti), command(Opcode::stop)));
}

TEST(Labels, CanShareAnAddress) {
  const AssemblyResult result = assemble_text("First: Second:\n Third: STOP");
  ASSERT_TRUE(result.program.has_value());
  ASSERT_EQ(result.program->labels.size(), 3U);
  for (const Label& label : result.program->labels) EXPECT_EQ(label.address, 0U);
  EXPECT_EQ(result.program->labels[1].name, "Second");
}

TEST(Labels, MayHaveTheNamesOfInstructionsAndWords) {
  EXPECT_THAT(commands_of("Stop: JA stop\nAbs: MVP ABS, 0, Abs\nSTOP"),
              ElementsAre(command(Opcode::ja, 0, 0, 0), command(Opcode::mvp, 0, 0, 1), command(Opcode::stop)));
}

TEST(Labels, CanBeTheValueOfALaterConstant) {
  EXPECT_THAT(commands_of("MST 0\nHere:\nPlace = Here * 2\nJA Place\nSTOP"),
              ElementsAre(command(Opcode::mst), command(Opcode::ja, 0, 0, 2), command(Opcode::stop)));
}

TEST(Stop, IsAppendedUnlessItIsTheLastInstruction) {
  const AssemblyResult appended = assemble_text("MST 0\nEnd:\n", pd1161, true);
  ASSERT_TRUE(appended.program.has_value());
  EXPECT_THAT(appended.program->commands, ElementsAre(command(Opcode::mst), command(Opcode::stop)));
  EXPECT_THAT(appended.program->source_map, ElementsAre(Span{0, 0, 5}, Span{0, 11, 0}));
  EXPECT_THAT(appended.diagnostics, IsEmpty());
  EXPECT_THAT(assemble_text("STOP", pd1161, true).program->commands, ElementsAre(command(Opcode::stop)));
  EXPECT_THAT(assemble_text("", pd1161, true).program->commands, ElementsAre(command(Opcode::stop)));
  EXPECT_THAT(assemble_text("MST 0", pd1161, false).program->commands, ElementsAre(command(Opcode::mst)));
}

TEST(SourceMap, HasTheTextOfEveryInstruction) {
  const AssemblyResult result = assemble_text("Loop: MVP ABS, 0, 5 // go\n  JA Loop");
  ASSERT_TRUE(result.program.has_value());
  EXPECT_EQ(result.sources.text_of(result.program->source_map[0]), "MVP ABS, 0, 5");
  EXPECT_EQ(result.sources.text_of(result.program->source_map[1]), "JA Loop");
}

TEST(Errors, SayWhichModuleLacksAnInstruction) {
  const AssemblyResult result = assemble_text("  CALCVV SUB, 1, 2", tmcm1110);
  EXPECT_FALSE(result.program.has_value());
  EXPECT_THAT(problems_of(result.diagnostics, result.sources),
              ElementsAre(Problem{DiagnosticKind::instruction_not_available, {1, 3}, "CALCVV"}));
  EXPECT_EQ(result.diagnostics[0].message, "CALCVV is not available on the TMCM-1110 (firmware V1.08)");
  EXPECT_EQ(result.diagnostics[0].note,
            "only on the PD-1161 (firmware V1.47); use GGP and AGP for the variables, and CALCX");
}

TEST(Errors, SuggestNames) {
  const AssemblyResult result = assemble_text("Speed = 5\nWIAT TICKS, 0, 5\nROR 0, Sped\nMVP AB, 0, 1");
  ASSERT_EQ(result.diagnostics.size(), 3U);
  EXPECT_EQ(result.diagnostics[0].note, "did you mean WAIT?");
  EXPECT_EQ(result.diagnostics[1].note, "did you mean Speed?");
  EXPECT_EQ(result.diagnostics[2].note, "did you mean ABS?");
}

TEST(Errors, ArePlacedExactly) {
  struct Case {
    const char* text;
    Problem problem;
  };
  const Case cases[] = {
      {"MST 0 ?", {DiagnosticKind::unexpected_character, {1, 7}, "?"}},
      {"MST 0x1", {DiagnosticKind::malformed_number, {1, 5}, "0x1"}},
      {"COMP $123456789", {DiagnosticKind::number_too_large, {1, 6}, "$123456789"}},
      {"5 + 5", {DiagnosticKind::expected_statement, {1, 1}, "5"}},
      {"Loop: = 5", {DiagnosticKind::expected_statement, {1, 7}, "="}},
      {"Loop: #include a", {DiagnosticKind::expected_statement, {1, 7}, "#include a"}},
      {" #define A 5", {DiagnosticKind::unknown_directive, {1, 2}, "#define A 5"}},
      {"#include // none", {DiagnosticKind::missing_file_name, {1, 1}, "#include"}},
      {"#include \"\"", {DiagnosticKind::missing_file_name, {1, 1}, "#include \"\""}},
      {"#include none.tmc", {DiagnosticKind::file_not_found, {1, 10}, "none.tmc"}},
      {"\tMVQ ABS, 0, 1", {DiagnosticKind::unknown_instruction, {1, 2}, "MVQ"}},
      {"MVP ABS, 0", {DiagnosticKind::wrong_operand_count, {1, 1}, "MVP"}},
      {"MVP ABS, , 5", {DiagnosticKind::expected_expression, {1, 10}, ","}},
      {"MVP ABS, 0,", {DiagnosticKind::expected_expression, {1, 12}, ""}},
      {"MVP ABS, 0, 1 2", {DiagnosticKind::unexpected_token, {1, 15}, "2"}},
      {"MVP ABS, 0, (1", {DiagnosticKind::missing_parenthesis, {1, 13}, "("}},
      {"COMP SINUS(1)", {DiagnosticKind::unknown_function, {1, 6}, "SINUS"}},
      {"COMP 1 + Nowhere", {DiagnosticKind::undefined_name, {1, 10}, "Nowhere"}},
      {"A = Nowhere", {DiagnosticKind::undefined_name, {1, 5}, "Nowhere"}},
      {"COMP Later\nLater = 1", {DiagnosticKind::used_before_definition, {1, 6}, "Later"}},
      {"A = Later\nLater = 1", {DiagnosticKind::used_before_definition, {1, 5}, "Later"}},
      {"A = Later\nLater: STOP", {DiagnosticKind::used_before_definition, {1, 5}, "Later"}},
      {"COMP 1/0", {DiagnosticKind::division_by_zero, {1, 7}, "/"}},
      {"COMP SQRT(-1)", {DiagnosticKind::undefined_result, {1, 6}, "SQRT"}},
      {"MVP 3, 0, 1", {DiagnosticKind::invalid_word, {1, 5}, "3"}},
      {"CALCV 10, 1, 1", {DiagnosticKind::invalid_word, {1, 7}, "10"}},
      {"MST 256", {DiagnosticKind::not_encodable, {1, 5}, "256"}},
      {"GAP -1, 0", {DiagnosticKind::not_encodable, {1, 5}, "-1"}},
      {"A: STOP\na: STOP", {DiagnosticKind::duplicate_name, {2, 1}, "a"}},
      {"A = 1\nA = 2", {DiagnosticKind::duplicate_name, {2, 1}, "A"}},
      {"A: STOP\nA = 0", {DiagnosticKind::duplicate_name, {2, 1}, "A"}},
  };
  for (const Case& row : cases) {
    EXPECT_THAT(problems_of(row.text), ElementsAre(row.problem)) << row.text;
    EXPECT_FALSE(assemble_text(row.text).program.has_value()) << row.text;
  }
}

TEST(Errors, AreAllReportedInOneRunInTheOrderOfTheSource) {
  const AssemblyResult result = assemble_text(
      "JA Nowhere, Neither\n"
      "FOO\n"
      "MVP ABS, Missing1, Missing2\n"
      "@\n"
      "MST 300\n"
      "Ok: STOP\n");
  EXPECT_FALSE(result.program.has_value());
  EXPECT_THAT(problems_of(result.diagnostics, result.sources),
              ElementsAre(Problem{DiagnosticKind::undefined_name, {1, 4}, "Nowhere"},
                          Problem{DiagnosticKind::undefined_name, {1, 13}, "Neither"},
                          Problem{DiagnosticKind::unknown_instruction, {2, 1}, "FOO"},
                          Problem{DiagnosticKind::undefined_name, {3, 10}, "Missing1"},
                          Problem{DiagnosticKind::undefined_name, {3, 20}, "Missing2"},
                          Problem{DiagnosticKind::unexpected_character, {4, 1}, "@"},
                          Problem{DiagnosticKind::not_encodable, {5, 5}, "300"}));
}

TEST(Errors, InOperandsAreReportedOnceEvenIfALabelComesLater) {
  EXPECT_THAT(problems_of("JC 99, End\nEnd: STOP"), ElementsAre(Problem{DiagnosticKind::invalid_word, {1, 4}, "99"}));
}

TEST(Errors, OfOneLineDoNotMoveTheLabelsOfTheNext) {
  EXPECT_THAT(problems_of("FOO\nA: MST 0\nMVP 3, 0, A"),
              ElementsAre(Problem{DiagnosticKind::unknown_instruction, {1, 1}, "FOO"},
                          Problem{DiagnosticKind::invalid_word, {3, 5}, "3"}));
}

TEST(Errors, ShowWhereANameWasDefinedFirst) {
  const AssemblyResult result = assemble_text("A = 1\nA = 2");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].related, (Span{0, 0, 1}));
}

TEST(Constants, MayBeDefinedAgainWithTheSameValue) {
  EXPECT_THAT(commands_of("A = 2\na = 1 + 1\nCOMP A"), ElementsAre(command(Opcode::comp, 0, 0, 2)));
}

TEST(Capacity, IsThatOfTheModule) {
  std::string text;
  for (int i = 0; i < pd1161.program_capacity; ++i) text += "MST 0\n";
  EXPECT_TRUE(assemble_text(text, pd1161, false).program.has_value());
  const AssemblyResult result = assemble_text(text + "Last: RSUB", pd1161, false);
  EXPECT_THAT(problems_of(result.diagnostics, result.sources),
              ElementsAre(Problem{DiagnosticKind::program_too_large, {2049, 7}, "RSUB"}));
  EXPECT_FALSE(assemble_text(text, pd1161, true).program.has_value());

  MemoryFiles files;
  AssemblerOptions unlimited;
  unlimited.check_capacity = false;
  EXPECT_EQ(assemble("test.tmc", text, unlimited, files).program->commands.size(), 2049U);
}

TEST(Warnings, LeaveAProgram) {
  const AssemblyResult result = assemble_text("ROR 0, 51200");
  ASSERT_TRUE(result.program.has_value());
  EXPECT_THAT(result.program->commands, ElementsAre(command(Opcode::ror, 0, 0, 51200)));
  EXPECT_EQ(result.diagnostics.at(0).severity(), Severity::warning);
}

TEST(Warnings, TellWhatTheModuleWillRefuse) {
  struct Case {
    const char* text;
    Problem problem;
  };
  const Case cases[] = {
      {"ROR 0, 51200", {DiagnosticKind::operand_out_of_range, {1, 8}, "51200"}},
      {"SCO 21, 0, 5", {DiagnosticKind::operand_out_of_range, {1, 5}, "21"}},
      {"CALCVV ADD, 1, 256", {DiagnosticKind::operand_out_of_range, {1, 16}, "256"}},
      {"MST 1", {DiagnosticKind::no_such_motor, {1, 5}, "1"}},
      {"WAIT POS, 1, 0", {DiagnosticKind::no_such_motor, {1, 11}, "1"}},
      {"MVP ABS, 3, 0", {DiagnosticKind::no_such_motor, {1, 10}, "3"}},
      {"GAP 99, 0", {DiagnosticKind::no_such_parameter, {1, 5}, "99"}},
      {"GAP 213, 0", {DiagnosticKind::no_such_parameter, {1, 5}, "213"}},
      {"GGP 1, 0", {DiagnosticKind::no_such_parameter, {1, 5}, "1"}},
      {"GGP 1, 4", {DiagnosticKind::no_such_parameter, {1, 5}, "1"}},
      {"SGP 3, 3, 0", {DiagnosticKind::no_such_parameter, {1, 5}, "3"}},
      {"EI 50", {DiagnosticKind::no_such_parameter, {1, 4}, "50"}},
      {"SAP 8, 0, 1", {DiagnosticKind::parameter_not_accessible, {1, 5}, "8"}},
      {"STAP 1, 0", {DiagnosticKind::parameter_not_accessible, {1, 6}, "1"}},
      {"AGP 128, 0", {DiagnosticKind::parameter_not_accessible, {1, 5}, "128"}},
      {"SAP 4, 0, 50000", {DiagnosticKind::parameter_out_of_range, {1, 11}, "50000"}},
      {"SGP 77, 0, 2", {DiagnosticKind::parameter_out_of_range, {1, 12}, "2"}},
  };
  for (const Case& row : cases) {
    EXPECT_THAT(problems_of(row.text), ElementsAre(row.problem)) << row.text;
    EXPECT_TRUE(assemble_text(row.text).program.has_value()) << row.text;
  }
}

TEST(Warnings, SayThatSpeedsAreNoStepsPerSecond) {
  for (const char* text : {"ROR 0, 51200", "SAP 4, 0, 51200", "SAP 5, 0, 51200"}) {
    const AssemblyResult result = assemble_text(text);
    EXPECT_NE(result.diagnostics.at(0).note.find("not steps per second"), std::string::npos) << text;
  }
  EXPECT_EQ(assemble_text("SAP 140, 0, 9").diagnostics.at(0).note, "");
}

TEST(Warnings, AreNotGivenForWhatTheModuleTakes) {
  for (const char* text : {"MVP COORD, 255, 3", "SCO 0, 255, 0", "GCO 3, 255", "WAIT TICKS, 7, 10", "GGP 255, 2",
                           "SGP 0, 3, 1000", "EI 255", "GGP 5, 1", "RFS STATUS, 0"}) {
    EXPECT_THAT(problems_of(text), IsEmpty()) << text;
  }
}

TEST(Warnings, AreForTheModule) {
  EXPECT_THAT(problems_of("GAP 213, 0", tmcm1110), IsEmpty());
  EXPECT_THAT(problems_of("GAP 200, 0", tmcm1110),
              ElementsAre(Problem{DiagnosticKind::no_such_parameter, {1, 5}, "200"}));
}

// Programs like the ones the manuals show, with the errata applied.

TEST(ManualPrograms, TimerInterruptAssembles) {
  EXPECT_THAT(commands_of("#include Interrupts.inc\n"
                          "      VECT TI_TIMER0, Tick\n"
                          "      SGP TI_TIMER0, 3, 1000\n"
                          "      EI TI_TIMER0\n"
                          "      EI TI_GLOBAL\n"
                          "Main: SIO 1, 2, 1\n"
                          "      WAIT TICKS, 0, 50\n"
                          "      SIO 1, 2, 0\n"
                          "      WAIT TICKS, 0, 50\n"
                          "      JA Main\n"
                          "Tick: GIO 0, 2\n"
                          "      JC NZ, Off\n"
                          "      SIO 0, 2, 1\n"
                          "      RETI\n"
                          "Off:  SIO 0, 2, 0\n"
                          "      RETI\n"),
              ElementsAre(command(Opcode::vect, 0, 0, 9), command(Opcode::sgp, 0, 3, 1000), command(Opcode::ei, 0),
                          command(Opcode::ei, 255), command(Opcode::sio, 1, 2, 1), command(Opcode::wait, 0, 0, 50),
                          command(Opcode::sio, 1, 2, 0), command(Opcode::wait, 0, 0, 50), command(Opcode::ja, 0, 0, 4),
                          command(Opcode::gio, 0, 2), command(Opcode::jc, 1, 0, 13), command(Opcode::sio, 0, 2, 1),
                          command(Opcode::reti), command(Opcode::sio, 0, 2, 0), command(Opcode::reti)));
}

TEST(ManualPrograms, ConditionalCallsAssemble) {
  EXPECT_THAT(commands_of("Loop: GIO 0, 1\n"
                          "      CALC SUB, 512\n"
                          "      COMP 0\n"
                          "      CALL LT, Left\n"
                          "      CALL ZE, Halt\n"
                          "      CALL GT, Right\n"
                          "      JA Loop\n"
                          "Left: CALC MUL, -1\n"
                          "      ROLA 0\n"
                          "      RSUB\n"
                          "Halt: MST 0\n"
                          "      RSUB\n"
                          "Right: RORA 0\n"
                          "      RSUB\n"),
              ElementsAre(command(Opcode::gio, 0, 1), command(Opcode::calc, 1, 0, 512), command(Opcode::comp),
                          command(Opcode::call, 6, 0, 7), command(Opcode::call, 0, 0, 10),
                          command(Opcode::call, 4, 0, 12), command(Opcode::ja, 0, 0, 0),
                          command(Opcode::calc, 2, 0, -1), command(Opcode::rola), command(Opcode::rsub),
                          command(Opcode::mst), command(Opcode::rsub), command(Opcode::rora), command(Opcode::rsub)));
}

TEST(ManualPrograms, JumpTableOfThreeRoutinesAssembles) {
  EXPECT_THAT(commands_of("Func1: JA Func1Start\n"
                          "Func2: JA Func2Start\n"
                          "Func1Start: MVP ABS, 0, 1000\n"
                          "  WAIT POS, 0, 0\n"
                          "  STOP\n"
                          "Func2Start: ROL 0, 500\n"
                          "  WAIT TICKS, 0, 100\n"
                          "  MST 0\n"
                          "  STOP\n",
                          tmcm1110),
              ElementsAre(command(Opcode::ja, 0, 0, 2), command(Opcode::ja, 0, 0, 5), command(Opcode::mvp, 0, 0, 1000),
                          command(Opcode::wait, 1), command(Opcode::stop), command(Opcode::rol, 0, 0, 500),
                          command(Opcode::wait, 0, 0, 100), command(Opcode::mst), command(Opcode::stop)));
}

TEST(ManualPrograms, ValuesOfOtherModulesAreWarnedOf) {
  EXPECT_THAT(problems_of("ROR 0, 51200\nSAP 4, 0, 50000\nSAP 5, 0, 10000"),
              ElementsAre(Problem{DiagnosticKind::operand_out_of_range, {1, 8}, "51200"},
                          Problem{DiagnosticKind::parameter_out_of_range, {2, 11}, "50000"},
                          Problem{DiagnosticKind::parameter_out_of_range, {3, 11}, "10000"}));
}

TEST(OneInstruction, IsParsedWithExpressionsAndBuiltInConstants) {
  EXPECT_EQ(parse_instruction("MVP ABS, 0, 1000", pd1161).command, command(Opcode::mvp, 0, 0, 1000));
  EXPECT_EQ(parse_instruction("  sap APMaxCurrent, Motor0, 255 / 2 // half\n", tmcm1110).command,
            command(Opcode::sap, 6, 0, 128));
  EXPECT_EQ(parse_instruction("EI TI_GLOBAL", pd1161).command, command(Opcode::ei, 255));
}

TEST(OneInstruction, CarriesItsWarnings) {
  const InstructionResult result = parse_instruction("ROR 0, 51200", pd1161);
  EXPECT_EQ(result.command, command(Opcode::ror, 0, 0, 51200));
  EXPECT_EQ(format(result.diagnostics, result.sources).substr(0, 25), "instruction:1:8: warning:");
}

TEST(OneInstruction, IsOneAndNothingElse) {
  for (const char* text : {"", "// none", "A = 5", "Loop: STOP", "#include TMCLParam.tmc", "MST 0\nMST 0"}) {
    const InstructionResult result = parse_instruction(text, pd1161);
    EXPECT_FALSE(result.command.has_value()) << text;
    ASSERT_EQ(result.diagnostics.size(), 1U) << text;
    EXPECT_EQ(result.diagnostics[0].kind, DiagnosticKind::not_one_instruction) << text;
  }
  EXPECT_EQ(parse_instruction("MVP ABS, 0, Nowhere", pd1161).diagnostics.at(0).kind, DiagnosticKind::undefined_name);
  EXPECT_EQ(parse_instruction("CALL ZE, 0", tmcm1110).diagnostics.at(0).kind,
            DiagnosticKind::instruction_not_available);
}

TEST(Limits, KeepTheNumberOfDiagnosticsInBounds) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += "?\nROR 0, 9999\n";
  const AssemblyResult result = assemble_text(text);
  EXPECT_FALSE(result.program.has_value());
  EXPECT_EQ(result.diagnostics.size(), 2 * DiagnosticList::maximum_count + 2);
  EXPECT_EQ(result.diagnostics.back().kind, DiagnosticKind::too_many_warnings);
}

TEST(Limits, TakeTooManyWarningsForNoError) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += "ROR 0, 9999\n";
  MemoryFiles files;
  AssemblerOptions options;
  options.check_capacity = false;
  EXPECT_TRUE(assemble("test.tmc", text, options, files).program.has_value());
}

TEST(Limits, TakeLongNamesAndShowThemInPart) {
  const std::string name(30000, 'x');
  EXPECT_THAT(commands_of(name + ": JA " + name + "\nSTOP"), ElementsAre(command(Opcode::ja), command(Opcode::stop)));
  const AssemblyResult result = assemble_text("JA " + name);
  EXPECT_LT(format(result.diagnostics, result.sources).size(), 1500U);
}

TEST(Limits, AreClearOfLinesWithoutEnd) {
  std::string text;
  text.append(10'000'000, '(').append("\nMST 1\n");
  const AssemblyResult result = assemble_text(text);
  EXPECT_THAT(problems_of(result.diagnostics, result.sources),
              ElementsAre(Problem{DiagnosticKind::line_too_long, {1, 1}, ""},
                          Problem{DiagnosticKind::no_such_motor, {2, 5}, "1"}));
  EXPECT_LT(format(result.diagnostics, result.sources).size(), 1000U);
}

TEST(Limits, LetALineBeAsLongAsAllowedAndCommentsLonger) {
  const std::string instruction = "MST 0";
  const std::string longest = instruction + std::string(maximum_line_length - instruction.size(), ' ');
  for (const char* end : {"", "\n", "\r\n", "\r"}) {
    EXPECT_THAT(commands_of(longest + end), ElementsAre(command(Opcode::mst)));
    EXPECT_THAT(problems_of(longest + " 0" + end), ElementsAre(Problem{DiagnosticKind::line_too_long, {1, 1}, ""}));
    EXPECT_THAT(commands_of("MST 0 //" + std::string(1'000'000, '/') + end), ElementsAre(command(Opcode::mst)));
  }
}

TEST(Limits, TakeAMillionLabels) {
  constexpr int count = 1'000'000;
  std::string text;
  for (int i = 0; i < count; ++i) text += "L" + std::to_string(i) + ":\n";
  const AssemblyResult result = assemble_text(text + "MST 0\n");
  ASSERT_TRUE(result.program.has_value());
  EXPECT_EQ(result.program->labels.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(result.program->labels.back().address, 0U);
}

TEST(Limits, StopReadingWhatIsNoText) {
  std::string garbage;
  for (unsigned i = 0; i < 100'000; ++i) garbage += static_cast<char>(i * 2654435761U >> 13U);
  EXPECT_LT(assemble_text(garbage).diagnostics.size(), 50U);
  const AssemblyResult zeros = assemble_text(std::string(100'000, '\0'));
  ASSERT_EQ(zeros.diagnostics.size(), 1U);
  EXPECT_EQ(zeros.diagnostics[0].kind, DiagnosticKind::not_text);
}

TEST(Limits, HoldForAllFilesTogether) {
  MemoryFiles files;
  files.set("large.tmc", "//" + std::string(maximum_text_size / 4, ' '));
  const AssemblyResult result = assemble(
      "main.tmc", "#include large.tmc\n#include large.tmc\n#include large.tmc\n#include large.tmc\n", {}, files);
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].kind, DiagnosticKind::file_too_large);
  EXPECT_EQ(result.sources.size(), 4U);
  EXPECT_EQ(assemble("main.tmc", std::string(maximum_text_size + 1, ' '), {}, files).diagnostics.at(0).kind,
            DiagnosticKind::file_too_large);
}

TEST(Limits, EndFilesThatMultiplyEachOther) {
  MemoryFiles files;
  for (int depth = 0; depth < 30; ++depth) {
    const std::string next = "#include f" + std::to_string(depth + 1) + "\n";
    files.set("f" + std::to_string(depth), next + next);
  }
  const AssemblyResult result = assemble("f0", "#include f1\n#include f1\n", {}, files);
  EXPECT_FALSE(result.program.has_value());
  EXPECT_LE(result.sources.size(), 1000U);
  EXPECT_LE(result.diagnostics.size(), DiagnosticList::maximum_count + 1);
}

TEST(Limits, SuggestNamesForTheFirstProblemsOnly) {
  std::string text = "Target: MST 0\n";
  for (int i = 0; i < 1000; ++i) text += "JA Targt\n";
  const AssemblyResult result = assemble_text(text);
  ASSERT_EQ(result.diagnostics.size(), 1000U);
  EXPECT_EQ(result.diagnostics.front().note, "did you mean Target?");
  EXPECT_EQ(result.diagnostics.back().note, "");
}

TEST(Fixes, ChangeTheNameThatWasMistyped) {
  for (const char* text : {"WIAT TICKS, 0, 5", "MVP AB, 0, 5", "COMP SQRTT(4)", "MST 0 // no-warning: no-such-moter"}) {
    const AssemblyResult result = assemble_text(text);
    ASSERT_EQ(result.diagnostics.size(), 1U) << text;
    ASSERT_TRUE(result.diagnostics[0].fix.has_value()) << text;
    const Fix& fix = *result.diagnostics[0].fix;
    std::string mended = text;
    mended.replace(fix.span.offset, fix.span.length, fix.replacement);
    EXPECT_TRUE(assemble_text(mended).diagnostics.empty()) << mended;
  }
}

TEST(WarningsAsErrors, LeaveNoProgram) {
  MemoryFiles files;
  AssemblerOptions options;
  options.warnings_as_errors = true;
  const AssemblyResult result = assemble("test.tmc", "MST 1", options, files);
  EXPECT_FALSE(result.program.has_value());
  EXPECT_EQ(result.diagnostics.at(0).severity(), Severity::error);
  EXPECT_NE(format(result.diagnostics, result.sources).find("error: the PD-1161"), std::string::npos);
  EXPECT_TRUE(assemble("test.tmc", "MST 0", options, files).program.has_value());
}

RC_GTEST_PROP(Assembler, NeverCrashesAndPlacesDiagnosticsInTheTextWhateverTheBytes, ()) {
  const auto piece = rc::gen::oneOf(
      rc::gen::container<std::string>(rc::gen::arbitrary<char>()),
      rc::gen::element<std::string>("MVP ", "ABS, ", "0, ", "JA ", "a", "a: ", "a = ", "#include ", "TMCLParam.tmc",
                                    "test.tmc", "\n", "\n", "\r\n", "(", ")", "SIN(", " + ", "-", "$FF", "1e9", ",",
                                    "WAIT TICKS, 0, 5", "STOP", "GAP 1, 0, 0", "//", "^"));
  const auto pieces = *rc::gen::container<std::vector<std::string>>(piece);
  std::string text;
  for (const std::string& part : pieces) text += part;
  const AssemblyResult result = assemble_text(text);
  bool has_errors = false;
  for (const Diagnostic& diagnostic : result.diagnostics) {
    has_errors = has_errors || diagnostic.severity() == Severity::error;
    RC_ASSERT(diagnostic.span.offset + diagnostic.span.length <= result.sources[diagnostic.span.file].text.size());
    RC_ASSERT(!format(diagnostic, result.sources).empty());
  }
  RC_ASSERT(result.program.has_value() != has_errors);
  if (result.program) RC_ASSERT(result.program->commands.size() == result.program->source_map.size());
}

}  // namespace
}  // namespace opentmcl::lang
