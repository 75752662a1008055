// Every complete datagram of the manuals, sent to the modules that have it.
#include "tests/manual_datagrams/manual_datagrams.hpp"

#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

class ManualDatagrams : public testing::TestWithParam<ModuleId> {};

TEST_P(ManualDatagrams, AreAnsweredAsTheManualSays) {
  const ModuleDescription& description = modules[static_cast<std::size_t>(GetParam())];
  for (const ManualDatagram& row : manual_datagrams) {
    SCOPED_TRACE(std::string(row.section) + ' ' + (row.mnemonic != nullptr ? row.mnemonic : "control command"));
    Bench bench(description);  // a new one each time: some of them change addresses or the state of the module
    if (row.reply && static_cast<Opcode>(row.request.bytes[1]) == Opcode::gio) {
      bench.module.world().set_analog_input(0, get_int32(row.reply->bytes + 4));
    }
    const std::optional<Datagram> reply = bench.exchange(row.request);
    ASSERT_TRUE(reply.has_value());
    if (find_instruction(row.request.bytes[1], GetParam()) == nullptr) {
      EXPECT_EQ(decode_reply(*reply).status, Status::invalid_command);
      continue;
    }
    EXPECT_TRUE(reply->checksum_is_right());
    EXPECT_EQ(decode_reply(*reply).status, row.status);
    if (row.reply) {
      EXPECT_EQ(*reply, *row.reply);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Both, ManualDatagrams, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST(FirmwareVersion, IsAStringOfEightCharactersBehindTheHostAddress) {
  // The literal bytes of the sources: 02 "1110V108" and 02 "1161V147".
  constexpr Datagram request{{1, 136, 0, 0, 0, 0, 0, 0, 137}};
  EXPECT_EQ(Bench(tmcm1110).exchange(request), (Datagram{{2, '1', '1', '1', '0', 'V', '1', '0', '8'}}));
  EXPECT_EQ(Bench(pd1161).exchange(request), (Datagram{{2, '1', '1', '6', '1', 'V', '1', '4', '7'}}));
}

TEST(FirmwareVersion, HasABinaryForm) {
  EXPECT_EQ(Bench(tmcm1110).command(Opcode::get_firmware_version, 1).value, 0x04560108);
  EXPECT_EQ(Bench(pd1161).command(Opcode::get_firmware_version, 1).value, 0x0489012F);
}

}  // namespace
}  // namespace opentmcl::tests
