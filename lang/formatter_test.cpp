#include "lang/formatter.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lang/assembling_test.hpp"
#include "lang/generated_program_test.hpp"
#include "lang/lexer.hpp"
#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

/// What the assembler makes of a text: the program, or only that there is none.
std::optional<std::vector<Command>> program_of(std::string_view text, const ModuleDescription& module) {
  AssemblyResult result = assemble_text(text, module);
  if (!result.program) return std::nullopt;
  return std::move(result.program->commands);
}

std::string applied(std::string_view source, const std::vector<LineEdit>& edits) {
  const LineIndex index(source);
  std::string text;
  auto edit = edits.begin();
  for (std::size_t line = 1; line <= index.line_count(); ++line) {
    const std::size_t end = line < index.line_count() ? index.start_of(line + 1) : source.size();
    if (edit != edits.end() && edit->line == line) {
      text += edit++->text;
    } else {
      text += source.substr(index.start_of(line), end - index.start_of(line));
    }
  }
  return text;
}

TEST(Formatter, WritesLabelsAndInstructionsOnLinesOfTheirOwn) {
  EXPECT_EQ(format_source("Start:  A : sap 4,0 ,1000\n\tJa start"),
            "Start:\n"
            "A:\n"
            "    SAP 4, 0, 1000\n"
            "    JA start\n");
}

TEST(Formatter, WritesWordsAndFunctionsInUpperCaseAndLeavesNamesAndNumbers) {
  EXPECT_EQ(format_source("mvp abs,Motor0,$fF\njc ge,ge\ncalc load,abs+Sin( 1.50 )\n"),
            "    MVP ABS, Motor0, $fF\n"
            "    JC GE, ge\n"
            "    CALC LOAD, abs + SIN(1.50)\n");
}

TEST(Formatter, PutsBlanksAroundOperatorsBetweenValues) {
  EXPECT_EQ(format_source("X=-(a+-b)*2^-3/4--5"), "X = -(a + -b) * 2^-3 / 4 - -5\n");
}

TEST(Formatter, NeverJoinsWordsThatNoOperatorJoins) {
  EXPECT_EQ(format_source("X = 1 2  a $1 %1 b(3)(4)c  5\n"), "X = 1 2 a $1 %1 b (3) (4) c 5\n");
}

TEST(Formatter, AlignsTheConstantsOfABlock) {
  EXPECT_EQ(format_source("Speed=1\n; here\nX = 2 //x\n\nFar = 3\n    STOP\nNear=4"),
            "Speed = 1\n"
            "; here\n"
            "X     = 2                   //x\n"
            "\n"
            "Far = 3\n"
            "    STOP\n"
            "Near = 4\n");
}

TEST(Formatter, AlignsTheCommentsOfABlock) {
  EXPECT_EQ(format_source("STOP//a\n SIO 0,2,1 + (2 + 3 + 4 + 5 + 6) ; b\n\nSTOP // c\nL: // d\n"),
            "    STOP                               //a\n"
            "    SIO 0, 2, 1 + (2 + 3 + 4 + 5 + 6)  ; b\n"
            "\n"
            "    STOP                    // c\n"
            "L:                          // d\n");
}

TEST(Formatter, LeavesCommentsAtTheMarginThereAndPutsOthersBelowCode) {
  EXPECT_EQ(format_source("//  margin \n\t// with the code\n  STOP  // behind\n        // it goes on\n  // no more\n"),
            "//  margin\n"
            "    // with the code\n"
            "    STOP                    // behind\n"
            "                            // it goes on\n"
            "    // no more\n");
}

TEST(Formatter, AlignsNothingToLongLines) {
  const std::string number(100, '1');
  EXPECT_EQ(
      format_source("A=1// a\nB=" + number + " // b\n             // c\n" + number + "=2\nL" + number + "=3\n"),
      "A = 1                       // a\nB = " + number + "  // b\n    // c\n" + number + "=2\nL" + number + " = 3\n");
  // A block of a megabyte is not made one of a terabyte.
  std::string source = "L" + std::string(1000000, '1') + " = 1 // a\n";
  for (int i = 0; i < 1000; ++i) source += "A" + std::to_string(i) + " = 1 // a\n";
  EXPECT_LT(format_source(source).size(), 2000000U);
}

TEST(Formatter, KeepsOneBlankLineOfSeveralAndNoneAtTheEnds) {
  EXPECT_EQ(format_source("\n\n STOP\n\t\n\n \nSTOP\n\n"), "    STOP\n\n    STOP\n");
  EXPECT_EQ(format_source("\n \n"), "");
  EXPECT_EQ(format_source(""), "");
}

TEST(Formatter, WritesIncludesAtTheMargin) {
  EXPECT_EQ(format_source("  # INCLUDE   a b.tmc   // c\n#include\"x\""),
            "#include a b.tmc            // c\n"
            "#include \"x\"\n");
}

