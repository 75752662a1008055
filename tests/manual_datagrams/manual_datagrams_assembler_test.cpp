#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "lang/assembler.hpp"
#include "lang/disassembler.hpp"
#include "tests/manual_datagrams/instruction_forms.hpp"
#include "tests/manual_datagrams/manual_datagrams.hpp"

namespace opentmcl::tests {
namespace {

constexpr std::uint8_t module_address = 1;

std::vector<std::uint8_t> bytes_of(const Datagram& datagram) {
  return {datagram.bytes, datagram.bytes + datagram_size};
}

TEST(ManualDatagrams, AreWhatTheAssemblerMakesOfTheirMnemonics) {
  for (const ManualDatagram& row : manual_datagrams) {
    if (row.mnemonic == nullptr) continue;
    for (const ModuleDescription& module : modules) {
      if (!contains(row.modules, module.id)) continue;
      const lang::InstructionResult result = lang::parse_instruction(row.mnemonic, module);
      EXPECT_EQ(lang::format(result.diagnostics, result.sources), "") << row.section;
      ASSERT_TRUE(result.command.has_value()) << row.section;
      EXPECT_EQ(bytes_of(encode(Request{module_address, *result.command})), bytes_of(row.request))
          << row.section << ' ' << row.mnemonic;
    }
  }
}

TEST(ManualDatagrams, AreRefusedForModulesThatLackTheInstruction) {
  for (const ManualDatagram& row : manual_datagrams) {
    if (row.mnemonic == nullptr || row.modules != Modules::pd1161) continue;
    const lang::InstructionResult result = lang::parse_instruction(row.mnemonic, tmcm1110);
    EXPECT_FALSE(result.command.has_value()) << row.mnemonic;
    EXPECT_EQ(result.diagnostics.at(0).kind, lang::DiagnosticKind::instruction_not_available) << row.mnemonic;
  }
}

TEST(ManualDatagrams, DisassembleToTheirMnemonics) {
  for (const ManualDatagram& row : manual_datagrams) {
    if (row.mnemonic == nullptr) continue;
    const Command command = decode_request(row.request).command;
    EXPECT_EQ(lang::disassemble_instruction(command, pd1161).text, row.mnemonic) << row.section;
  }
}

Command command_of(const InstructionForm& form) {
  return {form.bytes[0], form.bytes[1], form.bytes[2], get_int32(form.bytes + 3)};
}

TEST(InstructionForms, AreWhatTheAssemblerMakesOfTheirMnemonics) {
  for (const InstructionForm& form : instruction_forms) {
    for (const ModuleDescription& module : modules) {
      const lang::InstructionResult result = lang::parse_instruction(form.mnemonic, module);
      if (result.command) {
        EXPECT_EQ(*result.command, command_of(form)) << form.mnemonic;
      }
      EXPECT_EQ(result.command.has_value(), contains(form.modules, module.id)) << form.mnemonic << ' ' << module.name;
    }
  }
}

TEST(InstructionForms, HaveEveryWordOfEveryInstruction) {
  std::set<std::pair<int, int>> shown;  // opcode and type: no word is written elsewhere
  for (const InstructionForm& form : instruction_forms) shown.insert({form.bytes[0], form.bytes[1]});
  for (const ManualDatagram& row : manual_datagrams) {
    const Command command = decode_request(row.request).command;
    shown.insert({command.opcode, command.type});
  }
  for (const InstructionSpec& instruction : instructions) {
    if (instruction.mnemonic == nullptr) continue;
    const int opcode = static_cast<int>(instruction.opcode);
    const OperandSpec& first = instruction.operands[0];
    const KeywordSet words = keywords_of(first.kind);
    for (std::size_t i = 0; i < words.count; ++i) {
      ASSERT_EQ(first.field, Field::type);
      if (words.words[i].value == words.excluded) continue;
      EXPECT_EQ(shown.count({opcode, words.words[i].value}), 1U) << instruction.mnemonic << ' ' << words.words[i].word;
    }
    const auto is_shown = [&](const std::pair<int, int>& one) { return one.first == opcode; };
    EXPECT_TRUE(std::any_of(shown.begin(), shown.end(), is_shown)) << instruction.mnemonic;
  }
}

}  // namespace
}  // namespace opentmcl::tests
