#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "lang/assembler.hpp"
#include "lang/disassembler.hpp"
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

}  // namespace
}  // namespace opentmcl::tests
