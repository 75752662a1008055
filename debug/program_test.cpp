#include "debug/program.hpp"

#include <gtest/gtest.h>

#include "debug/debugging_test.hpp"

namespace opentmcl::debug {
namespace {

Program with_include() {
  lang::MemoryFiles files;
  files.set("parts/sub.inc", "\nSub: CALC ADD, 1\nRSUB\n");
  lang::AssemblyResult result =
      lang::assemble("main.tmc", "Begin:\n\nCSUB Sub\n// a comment\nJA Begin\n#include parts/sub.inc\n",
                     lang::AssemblerOptions{}, files);
  return {std::move(result), pd1161};
}

TEST(Program, KnowsTheLineOfEachInstruction) {
  const Program program = with_include();
  EXPECT_EQ(3U, program.line_of(0)->line);
  EXPECT_EQ(5U, program.line_of(1)->line);
  EXPECT_EQ(2U, program.line_of(2)->line);
  EXPECT_EQ("parts/sub.inc", program.file_name(program.line_of(2)->file));
  EXPECT_FALSE(program.line_of(4));  // the STOP that was appended
  EXPECT_FALSE(program.line_of(100));
}

TEST(Program, ALineWithoutAnInstructionMeansTheNextOneInItsFile) {
  const Program program = with_include();
  EXPECT_EQ(0, program.address_of(0, 1));
  EXPECT_EQ(0, program.address_of(0, 3));
  EXPECT_EQ(1, program.address_of(0, 4));
  EXPECT_FALSE(program.address_of(0, 6));
  EXPECT_FALSE(program.address_of(0, 0));
  EXPECT_FALSE(program.address_of(0, 100));
  EXPECT_FALSE(program.address_of(99, 1));
  EXPECT_EQ(2, program.address_of(*program.find_file("sub.inc"), 1));
}

TEST(Program, NamesAddressesByTheirLabels) {
  const Program program = with_include();
  EXPECT_EQ("Begin", program.name_of(0));
  EXPECT_EQ("Begin+1", program.name_of(1));
  EXPECT_EQ("Sub", program.name_of(2));
  EXPECT_EQ("Sub+1", program.name_of(3));
  EXPECT_EQ(2, program.address_of_label("SUB"));
  EXPECT_FALSE(program.address_of_label("Nowhere"));
}

TEST(Program, FindsFilesByTheEndOfTheirNames) {
  const Program program = with_include();
  EXPECT_TRUE(program.find_file("main.tmc"));
  EXPECT_TRUE(program.find_file("parts/sub.inc"));
  EXPECT_TRUE(program.find_file("sub.inc"));
  EXPECT_FALSE(program.find_file("ub.inc"));
  EXPECT_FALSE(program.find_file("other.inc"));
}

TEST(Program, WithoutASourceItIsItsDisassembly) {
  const std::vector<Command> commands = program_of("Loop: CALC ADD, 1\nJA Loop\n").commands();
  const Program program = Program::disassembled(commands, pd1161, "memory");
  EXPECT_EQ(commands, program.commands());
  EXPECT_TRUE(program.line_of(1));
  // Even what no source can say can be debugged.
  const Program odd = Program::disassembled({{200, 1, 2, 3}, {28, 0, 0, 0}}, pd1161, "memory");
  EXPECT_EQ(2U, odd.size());
  EXPECT_FALSE(odd.line_of(0));
  EXPECT_EQ("opcode 200, type 1, motor 2, value 3", odd.text_of(odd.commands()[0]));
}

}  // namespace
}  // namespace opentmcl::debug
