#include "lang/symbol_file.hpp"

#include <gtest/gtest.h>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

TEST(SymbolFile, HasLabelsByAddressAndConstantsWithTheirPlaces) {
  const AssemblyResult result = assemble_text(
      "#include TMCLParam.tmc\nSpeed = 1000 / 3\nStart: MST 0\n JA End\nEnd: Last: STOP\nHalf = -0.5\n", tmcm1110);
  EXPECT_EQ(symbol_file(result, tmcm1110),
            "// Labels and constants of test.tmc for the TMCM-1110 (firmware V1.08)\n"
            "Start = 0 // label, test.tmc:3\n"
            "End = 2 // label, test.tmc:5\n"
            "Last = 2 // label, test.tmc:5\n"
            "Speed = 333.3333333333333 // constant, test.tmc:2\n"
            "Half = -0.5 // constant, test.tmc:6\n");
}

TEST(SymbolFile, CanBeIncludedAndGivesTheSameValues) {
  const AssemblyResult first = assemble_text("Big = 2^40\nSmall = 1/3\nA: MST 0\nB: JA A\n");
  const AssemblyResult second = assemble_text(symbol_file(first, pd1161));
  EXPECT_TRUE(second.diagnostics.empty());
  for (const Symbol& symbol : first.symbols.symbols()) {
    const Symbol* const found = second.symbols.find(symbol.name);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->value, symbol.value) << symbol.name;
  }
}

}  // namespace
}  // namespace opentmcl::lang
