#include "lang/disassembler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lang/assembling_test.hpp"
#include "lang/instruction_table.hpp"

namespace opentmcl::lang {
namespace {

using testing::HasSubstr;

/// Any value the assembler takes for the operand.
std::int32_t any_operand(const OperandSpec& operand) {
  if (takes_words(operand.kind)) {
    const KeywordSet set = keywords_of(operand.kind);
    const auto index = *rc::gen::inRange<std::size_t>(0, set.count);
    return set.words[index].value == set.excluded ? 0 : set.words[index].value;
  }
  if (operand.field == Field::value) return *rc::gen::arbitrary<std::int32_t>();
  return *rc::gen::inRange<std::int32_t>(0, 256);
}

Command any_command(const InstructionSpec& row) {
  Command result = command(row.opcode);
  for (const OperandSpec& operand : row.operands) {
    switch (operand.field) {
      case Field::type:
        result.type = static_cast<std::uint8_t>(any_operand(operand));
        break;
      case Field::motor:
        result.motor = static_cast<std::uint8_t>(any_operand(operand));
        break;
      case Field::value:
        result.value = any_operand(operand);
        break;
      case Field::none:
        break;
    }
  }
  return result;
}

/// Makes jumps go to places in the program, or just behind it.
void aim_jumps(std::vector<Command>& commands, const ModuleDescription& module) {
  const auto end = static_cast<std::int32_t>(commands.size()) + 1;
  for (Command& each : commands) {
    for (const OperandSpec& operand : find_instruction(each.opcode, module.id)->operands) {
      if (operand.kind == OperandKind::address) each.value = *rc::gen::inRange<std::int32_t>(-1, end);
    }
  }
}

std::vector<const InstructionSpec*> instructions_of(const ModuleDescription& module) {
  std::vector<const InstructionSpec*> rows;
  for (const InstructionSpec& row : instructions) {
    if (row.mnemonic != nullptr && contains(row.modules, module.id)) rows.push_back(&row);
  }
  return rows;
}

/// What the assembler makes of a text; it may warn.
std::vector<Command> reassembled(const std::string& text, const ModuleDescription& module) {
  const AssemblyResult result = assemble_text(text, module);
  if (!result.program) RC_FAIL(format(result.diagnostics, result.sources));
  return result.program->commands;
}

RC_GTEST_PROP(Disassembler, IsTheInverseOfTheAssemblerForEveryInstruction, ()) {
  for (const ModuleDescription& module : modules) {
    for (const InstructionSpec* row : instructions_of(module)) {
      const Command original = any_command(*row);
      const DisassembledInstruction instruction = disassemble_instruction(original, module);
      RC_ASSERT(instruction.text.has_value());
      RC_ASSERT(parse_instruction(*instruction.text, module).command == original);
    }
  }
}

RC_GTEST_PROP(Disassembler, IsTheInverseOfTheAssemblerForWholeProgramsWithLabels, ()) {
  const ModuleDescription& module = modules[*rc::gen::inRange<std::size_t>(0, module_count)];
  const auto rows =
      *rc::gen::container<std::vector<const InstructionSpec*>>(rc::gen::elementOf(instructions_of(module)));
  std::vector<Command> commands;
  commands.reserve(rows.size());
  for (const InstructionSpec* row : rows) commands.push_back(any_command(*row));
  aim_jumps(commands, module);
  const Disassembly disassembly = disassemble(commands, module);
  RC_ASSERT(disassembly.problems.empty());
  RC_ASSERT(reassembled(disassembly.text, module) == commands);
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
            "L_0:\n"
            "    MVP COORD, 0, 8\n"
            "    JC GE, L_0\n"
            "    JA L_3\n"
            "L_3:\n"
            "    VECT 0, 500\n");
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
