// Global parameter 75: the pause before a reply over RS485.
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

Datagram get_axis_parameter(AxisParameter parameter) {
  return encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), static_cast<std::uint8_t>(parameter), 0, 0}});
}

struct TelegramPause : testing::Test {
  void set_pause(Bench& bench, std::int32_t milliseconds) {
    bench.set(GlobalParameter::telegram_pause_time, milliseconds);
    bench.wait(300 * one_millisecond);  // the reply to this, at the latest
    bench.port.received.clear();
  }

  void send(Bench& bench, const Datagram& request) {
    bench.port.to_module.insert(bench.port.to_module.end(), request.bytes, request.bytes + datagram_size);
    bench.module.wake();
    bench.wait(0);
  }
};

TEST_F(TelegramPause, DelaysTheReplyByThatManyMillisecondsExactly) {
  for (const std::int32_t pause : {0, 1, 15, 255}) {
    Bench bench(pd1161, hal::PortKind::rs485);
    set_pause(bench, pause);
    send(bench, get_axis_parameter(AxisParameter::microstep_resolution));
    if (pause > 0) {
      bench.wait(static_cast<Microseconds>(pause) * one_millisecond - 1);
      EXPECT_TRUE(bench.port.received.empty()) << pause;
      bench.wait(1);
    }
    EXPECT_EQ(bench.port.received.size(), datagram_size) << pause;
  }
}

TEST_F(TelegramPause, DoesNotApplyToOtherPorts) {
  for (const hal::PortKind kind : {hal::PortKind::usb, hal::PortKind::rs232}) {
    Bench bench(pd1161, kind);
    set_pause(bench, 255);
    send(bench, get_axis_parameter(AxisParameter::microstep_resolution));
    EXPECT_EQ(bench.port.received.size(), datagram_size);
  }
}

TEST_F(TelegramPause, LetsTheCommandActAtOnceAndTheProgramGoOn) {
  Bench bench(pd1161, hal::PortKind::rs485);
  bench.run_program("Loop: CALC ADD, 1\nAGP 1, 2\nJA Loop\n");
  set_pause(bench, 200);
  bench.port.received.clear();
  send(bench, encode(Request{1, {static_cast<std::uint8_t>(Opcode::ror), 0, 0, 500}}));
  bench.wait(190 * one_millisecond);
  EXPECT_TRUE(bench.port.received.empty());
  EXPECT_GT(bench.module.world().rotor_angle(), 0);
  bench.wait(20 * one_millisecond);
  EXPECT_EQ(bench.port.received.size(), datagram_size);
  const std::int32_t before = bench.command(Opcode::ggp, 1, 2).value;
  bench.wait(50 * one_millisecond);
  EXPECT_GT(bench.command(Opcode::ggp, 1, 2).value, before + 100);
}

TEST_F(TelegramPause, KeepsRequestsThatComeMeanwhileAndAnswersThemInTheirOrder) {
  Bench bench(pd1161, hal::PortKind::rs485);
  set_pause(bench, 10);
  for (std::int32_t value = 1; value <= 3; ++value) {
    send(bench, encode(Request{1, {static_cast<std::uint8_t>(Opcode::sgp), 7, 2, value}}));
  }
  EXPECT_TRUE(bench.port.received.empty());
  for (std::size_t replies = 1; replies <= 3; ++replies) {
    bench.wait(10 * one_millisecond + 200);  // and the turn of the main loop that takes the next request
    ASSERT_EQ(bench.port.received.size(), replies * datagram_size);
    EXPECT_EQ(bench.port.received[replies * datagram_size - 2], replies);
  }
}

TEST_F(TelegramPause, IsNotKeptAfterACommandThatHasNoReply) {
  Bench bench(pd1161, hal::PortKind::rs485);
  bench.set(GlobalParameter::serial_secondary_address, 9);
  set_pause(bench, 100);
  send(bench, encode(Request{9, {static_cast<std::uint8_t>(Opcode::sgp), 7, 2, 1}}));
  send(bench, encode(Request{3, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}}));
  send(bench, get_axis_parameter(AxisParameter::microstep_resolution));
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(bench.port.received.size(), datagram_size) << "100 ms after the one request that is answered";
}

TEST_F(TelegramPause, HoldsBackASecondReplyUntilTheFirstHasLeft) {
  Bench bench(pd1161, hal::PortKind::rs485);
  set_pause(bench, 50);
  send(bench, encode(Request{1, {static_cast<std::uint8_t>(Opcode::request_position_reached), 0, 0, 1}}));
  bench.wait(50 * one_millisecond);
  bench.port.received.clear();
  send(bench, encode(Request{1, {static_cast<std::uint8_t>(Opcode::mvp), 0, 0, 0}}));  // it is there already
  bench.wait(49 * one_millisecond);
  EXPECT_TRUE(bench.port.received.empty());
  bench.wait(one_millisecond);
  ASSERT_EQ(bench.port.received.size(), datagram_size);
  EXPECT_EQ(bench.port.received[2], static_cast<std::uint8_t>(Status::ok));
  bench.wait(60 * one_millisecond);
  ASSERT_EQ(bench.port.received.size(), 2 * datagram_size);
  EXPECT_EQ(bench.port.received[datagram_size + 2], static_cast<std::uint8_t>(Status::position_reached));
}

TEST_F(TelegramPause, IsOverBeforeTheModuleRestarts) {
  Bench bench(pd1161, hal::PortKind::rs485);
  set_pause(bench, 100);
  bench.set(GlobalParameter::suppress_reply, 0);
  bench.wait(100 * one_millisecond);
  bench.port.received.clear();
  send(bench, encode(Request{1, {static_cast<std::uint8_t>(Opcode::software_reset), 0, 0, 1234}}));
  bench.wait(99 * one_millisecond);
  EXPECT_TRUE(bench.port.received.empty());
  bench.wait(one_millisecond);
  EXPECT_EQ(bench.port.received.size(), datagram_size);
  EXPECT_EQ(bench.command(Opcode::ggp, static_cast<std::uint8_t>(GlobalParameter::tick_timer)).status, Status::ok);
}

}  // namespace
}  // namespace opentmcl::tests
