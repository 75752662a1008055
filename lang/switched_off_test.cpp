#include "lang/switched_off.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Problem second_motor(std::size_t line) {
  return {DiagnosticKind::no_such_motor, {line, 5}, "1"};
}

TEST(SwitchedOff, IsALineByACommentAtItsEnd) {
  EXPECT_THAT(problems_of("MST 1 // no-warning: no-such-motor\nMST 1\n"), ElementsAre(second_motor(2)));
  EXPECT_THAT(problems_of("MST 1 ; no-warning: no-such-motor\r\nMST 1 // no-warning: unused-label"),
              ElementsAre(second_motor(2)));
}

TEST(SwitchedOff, IsAFileByACommentOnALineOfItsOwn) {
  EXPECT_THAT(problems_of("MST 1\n\t// no-warning: no-such-motor\nMST 1\n"), IsEmpty());
}

TEST(SwitchedOff, IsNotAnotherFile) {
  MemoryFiles files;
  files.set("part.tmc", "MST 1\n");
  AssemblerOptions options;
  options.check_program = false;
  const AssemblyResult result =
      assemble("main.tmc", "// no-warning: no-such-motor\n#include part.tmc\nMST 1\n", options, files);
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].span.file, 1U);
}

TEST(SwitchedOff, AreSeveralWarningsOrAll) {
  EXPECT_THAT(problems_of("ROR 1, 5000 // no-warning: no-such-motor, operand-out-of-range"), IsEmpty());
  EXPECT_THAT(problems_of("ROR 1, 5000 // no-warning: no-such-motor operand-out-of-range"), IsEmpty());
  EXPECT_THAT(problems_of("ROR 1, 5000 // no-warning: ALL"), testing::SizeIs(3));  // the case of letters counts here
  EXPECT_THAT(problems_of("ROR 1, 5000 // no-warning: all"), IsEmpty());
}

TEST(SwitchedOff, AreNeverErrors) {
  EXPECT_THAT(problems_of("FOO // no-warning: all"),
              ElementsAre(Problem{DiagnosticKind::unknown_instruction, {1, 1}, "FOO"}));
}

TEST(SwitchedOff, TakesNamesThatExist) {
  EXPECT_THAT(problems_of("MST 0 // no-warning: no-such-moter, unknown-instruction"),
              ElementsAre(Problem{DiagnosticKind::unknown_warning, {1, 22}, "no-such-moter"},
                          Problem{DiagnosticKind::unknown_warning, {1, 37}, "unknown-instruction"}));
}

TEST(SwitchedOff, IsNothingByCodeOrInTheMiddleOfAComment) {
  EXPECT_THAT(problems_of("MST 1 // that is no-warning: no-such-motor"), ElementsAre(second_motor(1)));
  EXPECT_THAT(problems_of("// casino-warning: no-such-motor\nMST 1"), ElementsAre(second_motor(2)));
  EXPECT_THAT(problems_of("-warning: x"), ElementsAre(Problem{DiagnosticKind::expected_statement, {1, 1}, "-"}));
}

TEST(SwitchedOff, ReadsALineWithManyMarksOnce) {
  std::string text = "MST 1 //";
  for (int i = 0; i < 50000; ++i) text += " no-warning: x";
  const AssemblyResult result = assemble_text(text);
  EXPECT_EQ(result.diagnostics.front().kind, DiagnosticKind::no_such_motor);
  EXPECT_EQ(result.diagnostics.size(), DiagnosticList::maximum_count + 1);
}

}  // namespace
}  // namespace opentmcl::lang
