#include "lang/program_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <tuple>
#include <vector>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;

TEST(ProgramFile, HasEightBytesAnInstruction) {
  EXPECT_THAT(to_program_file({command(Opcode::mvp, 1, 0, -1000), command(Opcode::reti)}),
              ElementsAre(0x04, 0x01, 0x00, 0xFF, 0xFF, 0xFC, 0x18, 0x17,  //
                          0x26, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x26));
}

TEST(ProgramFile, RefusesABrokenLength) {
  const ProgramFileResult result = from_program_file(std::vector<std::uint8_t>(15));
  EXPECT_FALSE(result.commands.has_value());
  EXPECT_EQ(result.error, "a program file is a multiple of 8 bytes long, this one is 15");
}

TEST(ProgramFile, RefusesABrokenChecksum) {
  std::vector<std::uint8_t> bytes = to_program_file({command(Opcode::stop), command(Opcode::mst)});
  bytes[15] = 0x80;
  const ProgramFileResult result = from_program_file(bytes);
  EXPECT_FALSE(result.commands.has_value());
  EXPECT_EQ(result.error, "the checksum of instruction 1 is 80, expected 03");
}

RC_GTEST_PROP(ProgramFile, IsReadAsItWasWritten,
              (const std::vector<std::tuple<std::uint8_t, std::uint8_t, std::uint8_t, std::int32_t>>& rows)) {
  std::vector<Command> commands;
  commands.reserve(rows.size());
  for (const auto& [opcode, type, motor, value] : rows) commands.push_back({opcode, type, motor, value});
  const ProgramFileResult result = from_program_file(to_program_file(commands));
  RC_ASSERT(result.commands.has_value());
  RC_ASSERT(*result.commands == commands);
}

}  // namespace
}  // namespace opentmcl::lang
