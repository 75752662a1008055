#include "server/shared_can_port.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace opentmcl::server {
namespace {

struct Sender final : CanFrameSink {
  void send(const hal::CanFrame& frame) override { received.push_back(frame.id); }
  std::vector<std::uint32_t> received;
};

using Ids = std::vector<std::uint32_t>;

struct SharedCanPortTest : testing::Test {
  void push(std::uint32_t id, Sender& sender) { port.push({id, false, 7, {}}, sender); }
  void answer(std::uint32_t id) { port.write({id, false, 7, {}}); }
  std::uint32_t read_id() {
    hal::CanFrame frame;
    EXPECT_TRUE(port.read(frame));
    return frame.id;
  }
  void expect_no_more() {
    hal::CanFrame frame;
    EXPECT_FALSE(port.read(frame));
  }

  SharedCanPort port;
  Sender first;
  Sender second;
};

TEST_F(SharedCanPortTest, GivesTheFramesInTheOrderOfArrival) {
  push(1, first);
  push(2, second);
  push(3, first);
  EXPECT_EQ(3u, port.size());
  EXPECT_EQ(1u, read_id());
  EXPECT_EQ(2u, read_id());
  EXPECT_EQ(3u, read_id());
  expect_no_more();
}

TEST_F(SharedCanPortTest, SendsEachReplyToTheOneWhoAsked) {
  push(1, first);
  push(2, second);
  read_id();
  answer(11);
  read_id();
  answer(22);
  EXPECT_EQ(Ids{11}, first.received);
  EXPECT_EQ(Ids{22}, second.received);
}

TEST_F(SharedCanPortTest, SendsALateReplyToTheOneWhoAskedThoughAnotherRequestWaits) {
  push(1, first);
  read_id();
  push(2, second);
  answer(11);
  EXPECT_EQ(Ids{11}, first.received);
  EXPECT_TRUE(second.received.empty());
}

TEST_F(SharedCanPortTest, SendsASecondReplyToTheOneWhoGotTheFirstThoughForeignFramesCameSince) {
  push(1, first);
  read_id();
  answer(11);
  push(900, second);
  push(901, second);
  read_id();
  read_id();
  expect_no_more();
  answer(12);
  EXPECT_EQ((Ids{11, 12}), first.received);
  EXPECT_TRUE(second.received.empty());
}

TEST_F(SharedCanPortTest, DropsFramesAndRepliesOfASenderThatIsGone) {
  push(1, first);
  push(2, first);
  push(3, second);
  read_id();
  port.forget(first);
  answer(11);
  EXPECT_TRUE(first.received.empty());
  EXPECT_EQ(3u, read_id());
  expect_no_more();
}

TEST_F(SharedCanPortTest, ForgetsWhomItAnsweredLast) {
  push(1, first);
  read_id();
  answer(11);
  port.forget(first);
  expect_no_more();
  answer(12);
  EXPECT_EQ(Ids{11}, first.received);
}

TEST_F(SharedCanPortTest, KnowsTheSpeedAtWhichTheModuleJoined) {
  EXPECT_EQ(0u, port.bit_rate());
  port.join(250'000);
  EXPECT_EQ(250'000u, port.bit_rate());
}

TEST_F(SharedCanPortTest, LosesWhatDoesNotFit) {
  for (std::uint32_t id = 0; id < SharedCanPort::capacity + 10; ++id) push(id, first);
  EXPECT_EQ(SharedCanPort::capacity, port.size());
  EXPECT_EQ(0u, read_id());
}

TEST(SharedCanBus, LetsEachModuleHearEachEndpointAndAnswerItAlone) {
  SharedCanBus bus;
  SharedCanPort& one = bus.connect();
  SharedCanPort& other = bus.connect();
  Sender first;
  Sender second;
  bus.push({1, false, 7, {}}, first);
  bus.push({2, false, 7, {}}, second);
  hal::CanFrame frame;
  ASSERT_TRUE(one.read(frame));
  one.write({11, false, 7, {}});
  ASSERT_TRUE(other.read(frame));
  EXPECT_EQ(1u, frame.id);
  ASSERT_TRUE(other.read(frame));
  EXPECT_EQ(2u, frame.id);
  other.write({22, false, 7, {}});
  EXPECT_EQ(Ids{11}, first.received);
  EXPECT_EQ(Ids{22}, second.received);
  bus.forget(second);
  EXPECT_EQ(0u, one.size());
}

TEST(SharedCanBus, HasTheSpeedOfItsModules) {
  SharedCanBus bus;
  EXPECT_EQ(0u, bus.bit_rate());
  bus.connect().join(500'000);
  EXPECT_EQ(500'000u, bus.bit_rate());
}

}  // namespace
}  // namespace opentmcl::server
