#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const Datagram& datagram) {
  return {datagram.bytes, datagram.bytes + datagram_size};
}

Bytes request(Opcode opcode, std::uint8_t address = 1) {
  return bytes_of(encode(Request{address, {static_cast<std::uint8_t>(opcode), 1, 0, 0}}));
}

TEST(Usb, IgnoresTheAddressAndAnswersWithItsOwn) {
  Bench bench(pd1161);
  for (const int address : {0, 1, 2, 77, 255}) {
    const Bytes reply = bench.send(request(Opcode::gap, static_cast<std::uint8_t>(address)));
    ASSERT_EQ(reply.size(), datagram_size);
    EXPECT_EQ(reply[0], 2);
    EXPECT_EQ(reply[1], 1);
    EXPECT_EQ(reply[2], 100);
  }
}

TEST(Rs485, IsSilentForEveryOtherAddress) {
  Bench bench(tmcm1110, hal::PortKind::rs485);
  for (int address = 0; address < 256; ++address) {
    const Bytes reply = bench.send(request(Opcode::gap, static_cast<std::uint8_t>(address)));
    EXPECT_EQ(reply.size(), address == 1 ? datagram_size : 0U) << address;
  }
}

TEST(Rs485, IsSilentForAWrongChecksumToAnotherAddress) {
  Bench bench(tmcm1110, hal::PortKind::rs485);
  Bytes wrong = request(Opcode::gap, 3);
  ++wrong[8];
  EXPECT_TRUE(bench.send(wrong).empty());
}

TEST(Rs485, CarriesOutWhatTheSecondaryAddressSaysAndDoesNotAnswer) {
  Bench bench(pd1161, hal::PortKind::rs485);
  bench.set(GlobalParameter::serial_secondary_address, 9);
  const Bytes reply = bench.send(bytes_of(encode(Request{9, {static_cast<std::uint8_t>(Opcode::ror), 0, 0, 500}})));
  EXPECT_TRUE(reply.empty());
  EXPECT_EQ(bench.get(AxisParameter::target_speed), 500);
}

TEST(Framing, AnswersAWrongChecksumWithStatus1AndCommand0) {
  for (const hal::PortKind kind : {hal::PortKind::usb, hal::PortKind::rs485}) {
    Bench bench(pd1161, kind);
    Bytes wrong = request(Opcode::gap);
    wrong[8] ^= 0x40;
    EXPECT_EQ(bench.send(wrong), (Bytes{2, 1, 1, 0, 0, 0, 0, 0, 4}));
    EXPECT_EQ(bench.send(request(Opcode::gap)).size(), datagram_size) << "the next one is answered as usual";
  }
}

TEST(Framing, RecoversFromHalfADatagramAfterFiveMillisecondsOfSilence) {
  Bench bench(pd1161);
  for (std::size_t length = 1; length < datagram_size; ++length) {
    Bytes half = request(Opcode::gap);
    half.resize(length);
    EXPECT_TRUE(bench.send(half).empty());
    bench.wait(5 * one_millisecond);
    const Bytes reply = bench.send(request(Opcode::gap));
    ASSERT_EQ(reply.size(), datagram_size);
    EXPECT_EQ(reply[2], 100);
  }
}

TEST(Framing, WaitsForBytesThatComeOneByOneWithinTheGap) {
  Bench bench(pd1161);
  Bytes reply;
  for (const std::uint8_t byte : request(Opcode::gap)) {
    EXPECT_TRUE(reply.empty());
    reply = bench.send({byte});  // 3 ms each
  }
  EXPECT_EQ(reply.size(), datagram_size);
}

TEST(Framing, AnswersDatagramsThatComeTogetherInTheirOrder) {
  Bench bench(pd1161);
  Bytes together;
  for (int i = 0; i < 5; ++i) {
    const Bytes one = bytes_of(encode(Request{1, {static_cast<std::uint8_t>(Opcode::sgp), 7, 2, i}}));
    together.insert(together.end(), one.begin(), one.end());
  }
  const Bytes replies = bench.send(together);
  ASSERT_EQ(replies.size(), 5 * datagram_size);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(replies[i * datagram_size + 7], i);
}

TEST(Framing, AnswersNineZeroBytesAsAnInvalidCommand) {
  Bench bench(tmcm1110);
  EXPECT_EQ(bench.send(Bytes(9, 0)), (Bytes{2, 1, 2, 0, 0, 0, 0, 0, 5}));
}

TEST(AnyNineBytes, GetAtMostOneReplyAndLeaveTheModuleAlive) {
  rc::check("any nine bytes", [] {
    const auto module_id = *rc::gen::element(ModuleId::tmcm1110, ModuleId::pd1161);
    Bench bench(modules[static_cast<std::size_t>(module_id)]);
    const auto count = *rc::gen::inRange(1, 20);
    for (int i = 0; i < count; ++i) {
      Bytes bytes = *rc::gen::container<Bytes>(9, rc::gen::arbitrary<std::uint8_t>());
      if (*rc::gen::inRange(0, 4) != 0) {  // mostly a right checksum, and an opcode that exists
        bytes[1] = static_cast<std::uint8_t>(
            (*rc::gen::elementOf(std::vector<InstructionSpec>(std::begin(instructions), std::end(instructions))))
                .opcode);
        Datagram datagram;
        std::copy(bytes.begin(), bytes.end(), datagram.bytes);
        datagram.seal();
        bytes[8] = datagram.bytes[8];
      }
      const Bytes reply = bench.send(bytes);
      RC_ASSERT(reply.empty() || reply.size() == datagram_size);
      bench.wait(6 * one_millisecond);
    }
    // Reads are answered whatever was switched off, unless the module restarts just now.
    Bytes last;
    for (int i = 0; i < 100 && last.empty(); ++i) {
      last = bench.send(bytes_of(encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}})));
      bench.wait(6 * one_millisecond);
    }
    RC_ASSERT(last.size() % datagram_size == 0U);
  });
}

TEST(SuppressReply, LeavesOnlyGapGgpAndGioAnswered) {
  Bench bench(pd1161);
  bench.send(bytes_of(encode(Request{1, {static_cast<std::uint8_t>(Opcode::sgp), 255, 0, 1}})));
  for (const InstructionSpec& row : instructions) {
    if (row.opcode == Opcode::software_reset || row.opcode == Opcode::restore_factory_settings) continue;
    if (row.opcode == Opcode::enter_download_mode) continue;
    const bool answered = row.opcode == Opcode::gap || row.opcode == Opcode::ggp || row.opcode == Opcode::gio;
    const auto reply = bench.send(bytes_of(encode(Request{1, {static_cast<std::uint8_t>(row.opcode), 0, 0, 0}})));
    EXPECT_EQ(reply.size(), answered ? datagram_size : 0U) << static_cast<int>(row.opcode);
  }
}

}  // namespace
}  // namespace opentmcl::tests
