#include "lang/explanation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lang/assembling_test.hpp"
#include "lang/instruction_table.hpp"
#include "lang/table_rows.hpp"

namespace opentmcl::lang {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

std::optional<Explanation> explain_operand_of(const Command& instruction, std::size_t index,
                                              const ModuleDescription& module = pd1161) {
  for (const InstructionSpec& row : instructions) {
    if (static_cast<std::uint8_t>(row.opcode) != instruction.opcode) continue;
    return explain_operand(row.operands[index], instruction, module, units::factory_scale(module));
  }
  return std::nullopt;
}

TEST(Explanation, OfAnInstructionListsItsOperands) {
  const Explanation mvp = explain(*find_mnemonic("MVP"), tmcm1110);
  EXPECT_EQ(mvp.title, "MVP mode, motor, position");
  EXPECT_THAT(mvp.lines, Contains("- mode: ABS, REL, COORD"));
  EXPECT_THAT(mvp.lines, Contains("- position: -2147483648...2147483647, microsteps"));
  EXPECT_EQ(explain(*find_mnemonic("STOP"), tmcm1110).title, "STOP");
  EXPECT_THAT(explain(*find_mnemonic("ROR"), pd1161).lines, Contains("- velocity: -2047...2047, internal velocity"));
  EXPECT_THAT(explain(*find_mnemonic("CALCV"), pd1161).lines, Contains(HasSubstr("LOAD, COMP"))) << "and not SWAP";
}

TEST(Explanation, SaysWhichInstructionAModuleLacks) {
  EXPECT_THAT(explain(*find_mnemonic("CALL"), tmcm1110).lines,
              Contains("Not available on the TMCM-1110 (firmware V1.08)."));
  EXPECT_EQ(explain(*find_mnemonic("CALL"), pd1161).lines.back(), "In programs only.");
}

TEST(Explanation, OfAParameterHasNameRangeUnitAccessAndPhysicalValue) {
  const Explanation speed = explain(*find_axis_parameter(4, pd1161), pd1161);
  EXPECT_EQ(speed.title, "APMaxPositioningSpeed = 4");
  EXPECT_THAT(speed.lines,
              ElementsAre("axis parameter 4 of the PD-1161: maximum positioning speed",
                          "Top speed of positioning ramps.", "Range: 1...2047, internal velocity",
                          HasSubstr("Default: 1000 = 30517.6 microsteps/s"), "Access: read, write, store and restore"));
}

TEST(Explanation, ExistsForEveryRowOfTheTables) {
  for (const ModuleDescription& module : modules) {
    for (const InstructionSpec& row : instructions) {
      if (row.mnemonic == nullptr) continue;
      EXPECT_FALSE(explain(row, module).lines.empty());
      for (std::size_t i = 0; i < operand_count(row); ++i) {
        EXPECT_NE(name_of_operand_kind(row.operands[i].kind), "") << row.mnemonic;
      }
    }
    for (const AxisParameterSpec& row : axis_parameters) EXPECT_EQ(explain(row, module).lines.size(), 5U);
    for (const GlobalParameterSpec& row : global_parameters) EXPECT_EQ(explain(row, module).lines.size(), 5U);
  }
}

TEST(Explanation, OfAnOperandIsWhatItChooses) {
  EXPECT_EQ(explain_operand_of(command(Opcode::gap, 140), 0)->title, "APMicrostepResolution = 140");
  EXPECT_EQ(explain_operand_of(command(Opcode::ggp, 65), 0)->title, "GPBaudRate = 65");
  EXPECT_EQ(explain_operand_of(command(Opcode::ggp, 60, 2), 0)->title, "user variable 60");
  EXPECT_EQ(explain_operand_of(command(Opcode::ggp, 27, 3), 0)->title, "TI_STOP_LEFT0 = 27");
  EXPECT_EQ(explain_operand_of(command(Opcode::vect, 0), 0)->title, "TI_TIMER0 = 0");
  EXPECT_EQ(explain_operand_of(command(Opcode::gio, 8, 1), 0)->lines.front(), "supply voltage");
  EXPECT_EQ(explain_operand_of(command(Opcode::gap, 99), 0), std::nullopt);
  EXPECT_EQ(explain_operand_of(command(Opcode::vect, 44), 0, pd1161), std::nullopt);
}

TEST(Explanation, OfAValueIsWhatItIsPhysicallyAndItsRange) {
  const auto value = explain_operand_of(command(Opcode::sap, 4, 0, 500), 2);
  ASSERT_TRUE(value);
  EXPECT_THAT(value->title, HasSubstr("rpm"));
  EXPECT_THAT(value->lines, ElementsAre("maximum positioning speed: 1...2047"));
  EXPECT_THAT(explain_operand_of(command(Opcode::wait, 0, 0, 50), 2)->title, HasSubstr("500 ms"));
  EXPECT_EQ(explain_operand_of(command(Opcode::comp, 0, 0, 50), 0), std::nullopt);
}

TEST(Explanation, OfASymbolIsItsValue) {
  const AssemblyResult result = assemble_text("Angle = 0.1\nSTOP\nEnd: JA End\n");
  EXPECT_EQ(explain(*result.symbols.find("angle")).title, "Angle = 0.1");
  EXPECT_EQ(explain(*result.symbols.find("end")).lines.front(), "label, address 1");
}

}  // namespace
}  // namespace opentmcl::lang
