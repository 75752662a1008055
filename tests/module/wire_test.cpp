#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "firmware/module/module.hpp"
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

TEST(Rs232, IsAddressedAsABus) {
  Bench bench(pd1161, hal::PortKind::rs232);
  for (int address = 0; address < 256; ++address) {
    const Bytes reply = bench.send(request(Opcode::gap, static_cast<std::uint8_t>(address)));
    EXPECT_EQ(reply.size(), address == 1 ? datagram_size : 0U) << address;
  }
}

TEST(Addresses, AreInForceAtOnceAndInEveryReply) {
  for (const hal::PortKind kind : {hal::PortKind::usb, hal::PortKind::rs232, hal::PortKind::rs485}) {
    Bench bench(tmcm1110, kind);
    bench.set(GlobalParameter::serial_host_address, 77);
    bench.set(GlobalParameter::serial_address, 200);
    const Bytes reply = bench.send(request(Opcode::gap, 200));
    ASSERT_EQ(reply.size(), datagram_size);
    EXPECT_EQ(reply[0], 77);
    EXPECT_EQ(reply[1], 200);
    EXPECT_EQ(bench.send(request(Opcode::gap, 1)).size(), kind == hal::PortKind::usb ? datagram_size : 0U);
    Bytes version = bench.send(bytes_of(encode(Request{200, {136, 0, 0, 0}})));
    EXPECT_EQ(version, (Bytes{77, '1', '1', '1', '0', 'V', '1', '0', '8'}));
  }
}

TEST(SecondaryAddress, IsOffAtZeroAndYieldsToTheOwnAddress) {
  Bench bench(pd1161, hal::PortKind::rs485);
  EXPECT_TRUE(bench.send(request(Opcode::gap, 0)).empty());
  bench.set(GlobalParameter::serial_secondary_address, 1);
  EXPECT_EQ(bench.send(request(Opcode::gap, 1)).size(), datagram_size);
}

TEST(SecondaryAddress, IsSilentWhateverIsWrong) {
  Bench bench(pd1161, hal::PortKind::rs485);
  bench.set(GlobalParameter::serial_secondary_address, 9);
  Bytes broken = request(Opcode::gap, 9);
  ++broken[8];
  EXPECT_TRUE(bench.send(broken).empty());
  EXPECT_TRUE(bench.send(bytes_of(encode(Request{9, {200, 0, 0, 0}}))).empty());
  EXPECT_TRUE(bench.send(bytes_of(encode(Request{9, {136, 0, 0, 0}}))).empty()) << "special replies, too";
}

/// A module with one port of each kind.
struct ThreePorts : testing::Test {
  void put(TestPort& port, const Request& request) {
    const Datagram datagram = encode(request);
    port.to_module.insert(port.to_module.end(), datagram.bytes, datagram.bytes + datagram_size);
    module.wake();
  }
  void wait(Microseconds duration) { module.advance_to(module.now() + duration); }

  TestPort usb;
  TestPort rs232;
  TestPort rs485;
  VirtualModule module{pd1161,
                       {{&usb, hal::PortKind::usb}, {&rs232, hal::PortKind::rs232}, {&rs485, hal::PortKind::rs485}}};
};

TEST_F(ThreePorts, AnswerEachWhoAskedThere) {
  wait(one_millisecond);
  TestPort* const ports[] = {&usb, &rs232, &rs485};
  for (std::uint8_t number = 0; number < 3; ++number) {
    put(*ports[number], {1, {static_cast<std::uint8_t>(Opcode::sgp), number, 2, number + 10}});
  }
  wait(one_millisecond);
  for (std::uint8_t number = 0; number < 3; ++number) {
    ASSERT_EQ(ports[number]->received.size(), datagram_size);
    EXPECT_EQ(ports[number]->received[7], number + 10);
  }
}

TEST_F(ThreePorts, GetTheSecondReplyWhereTheMoveCameFrom) {
  wait(one_millisecond);
  put(usb, {1, {static_cast<std::uint8_t>(Opcode::request_position_reached), 0, 0, 1}});
  wait(one_millisecond);
  put(rs232, {1, {static_cast<std::uint8_t>(Opcode::mvp), 0, 0, 1000}});
  wait(one_millisecond);
  put(rs485, {1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}});
  wait(2000 * one_millisecond);
  EXPECT_EQ(usb.received.size(), datagram_size);
  EXPECT_EQ(rs485.received.size(), datagram_size);
  ASSERT_EQ(rs232.received.size(), 2 * datagram_size);
  EXPECT_EQ(rs232.received[datagram_size + 2], static_cast<std::uint8_t>(Status::position_reached));
}

TEST_F(ThreePorts, DoNotWaitForATelegramPauseElsewhere) {
  wait(one_millisecond);
  put(usb, {1, {static_cast<std::uint8_t>(Opcode::sgp), 75, 0, 200}});
  wait(one_millisecond);
  usb.received.clear();
  put(rs485, {1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}});
  put(usb, {1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}});
  put(rs232, {1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}});
  wait(one_millisecond);
  EXPECT_EQ(usb.received.size(), datagram_size);
  EXPECT_EQ(rs232.received.size(), datagram_size);
  EXPECT_TRUE(rs485.received.empty());
  wait(200 * one_millisecond);
  EXPECT_EQ(rs485.received.size(), datagram_size);
}

TEST(BaudRate, IsAsItWasWhenTheModuleStarted) {
  Bench bench(tmcm1110, hal::PortKind::rs485);
  EXPECT_EQ(bench.module.module().rs485_baud_rate(), 9600U);
  bench.set(GlobalParameter::rs485_baud_rate, 11);
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(bench.module.module().rs485_baud_rate(), 9600U);
  EXPECT_EQ(bench.get(GlobalParameter::rs485_baud_rate), 11);
  bench.module.power_cycle();
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(bench.module.module().rs485_baud_rate(), 1'000'000U);
}

TEST(BaudRate, HasARateForEveryValueOfTheParameter) {
  constexpr std::size_t count = sizeof rs485_baud_rates / sizeof rs485_baud_rates[0];
  for (const ModuleDescription& module : modules) {
    const ParameterColumn& column = global_parameters[row_of(GlobalParameter::rs485_baud_rate)].in(module.id);
    EXPECT_LT(static_cast<std::size_t>(column.maximum), count);
  }
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
  EXPECT_TRUE(rc::check("any nine bytes", [] {
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
        // From then on there would be text instead of datagrams.
        if (bytes[1] == static_cast<std::uint8_t>(Opcode::enter_ascii_mode)) continue;
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
  }));
}

TEST(SuppressReply, LeavesOnlyGapGgpAndGioAnswered) {
  Bench bench(pd1161);
  bench.send(bytes_of(encode(Request{1, {static_cast<std::uint8_t>(Opcode::sgp), 255, 0, 1}})));
  for (const InstructionSpec& row : instructions) {
    if (row.opcode == Opcode::software_reset || row.opcode == Opcode::restore_factory_settings) continue;
    if (row.opcode == Opcode::enter_download_mode || row.opcode == Opcode::enter_ascii_mode) continue;
    const bool answered = row.opcode == Opcode::gap || row.opcode == Opcode::ggp || row.opcode == Opcode::gio;
    const auto reply = bench.send(bytes_of(encode(Request{1, {static_cast<std::uint8_t>(row.opcode), 0, 0, 0}})));
    EXPECT_EQ(reply.size(), answered ? datagram_size : 0U) << static_cast<int>(row.opcode);
  }
}

}  // namespace
}  // namespace opentmcl::tests
