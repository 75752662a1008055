#include "server/rs485_line.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/memory_line.hpp"

namespace opentmcl::server {
namespace {

constexpr std::uint32_t baud_rate = 9600;

constexpr Command get_position{static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0};

struct HostOnLine final : ReplySink {
  void reply(std::span<const std::uint8_t> bytes) override {
    received.insert(received.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::uint8_t> received;
};

/// Two modules with the addresses 1 and 3 on one line; 2 is the host's.
struct Rs485LineTest : testing::Test {
  Rs485LineTest() {
    for (MemoryLine& beside : usb) {
      const std::vector<hal::Port> ports{{&line.connect(), hal::PortKind::rs485}, {&beside.port(), hal::PortKind::usb}};
      modules.push_back(std::make_unique<VirtualModule>(pd1161, ports));
      line.add(*modules.back());
    }
    wait(100 * one_millisecond);
    constexpr auto serial_address = static_cast<std::uint8_t>(GlobalParameter::serial_address);
    usb[1].send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::sgp), serial_address, 0, 3}}));
    line.wake();
    wait(100 * one_millisecond);
  }
  void send(HostOnLine& host, std::uint8_t address, const Command& command = get_position) {
    port.push(encode(Request{address, command}), host);
    line.wake();
  }
  void wait(Microseconds time, Microseconds slice = 1'000'000) {
    const Microseconds end = line.now() + time;
    while (line.now() < end) line.advance_to(std::min(end, line.now() + slice));
  }

  RequestPort port;
  Rs485Line line{port, baud_rate};
  MemoryLine usb[2];
  std::vector<std::unique_ptr<VirtualModule>> modules;
  HostOnLine first;
  HostOnLine second;
};

TEST_F(Rs485LineTest, CarriesARequestAndItsReplyInTheirTime) {
  send(first, 3);
  wait(18'700);
  EXPECT_LT(first.received.size(), datagram_size);
  wait(100);
  ASSERT_EQ(datagram_size, first.received.size());
  EXPECT_EQ(3, first.received[1]);
}

TEST_F(Rs485LineTest, LetsHostsTakeTurns) {
  for (int i = 0; i < 5; ++i) {
    send(first, 1);
    send(second, 3);
  }
  wait(1'000'000);
  ASSERT_EQ(5 * datagram_size, first.received.size());
  ASSERT_EQ(5 * datagram_size, second.received.size());
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(1, first.received[i * datagram_size + 1]);
    EXPECT_EQ(3, second.received[i * datagram_size + 1]);
  }
  EXPECT_EQ(0u, line.collisions());
}

TEST_F(Rs485LineTest, GoesOnWhenNobodyAnswers) {
  send(first, 77);
  send(second, 1);
  wait(9'375 + 2 * 1'042 + Rs485Line::silence_without_reply + 18'750 + 200);
  EXPECT_TRUE(first.received.empty());
  EXPECT_EQ(datagram_size, second.received.size());
}

TEST_F(Rs485LineTest, MovesItsModulesTogether) {
  wait(12'345);
  for (const auto& module : modules) EXPECT_EQ(line.now(), module->now());
}

TEST_F(Rs485LineTest, DoesNotDependOnHowTimeIsCut) {
  const auto run = [this](Microseconds slice) {
    first.received.clear();
    const Microseconds begin = line.now();
    send(first, 1);
    send(first, 3);
    std::vector<Microseconds> times;
    while (times.size() < 2 * datagram_size && line.now() < begin + 200'000) {
      line.advance_to(std::min(line.next_turn(), line.now() + slice));
      while (times.size() < first.received.size()) times.push_back(line.now() - begin);
    }
    return times;
  };
  const std::vector<Microseconds> whole = run(100'000);
  EXPECT_EQ(2 * datagram_size, whole.size());
  EXPECT_EQ(whole, run(50));
}

TEST_F(Rs485LineTest, HasNothingToDoWhileNobodySpeaks) {
  wait(20'000'000);
  EXPECT_EQ(never, line.next_turn());
}

}  // namespace
}  // namespace opentmcl::server
