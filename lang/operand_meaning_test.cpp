#include "lang/operand_meaning.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "lang/assembling_test.hpp"
#include "lang/instruction_table.hpp"

namespace opentmcl::lang {
namespace {

/// Name and unit of each operand of an instruction that has one: "maximum positioning speed, internal velocity".
std::string meaning_of(std::string_view text, const ModuleDescription& module = pd1161) {
  const InstructionResult parsed = parse_instruction(text, module);
  if (!parsed.command) return "no instruction: " + format(parsed.diagnostics, parsed.sources);
  const InstructionSpec& instruction = *find_instruction(parsed.command->opcode, module.id);
  std::string meaning;
  for (std::size_t i = 0; i < operand_count(instruction); ++i) {
    for (const std::string_view word :
         {name_of_operand(instruction.operands[i], *parsed.command, module),
          std::string_view(name_of(unit_of_operand(instruction.operands[i], *parsed.command, module)))}) {
      if (!word.empty()) meaning += (meaning.empty() ? "" : ", ") + std::string(word);
    }
  }
  return meaning;
}

TEST(OperandMeaning, OfAnAxisParameterIsThatOfItsRow) {
  EXPECT_EQ("maximum positioning speed, internal velocity", meaning_of("SAP 4, 0, 1000"));
  EXPECT_EQ("maximum current", meaning_of("GAP 6, 0"));
  EXPECT_EQ("maximum current", meaning_of("STAP 6, 0"));
}

TEST(OperandMeaning, OfAGlobalParameterDependsOnItsBank) {
  EXPECT_EQ("serial heartbeat, ms", meaning_of("SGP 68, 0, 500"));
  EXPECT_EQ("timer 0, ms", meaning_of("SGP 0, 3, 500"));
  EXPECT_EQ("input change 0", meaning_of("SGP 39, 3, 2"));
  EXPECT_EQ("", meaning_of("SGP 68, 2, 500"));
  EXPECT_EQ("", meaning_of("SGP 68, 77, 500"));
}

TEST(OperandMeaning, OfMotionIsSpeedDistanceOrTime) {
  EXPECT_EQ("internal velocity", meaning_of("ROR 0, 100"));
  EXPECT_EQ("microsteps", meaning_of("MVP REL, 0, 100"));
  EXPECT_EQ("", meaning_of("MVP COORD, 0, 1"));
  EXPECT_EQ("microsteps", meaning_of("SCO 1, 0, 100"));
  EXPECT_EQ("10 ms", meaning_of("WAIT TICKS, 0, 100"));
  EXPECT_EQ("", meaning_of("WAIT TICKS, 0, -1"));
  EXPECT_EQ("", meaning_of("WAIT POS, 0, 0"));
}

TEST(OperandMeaning, OfPortsAndInterruptsIsTheirName) {
  EXPECT_EQ("digital output 1", meaning_of("SIO 1, 2, 1"));
  EXPECT_EQ("supply voltage", meaning_of("GIO 8, 1"));
  EXPECT_EQ("target position reached 0", meaning_of("VECT 3, 5"));
  EXPECT_EQ("global interrupts", meaning_of("EI 255"));
}

TEST(OperandMeaning, IsNoneForWhatTheModuleLacks) {
  EXPECT_EQ("boost current, 1/255 of full-scale current", meaning_of("SAP 200, 0, 1"));
  EXPECT_EQ("", meaning_of("SAP 200, 0, 1", tmcm1110));
  EXPECT_EQ("", meaning_of("SAP 99, 0, 1"));
  EXPECT_EQ("", meaning_of("SGP 0, 0, 1"));
  EXPECT_EQ("", meaning_of("GIO 77, 0"));
  EXPECT_EQ("", meaning_of("DI 43"));
  EXPECT_EQ("input change 4", meaning_of("DI 43", tmcm1110));
}

TEST(OperandRange, IsWrittenAsInTheManual) {
  EXPECT_EQ("-2047...2047", range_text(-2047, 2047));
  EXPECT_EQ("0", range_text(0, 0));
}

}  // namespace
}  // namespace opentmcl::lang
