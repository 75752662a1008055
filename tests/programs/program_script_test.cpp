#include "tests/programs/program_script.hpp"

#include <gmock/gmock.h>

namespace opentmcl::tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

TEST(ProgramScript, OfAProgramWithoutScriptIsEmptyAndForBothModules) {
  const ProgramScript script = parse_script("// A remark about what to expect\nSTOP // at once\n");
  EXPECT_THAT(script.modules, ElementsAre(ModuleId::tmcm1110, ModuleId::pd1161));
  EXPECT_FALSE(script.run_time);
  EXPECT_THAT(script.settings, IsEmpty());
  EXPECT_THAT(script.expectations, IsEmpty());
  EXPECT_THAT(script.errors, IsEmpty());
}

TEST(ProgramScript, HasModuleAndRunTime) {
  const ProgramScript script = parse_script("// module: pd1161\n// run: 1.5 s\n");
  EXPECT_THAT(script.modules, ElementsAre(ModuleId::pd1161));
  EXPECT_EQ(script.run_time, 1'500'000U);
}

TEST(ProgramScript, PutsSettingsInTheOrderOfTheirTimes) {
  const ProgramScript script = parse_script("// at 2 s: input 3 = high\n  // at 500 ms: left switch = low\n");
  ASSERT_THAT(script.settings, SizeIs(2));
  EXPECT_EQ(script.settings[0].time, 500'000U);
  EXPECT_EQ(script.settings[0].line, 2);
  EXPECT_EQ(script.settings[0].quantity.name, "left switch");
  EXPECT_FALSE(script.settings[0].quantity.number);
  EXPECT_EQ(script.settings[0].value, 0);
  EXPECT_EQ(script.settings[1].quantity.name, "input");
  EXPECT_EQ(script.settings[1].quantity.number, 3);
  EXPECT_EQ(script.settings[1].value, 1);
}

TEST(ProgramScript, ExpectsAtTheEndAtATimeOrWithinATime) {
  const ProgramScript script = parse_script(
      "// expect: variable 17 = -5\n"
      "// expect: position = 1000 +- 20 at 100 ms\n"
      "// expect: program = stopped within 3 s\n");
  ASSERT_THAT(script.expectations, SizeIs(3));
  EXPECT_EQ(script.expectations[0].quantity.number, 17);
  EXPECT_EQ(script.expectations[0].value, -5);
  EXPECT_EQ(script.expectations[0].when, Expectation::When::at_end);
  EXPECT_EQ(script.expectations[1].tolerance, 20);
  EXPECT_EQ(script.expectations[1].when, Expectation::When::at);
  EXPECT_EQ(script.expectations[1].time, 100'000U);
  EXPECT_EQ(script.expectations[2].when, Expectation::When::within);
  EXPECT_EQ(script.expectations[2].time, 3'000'000U);
}

TEST(ProgramScript, NamesLinesThatAreNearlyRight) {
  const char* const lines[] = {
      "// expect variable 3 = 17", "// expect: variable 3",       "// expect: variable 3 = many",
      "// at 500: input 1 = high", "// at 500 ms: input 1 == 1 ", "// module: tmcm1140",
      "// run: for ever",          "// expect: x = 1 before 2 s",
  };
  for (const char* const line : lines) {
    EXPECT_THAT(parse_script(line).errors, SizeIs(1)) << line;
  }
}

}  // namespace
}  // namespace opentmcl::tests
