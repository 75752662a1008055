#include "lang/operand_values.hpp"

#include <gtest/gtest.h>

#include <string>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

OperandValues values_of(const std::string& text) {
  AssemblyResult result = assemble_text("Speed = 99.6\n" + text);
  const std::string_view all = result.sources[0].text;
  Lexer lexer(all, all.rfind('\n') + 1);
  SourceLine line;
  read_source_line(lexer, all, line);
  return operand_values(line, all, 0, result.symbols);
}

TEST(OperandValues, AreThoseOfTheInstruction) {
  const OperandValues values = values_of("SAP 4, 0, -Speed / 2");
  EXPECT_EQ(values.command, command(Opcode::sap, 4, 0, -50));
  EXPECT_TRUE(values.is_known[0] && values.is_known[1] && values.is_known[2]);
  EXPECT_EQ(values_of("MVP rel, 0, 7").command, command(Opcode::mvp, 1, 0, 7));
  EXPECT_EQ(values_of("JA Later\nLater: JA Later").command, command(Opcode::ja, 0, 0, 1));
}

TEST(OperandValues, KnowsWhatIsMissingOrHasNoValue) {
  const OperandValues unfinished = values_of("SAP 4, Nobody,");
  EXPECT_EQ(unfinished.command, command(Opcode::sap, 4));
  EXPECT_TRUE(unfinished.is_known[0]);
  EXPECT_FALSE(unfinished.is_known[1] || unfinished.is_known[2]);
  EXPECT_FALSE(values_of("SAP 256, 0, 0").is_known[0]);
  EXPECT_FALSE(values_of("ROR 0, 1e99").is_known[1]);
  EXPECT_FALSE(values_of("ROR 0, 1 / 0").is_known[1]);
}

}  // namespace
}  // namespace opentmcl::lang