TEST(Formatter, LeavesWhatIsNoneOfTheLanguage) {
  const std::string_view lines[] = {" Sap  4,0,",   "  SAPP  4,0, 1 ", "A:5",         " #define  X 1 ", "#include",
                                    " ROR 0 , 5? ", "  A = ",          "X = 1 = 2  ", "L:  #include a", "  MVP ABS,,1"};
  for (const std::string_view line : lines) {
    const Formatting formatting = formatting_of(std::string("ror 0,1\n") + std::string(line) + "\nstop");
    EXPECT_EQ(formatting.text, "    ROR 0, 1\n" + std::string(line) + "\n    STOP\n");
    EXPECT_EQ(formatting.untouched_lines, std::vector<std::size_t>{2});
  }
}

TEST(Formatter, KeepsCrLfOnlyWhereAllLinesHaveIt) {
  EXPECT_EQ(format_source("stop\r\nstop\r\n"), "    STOP\r\n    STOP\r\n");
  EXPECT_EQ(format_source("stop\r\nstop"), "    STOP\r\n    STOP\r\n");
  EXPECT_EQ(format_source("stop\r\nstop\n"), "    STOP\n    STOP\n");
  EXPECT_EQ(format_source("stop\rstop\r"), "    STOP\n    STOP\n");
}

TEST(Formatter, WritesUtf8AndKeepsAByteOrderMark) {
  EXPECT_EQ(format_source("// 5 \xB0\n"), "// 5 °\n");
  EXPECT_EQ(format_source("\xEF\xBB\xBFstop // \xB0\n"), "\xEF\xBB\xBF    STOP                    // °\n");
  EXPECT_EQ(format_source("\xEF\xBB\xBF"), "\xEF\xBB\xBF");
  // The second mark is an error, and stays one.
  EXPECT_EQ(format_source("\n\xEF\xBB\xBFstop\n"), "\n\xEF\xBB\xBFstop\n");
}

TEST(Formatter, NamesTheLinesItChanges) {
  const std::string_view source = "// first\nstop\n\n\nL: stop\n    STOP\n";
  const Formatting formatting = formatting_of(source);
  ASSERT_EQ(formatting.edits.size(), 3U);
  EXPECT_EQ(formatting.edits[0].line, 2U);
  EXPECT_EQ(formatting.edits[0].text, "    STOP\n");
  EXPECT_EQ(formatting.edits[1].text, "");
  EXPECT_EQ(formatting.edits[2].text, "L:\n    STOP\n");
}

/// All tokens of a text in upper case, without the blanks inside directives.
std::vector<std::string> tokens_of(std::string_view source) {
  const std::size_t mark = source.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;
  const std::string text = std::string(source.substr(0, mark)) + to_utf8(source.substr(mark));
  std::vector<std::string> words;
  Lexer lexer(text);
  Tokens tokens;
  while (!lexer.at_end()) {
    lexer.read_line(tokens);
    for (const Token& token : tokens) {
      std::string word(token.text(text));
      std::transform(word.begin(), word.end(), word.begin(), to_upper);
      const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\v'; };
      word.erase(std::remove_if(word.begin(), word.end(), is_blank), word.end());
      if (!word.empty()) words.push_back(word);
    }
  }
  return words;
}

void expect_sound(std::string_view source, const ModuleDescription& module) {
  const Formatting formatting = formatting_of(source);
  RC_LOG() << "source:\n" << source << "\nformatted:\n" << formatting.text;
  RC_ASSERT(format_source(formatting.text) == formatting.text);
  RC_ASSERT(tokens_of(formatting.text) == tokens_of(source));
  RC_ASSERT(program_of(formatting.text, module) == program_of(source, module));
  RC_ASSERT(applied(source, formatting.edits) == formatting.text);
}

RC_GTEST_PROP(Formatter, IsIdempotentAndNeverChangesTheProgram, (std::uint64_t seed, std::uint8_t size)) {
  Dice dice(seed);
  const ModuleDescription& module = dice.one_of(modules);
  const std::vector<Command> commands = generated_program(dice, module, size % 32U);
  const std::string source = generated_source(dice, module, commands);
  RC_ASSERT(program_of(source, module) == commands);
  RC_ASSERT(formatting_of(source).untouched_lines.empty());
  expect_sound(source, module);
}

/// Pieces of sources in any order, most of them no sources.
std::string scrambled_source(Dice& dice, std::size_t size) {
  constexpr std::string_view pieces[] = {
      "SAP", "gap",  "JA", "MVP ", "rel", "Sin",          "(",   ")",    "+",        "-",  "/",    "*",     "^", ",",
      ":",   "=",    "A",  "b_1",  "0",   "1.5",          "$1F", "%101", "#include", "# ", "//",   ";",     " ", "\t",
      "\n",  "\r\n", "\r", "\xB0", "°",   "\xEF\xBB\xBF", "\v",  "e5",   ".5",       "?",  "\n\n", "STOP\n"};
  std::string source;
  for (; size > 0; --size) source += dice.one_of(pieces);
  return source;
}

RC_GTEST_PROP(Formatter, IsIdempotentAndNeverChangesTheProgramOfAnyText, (std::uint64_t seed, std::uint8_t size)) {
  Dice dice(seed);
  for (int sources = 0; sources < 50; ++sources) expect_sound(scrambled_source(dice, size), pd1161);
}

RC_GTEST_PROP(Formatter, TakesAnyBytes, (const std::string& source)) {
  expect_sound(source, tmcm1110);
}

}  // namespace
}  // namespace opentmcl::lang
