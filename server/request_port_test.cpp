#include "server/request_port.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace opentmcl::server {
namespace {

struct Sender final : ReplySink {
  void reply(std::span<const std::uint8_t> bytes) override {
    received.insert(received.end(), bytes.begin(), bytes.end());
  }
  void room_again() override { ++times_told; }
  std::vector<std::uint8_t> received;
  int times_told = 0;
};

Datagram request(std::uint8_t opcode) {
  return encode(Request{1, {opcode, 0, 0, 0}});
}

struct RequestPortTest : testing::Test {
  std::uint8_t read_opcode() {
    std::uint8_t buffer[16] = {};
    EXPECT_EQ(datagram_size, port.read(buffer, sizeof buffer));
    return buffer[1];
  }
  void answer(std::uint8_t byte) { port.write(&byte, 1); }

  RequestPort port;
  Sender first;
  Sender second;
};

TEST_F(RequestPortTest, GivesOneRequestAtATimeInTheOrderOfArrival) {
  port.push(request(1), first);
  port.push(request(2), second);
  EXPECT_EQ(1, read_opcode());
  EXPECT_EQ(2, read_opcode());
  std::uint8_t buffer[16];
  EXPECT_EQ(0u, port.read(buffer, sizeof buffer));
}

TEST_F(RequestPortTest, SendsEachReplyToTheOneWhoAsked) {
  port.push(request(1), first);
  port.push(request(2), second);
  read_opcode();
  answer(11);
  read_opcode();
  answer(22);
  EXPECT_EQ(std::vector<std::uint8_t>{11}, first.received);
  EXPECT_EQ(std::vector<std::uint8_t>{22}, second.received);
}

TEST_F(RequestPortTest, PassesCharactersOneByOne) {
  port.push(std::uint8_t{'A'}, first);
  port.push(std::uint8_t{'B'}, second);
  EXPECT_EQ(2u, port.size());
  std::uint8_t buffer[16] = {};
  EXPECT_EQ(1u, port.read(buffer, sizeof buffer));
  EXPECT_EQ('A', buffer[0]);
  answer(11);
  EXPECT_EQ(1u, port.read(buffer, sizeof buffer));
  EXPECT_EQ('B', buffer[0]);
  answer(22);
  EXPECT_EQ(0u, port.read(buffer, sizeof buffer));
  EXPECT_EQ(std::vector<std::uint8_t>{11}, first.received);
  EXPECT_EQ(std::vector<std::uint8_t>{22}, second.received);
}

TEST_F(RequestPortTest, KnowsWhatTheFirmwareExpects) {
  EXPECT_FALSE(port.is_in_text_mode());
  static_cast<hal::BytePort&>(port).set_text_mode(true);
  EXPECT_TRUE(port.is_in_text_mode());
}

TEST_F(RequestPortTest, SendsALateReplyToTheOneWhoAskedThoughAnotherRequestWaits) {
  port.push(request(1), first);
  read_opcode();
  port.push(request(2), second);
  std::uint8_t buffer[1];
  EXPECT_EQ(0u, port.read(buffer, 0));
  answer(11);
  EXPECT_EQ(std::vector<std::uint8_t>{11}, first.received);
  EXPECT_TRUE(second.received.empty());
}

TEST_F(RequestPortTest, DropsRequestsAndRepliesOfASenderThatIsGone) {
  port.push(request(1), first);
  port.push(request(2), first);
  port.push(request(3), second);
  EXPECT_EQ(1, read_opcode());
  port.forget(first);
  answer(11);
  EXPECT_TRUE(first.received.empty());
  EXPECT_EQ(3, read_opcode());
}

TEST_F(RequestPortTest, TellsWhoWaitsOnceThatThereIsRoomAgain) {
  for (std::size_t i = 0; i < RequestPort::capacity; ++i) {
    EXPECT_FALSE(port.is_full());
    port.push(request(1), first);
  }
  EXPECT_TRUE(port.is_full());
  port.wait_for_room(first);
  while (port.size() > RequestPort::capacity / 2 + 1) read_opcode();
  EXPECT_EQ(0, first.times_told);
  while (port.size() > 0) read_opcode();
  EXPECT_EQ(1, first.times_told);
}

TEST_F(RequestPortTest, KeepsTheOrderOfManyMoreRequestsThanItHoldsAtATime) {
  std::uint8_t sent = 0;
  std::uint8_t received = 0;
  for (std::size_t i = 0; i < 10 * RequestPort::capacity; ++i) {
    port.push(request(sent++), first);
    port.push(request(sent++), second);
    ASSERT_EQ(received++, read_opcode());
    if (port.size() < RequestPort::capacity) continue;
    while (port.size() > 5) ASSERT_EQ(received++, read_opcode());
  }
}

TEST_F(RequestPortTest, DoesNotTellWhoIsGone) {
  for (std::size_t i = 0; i < RequestPort::capacity; ++i) port.push(request(1), second);
  port.wait_for_room(first);
  port.forget(first);
  while (port.size() > 0) read_opcode();
  EXPECT_EQ(0, first.times_told);
}

TEST_F(RequestPortTest, FinishesARequestThatWasReadInPart) {
  port.push(request(1), first);
  std::uint8_t buffer[16];
  ASSERT_EQ(4u, port.read(buffer, 4));
  port.forget(first);
  ASSERT_EQ(5u, port.read(buffer, sizeof buffer));
  EXPECT_EQ(0u, port.size());
  answer(11);
  EXPECT_TRUE(first.received.empty());
}

}  // namespace
}  // namespace opentmcl::server
