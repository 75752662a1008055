#include "lang/disassembler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lang/assembling_test.hpp"
#include "lang/formatter.hpp"
#include "lang/generated_program_test.hpp"
#include "lang/module_comment.hpp"

namespace opentmcl::lang {
namespace {

using testing::HasSubstr;

/// What the assembler makes of a text; it may warn.
std::vector<Command> reassembled(const std::string& text, const ModuleDescription& module) {
  const AssemblyResult result = assemble_text(text, module);
  if (!result.program) RC_FAIL(format(result.diagnostics, result.sources));
  return result.program->commands;
}

RC_GTEST_PROP(Disassembler, IsTheInverseOfTheAssemblerForEveryInstruction, (std::uint64_t seed)) {
  Dice dice(seed);
  for (const ModuleDescription& module : modules) {
    for (const InstructionSpec* row : instructions_of(module)) {
      const Command original = generated_command(dice, *row, 65536);
      const DisassembledInstruction instruction = disassemble_instruction(original, module);
      RC_ASSERT(instruction.text.has_value());
      RC_ASSERT(parse_instruction(*instruction.text, module).command == original);
    }
  }
}

RC_GTEST_PROP(Disassembler, IsTheInverseOfTheAssemblerForWholeProgramsWithLabels, (std::uint64_t seed)) {
  Dice dice(seed);
  const ModuleDescription& module = dice.one_of(modules);
  const std::vector<Command> commands = generated_program(dice, module, dice.below(300));
  for (const Comments comments : {Comments::none, Comments::meanings}) {
    const Disassembly disassembly = disassemble(commands, module, comments);
    RC_ASSERT(disassembly.problems.empty());
    RC_ASSERT(format_source(disassembly.text) == disassembly.text);
    RC_ASSERT(reassembled(disassembly.text, module) == commands);
    RC_ASSERT(module_named_in(disassembly.text)->module == &module);
  }
}

RC_GTEST_PROP(Disassembler, EitherGivesTextThatAssemblesToTheSameOrSaysWhyNot,
              (std::uint8_t opcode, std::uint8_t type, std::uint8_t motor, std::int32_t value)) {
  for (const ModuleDescription& module : modules) {
    const Command original{opcode, type, motor, value};
    const DisassembledInstruction instruction = disassemble_instruction(original, module);
    RC_ASSERT(instruction.text.has_value() == instruction.reason.empty());
    if (instruction.text) RC_ASSERT(parse_instruction(*instruction.text, module).command == original);
  }
}

TEST(Disassembler, WritesLabelsAndWords) {
  const Disassembly disassembly = disassemble({command(Opcode::mvp, 2, 0, 8), command(Opcode::jc, 5, 0, 0),
                                               command(Opcode::ja, 0, 0, 3), command(Opcode::vect, 0, 0, 500)},
                                              pd1161);
  EXPECT_EQ(disassembly.text,
            "// 4 instructions for the PD-1161 (firmware V1.47)\n"
            "// module: pd1161\n"
            "L_0:\n"
            "    MVP COORD, 0, 8\n"
            "    JC GE, L_0\n"
            "    JA L_3\n"
            "L_3:\n"
            "    VECT 0, 500             // timer 0\n");
}

TEST(Disassembler, SaysWhatInstructionsAreAbout) {
  EXPECT_EQ(disassemble(commands_of("SAP 4, 0, 1000\nSAP 154, 0, 4\nSAP 4, 0, 1000\nROR 0, -1000\nMVP REL, 0, 25600\n"
                                    "SAP 6, 0, 255\nWAIT TICKS, 0, 50\nSIO 1, 2, 1\nSGP 0, 3, 500\nGAP 12, 0\nSTOP\n"),
                        pd1161)
                .text,
            "// 11 instructions for the PD-1161 (firmware V1.47)\n"
            "// module: pd1161\n"
            "    SAP 4, 0, 1000          // maximum positioning speed = 35.8 rpm\n"
            "    SAP 154, 0, 4           // pulse divisor = 16\n"
            "    SAP 4, 0, 1000          // maximum positioning speed = 17.9 rpm\n"
            "    ROR 0, -1000            // -17.9 rpm\n"
            "    MVP REL, 0, 25600       // 0.5 turns\n"
            "    SAP 6, 0, 255           // maximum current = 2800 mA\n"
            "    WAIT TICKS, 0, 50       // 500 ms\n"
            "    SIO 1, 2, 1             // digital output 1\n"
            "    SGP 0, 3, 500           // timer 0 = 500 ms\n"
            "    GAP 12, 0               // right limit switch disable\n"
            "    STOP\n");
}

TEST(Disassembler, LeavesCommentsOutOnDemand) {
  EXPECT_EQ(disassemble(commands_of("SAP 4, 0, 1000\n"), tmcm1110, Comments::none).text,
            "// 1 instructions for the TMCM-1110 (firmware V1.08)\n"
            "// module: tmcm1110\n"
            "    SAP 4, 0, 1000\n");
}

TEST(Disassembler, SaysWhatCannotBeWritten) {
  const Disassembly disassembly = disassemble({command(Opcode::calcvv, 0, 1, 2),
                                               command(Opcode::mst, 1, 0, 0),
                                               command(Opcode::mvp, 3, 0, 0),
                                               {0, 0, 0, 0},
                                               command(Opcode::software_reset, 0, 0, 1234),
                                               command(Opcode::stop)},
                                              tmcm1110);
  ASSERT_EQ(disassembly.problems.size(), 5U);
  EXPECT_EQ(disassembly.problems[0].reason, "the TMCM-1110 (firmware V1.08) has no mnemonic for opcode 40");
  EXPECT_EQ(disassembly.problems[1].reason, "a field that MST does not use is not 0");
  EXPECT_EQ(disassembly.problems[2].reason, "3 is no operand 1 of MVP");
  EXPECT_EQ(disassembly.problems[3].address, 3U);
  EXPECT_EQ(disassembly.problems[4].reason, "the TMCM-1110 (firmware V1.08) has no mnemonic for opcode 255");
  EXPECT_THAT(disassembly.text, HasSubstr("    // 03 01 00 00 00 00 00: a field that MST does not use is not 0\n"));
}

}  // namespace
}  // namespace opentmcl::lang
