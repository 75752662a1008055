// That compilers take the header: tests/end_to_end/assembler_test.py.
#include "lang/c_array.hpp"

#include <gtest/gtest.h>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

std::string array_of(const std::string& text, std::string_view name, bool append_stop = true) {
  const AssemblyResult result = assemble_text(text, pd1161, append_stop);
  return c_array(*result.program, result.sources, pd1161, name);
}

TEST(CArray, HasTheBytesOfEachInstructionAndItsSource) {
  EXPECT_EQ(array_of("Loop: MVP REL, 0, -10000 // back\n", "my_program"),
            "/* test.tmc, assembled for the PD-1161 (firmware V1.47) */\n"
            "#ifndef MY_PROGRAM_H\n"
            "#define MY_PROGRAM_H\n"
            "\n"
            "#include <stdint.h>\n"
            "\n"
            "/* Instructions of the program. */\n"
            "#define MY_PROGRAM_LENGTH 2\n"
            "\n"
            "/* Of each instruction opcode, type, motor and the four bytes of the value, most significant first. */\n"
            "static const uint8_t my_program[MY_PROGRAM_LENGTH][7] = {\n"
            "    {0x04, 0x01, 0x00, 0xFF, 0xFF, 0xD8, 0xF0}, /* 0: MVP REL, 0, -10000 */\n"
            "    {0x1C, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}, /* 1: STOP */\n"
            "};\n"
            "\n"
            "#endif\n");
}

TEST(CArray, HasNamesThatCTakes) {
  EXPECT_NE(array_of("STOP", "2nd pump-\xC3\xA4").find(" tmcl_2nd_pump___["), std::string::npos);
  EXPECT_NE(array_of("STOP", "_x").find(" tmcl__x["), std::string::npos);
}

TEST(CArray, IsNoneWithoutInstructions) {
  EXPECT_EQ(array_of("", "empty", false).find("uint8_t"), std::string::npos);
}

}  // namespace
}  // namespace opentmcl::lang
