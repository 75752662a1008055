#include "boards/twin/paced_port.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "firmware/module/module.hpp"

namespace opentmcl {
namespace {

/// A host whose requests are taken whole, and who notes when each byte of the answers came.
struct Host final : hal::BytePort {
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
    if (requests.empty() || capacity < datagram_size) return 0;
    std::copy_n(requests.front().bytes, datagram_size, buffer);
    requests.pop_front();
    return datagram_size;
  }
  void write(const std::uint8_t* data, std::size_t length) override {
    for (std::size_t i = 0; i < length; ++i) received.push_back({data[i], module->now()});
  }

  struct Byte {
    std::uint8_t value;
    Microseconds time;
    friend bool operator==(const Byte&, const Byte&) = default;
  };
  std::deque<Datagram> requests;
  std::vector<Byte> received;
  const VirtualModule* module = nullptr;
};

struct PacedModule {
  explicit PacedModule(std::uint32_t baud_rate, hal::PortKind kind = hal::PortKind::usb)
      : port(host, kind, baud_rate), module(pd1161, {{&port, kind}}) {
    port.connect(module);
    host.module = &module;
    module.advance_to(10 * one_millisecond);
  }
  /// Opcodes are all these tests need: 6 is GAP, 9 SGP, 255 restarts.
  void send(std::uint8_t opcode, std::uint8_t type = 1, std::int32_t value = 0) {
    host.requests.push_back(encode(Request{1, {opcode, type, 0, value}}));
    module.wake();
  }
  void wait(Microseconds time, Microseconds slice = 100 * one_millisecond) {
    const Microseconds end = module.now() + time;
    while (module.now() < end) module.advance_to(std::min(end, module.now() + slice));
  }

  Host host;
  PacedPort port;
  VirtualModule module;
};

TEST(PacedPort, TakesAsLongForARequestAndItsReplyAsTheRealWire) {
  struct Case {
    std::uint32_t baud_rate;
    Microseconds expected;
  };
  // 18 bytes of 10 bits each, up to the next microsecond.
  for (const Case& each : {Case{9600, 18'750}, Case{115'200, 1'563}, Case{1'000'000, 180}}) {
    PacedModule paced(each.baud_rate);
    const Microseconds asked = paced.module.now();
    paced.send(6);
    paced.wait(30 * one_millisecond);
    ASSERT_EQ(paced.host.received.size(), datagram_size);
    const Microseconds took = paced.host.received.back().time - asked;
    EXPECT_GE(took, each.expected);
    EXPECT_LE(took, each.expected + 2) << each.baud_rate;
  }
}

TEST(PacedPort, GivesEachByteOfTheReplyItsTime) {
  PacedModule paced(9600);
  paced.send(6);
  paced.wait(30 * one_millisecond);
  ASSERT_EQ(paced.host.received.size(), datagram_size);
  for (std::size_t i = 1; i < datagram_size; ++i) {
    EXPECT_NEAR(static_cast<double>(paced.host.received[i].time - paced.host.received[i - 1].time), 1041.7, 1);
  }
}

TEST(PacedPort, HasOneExchangeOnTheLineAtATime) {
  PacedModule paced(9600);
  const Microseconds asked = paced.module.now();
  for (int i = 0; i < 10; ++i) paced.send(6);
  paced.wait(20 * one_millisecond);
  EXPECT_EQ(paced.host.received.size(), datagram_size);
  EXPECT_EQ(paced.host.requests.size(), 8U);
  paced.wait(300 * one_millisecond);
  ASSERT_EQ(paced.host.received.size(), 10 * datagram_size);
  const Microseconds took = paced.host.received.back().time - asked;
  EXPECT_GE(took, 187'500U);
  EXPECT_LE(took, 187'500U + 20) << "no pause between one reply and the next request";
}

TEST(PacedPort, DoesNotDependOnHowTimeIsCut) {
  const auto run = [](Microseconds slice) {
    PacedModule paced(19'200);
    for (int i = 0; i < 5; ++i) paced.send(6);
    paced.wait(100 * one_millisecond, slice);
    return paced.host.received;
  };
  const std::vector<Host::Byte> whole = run(100 * one_millisecond);
  EXPECT_EQ(whole.size(), 5 * datagram_size);
  EXPECT_EQ(run(1), whole);
  EXPECT_EQ(run(777), whole);
}

TEST(PacedPort, IsOnlyUnderstoodOnRs485AtTheModulesBaudRate) {
  constexpr std::uint8_t sgp = 9;
  constexpr std::uint8_t baud_rate_parameter = 65;
  constexpr std::uint8_t code_of_19200 = 2;
  constexpr std::uint8_t restart = 255;
  PacedModule wrong(19'200, hal::PortKind::rs485);
  wrong.send(6);
  wrong.wait(50 * one_millisecond);
  EXPECT_TRUE(wrong.host.received.empty());
  EXPECT_TRUE(wrong.host.requests.empty()) << "it has gone over the line, unheard";

  PacedModule right(9600, hal::PortKind::rs485);
  right.send(sgp, baud_rate_parameter, code_of_19200);
  right.wait(100 * one_millisecond);
  EXPECT_EQ(right.host.received.size(), datagram_size);
  right.send(restart, 0, 1234);
  right.wait(100 * one_millisecond);
  right.host.received.clear();
  right.send(6);
  right.wait(100 * one_millisecond);
  EXPECT_EQ(right.module.module().rs485_baud_rate(), 19'200U);
  EXPECT_TRUE(right.host.received.empty()) << "the host is still at 9600";
}

}  // namespace
}  // namespace opentmcl
