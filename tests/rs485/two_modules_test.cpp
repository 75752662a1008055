// Two modules share one bus: they move together, and neither gets in the way of the other.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "tests/rs485/shared_bus.hpp"

namespace opentmcl::tests {
namespace {

constexpr Command command(Opcode opcode, unsigned type = 0, unsigned motor_or_bank = 0, std::int32_t value = 0) {
  return {static_cast<std::uint8_t>(opcode), static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(motor_or_bank),
          value};
}

constexpr unsigned bank_2 = 2;

struct Participants {
  const char* name;
  const ModuleDescription& first;
  const ModuleDescription& second;
  std::uint32_t baud_rate;
};

class TwoModules : public testing::TestWithParam<Participants> {
 protected:
  SharedBus shared{GetParam().first, GetParam().second, GetParam().baud_rate};
};

INSTANTIATE_TEST_SUITE_P(, TwoModules,
                         testing::Values(Participants{"two_tmcm1110_at_9600_baud", tmcm1110, tmcm1110, 9600},
                                         Participants{"two_pd1161_at_115200_baud", pd1161, pd1161, 115200},
                                         Participants{"one_of_each_at_1000000_baud", tmcm1110, pd1161, 1'000'000}),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(TwoModules, MoveInTheSameTickByOneCommandToTheirSecondaryAddress) {
  const auto expect_same_steps = [this](const Command& group_command, Microseconds duration) {
    shared.first.steps.ticks.clear();
    shared.second.steps.ticks.clear();
    shared.send(SharedBus::group_address, group_command);
    EXPECT_TRUE(shared.wait(shared.datagram_duration() + duration).empty()) << "nobody answers";
    EXPECT_FALSE(shared.first.steps.ticks.empty());
    EXPECT_EQ(shared.first.steps.ticks, shared.second.steps.ticks);
  };
  expect_same_steps(command(Opcode::mvp, 1, 0, 3000), 400 * one_millisecond);
  expect_same_steps(command(Opcode::ror, 0, 0, 500), 200 * one_millisecond);
  expect_same_steps(command(Opcode::mst), 500 * one_millisecond);
  expect_same_steps(command(Opcode::mvp), 900 * one_millisecond);
  for (const std::uint8_t address : {SharedBus::first_address, SharedBus::second_address}) {
    EXPECT_EQ(decode_reply(*shared.exchange(address, command(Opcode::gap, 1))).value, 0);
  }
  EXPECT_EQ(shared.bus.collisions(), 0U);
}

TEST_P(TwoModules, AnswerOnlyForThemselvesAndNeverAtOnce) {
  for (int round = 0; round < 50; ++round) {
    for (const std::uint8_t address : {SharedBus::first_address, SharedBus::second_address}) {
      const auto reply = shared.exchange(address, command(Opcode::sgp, 5, bank_2, round * 7 + address));
      ASSERT_TRUE(reply.has_value());
      EXPECT_TRUE(reply->checksum_is_right());
      EXPECT_EQ(reply->bytes[0], SharedBus::host_address);
      EXPECT_EQ(reply->bytes[1], address);
    }
    EXPECT_FALSE(shared.exchange(77, command(Opcode::ror, 0, 0, 100), one_millisecond).has_value());
  }
  EXPECT_EQ(shared.bus.collisions(), 0U);
}

TEST_P(TwoModules, CountForeignRequestsAndRepliesButDoNotExecuteThem) {
  const std::vector<std::uint8_t> addresses = {SharedBus::first_address, SharedBus::second_address,
                                               SharedBus::group_address, 77, 0};
  EXPECT_TRUE(rc::check("each variable holds what was sent to its module or to both", [&] {
    const auto count = *rc::gen::inRange(1, 30);
    std::int32_t expected[2] = {};
    for (int i = 0; i < count; ++i) {
      const std::uint8_t address = *rc::gen::elementOf(addresses);
      const auto value = *rc::gen::arbitrary<std::int32_t>();
      const bool is_first = address == SharedBus::first_address || address == SharedBus::group_address;
      const bool is_second = address == SharedBus::second_address || address == SharedBus::group_address;
      if (is_first) expected[0] = value;
      if (is_second) expected[1] = value;
      const bool is_answered = address == SharedBus::first_address || address == SharedBus::second_address;
      // The next request follows at once, without the silence by which a node that lost count would recover.
      const auto reply = shared.exchange(address, command(Opcode::sgp, 1, bank_2, value), is_answered ? 50'000 : 0);
      RC_ASSERT(reply.has_value() == is_answered);
    }
    const Command get = command(Opcode::ggp, 1, bank_2);
    const std::int32_t first = decode_reply(shared.exchange(SharedBus::first_address, get).value()).value;
    const std::int32_t second = decode_reply(shared.exchange(SharedBus::second_address, get).value()).value;
    // Variables keep their values from one round to the next: put them back.
    shared.exchange(SharedBus::first_address, command(Opcode::sgp, 1, bank_2, 0));
    shared.exchange(SharedBus::second_address, command(Opcode::sgp, 1, bank_2, 0));
    RC_ASSERT(first == expected[0]);
    RC_ASSERT(second == expected[1]);
    RC_ASSERT(shared.bus.collisions() == 0U);
  }));
}

TEST_P(TwoModules, BothFindTheBeginningAgainAfterAFragmentAndSilence) {
  for (std::size_t length = 1; length < datagram_size; ++length) {
    shared.send(std::vector<std::uint8_t>(length, SharedBus::first_address));
    shared.wait(shared.datagram_duration() + 6 * one_millisecond);
    for (const std::uint8_t address : {SharedBus::first_address, SharedBus::second_address}) {
      const auto reply = shared.exchange(address, command(Opcode::gap, 4));
      ASSERT_TRUE(reply.has_value()) << "after " << length << " bytes";
      EXPECT_EQ(decode_reply(*reply).status, Status::ok);
    }
  }
}

TEST_P(TwoModules, OneAnswersWhileTheOtherIsBusyWithItsEeprom) {
  // Taking away the protection erases the program memory; until that is done command 134 has no answer.
  shared.exchange(SharedBus::first_address, command(Opcode::sgp, 81, 0, 1));
  shared.exchange(SharedBus::first_address, command(Opcode::sgp, 81, 0, 0));
  shared.send(SharedBus::first_address, command(Opcode::read_program_memory));
  EXPECT_TRUE(shared.wait(shared.datagram_duration() + one_millisecond).empty());
  const Microseconds begin = shared.now();
  while (shared.now() - begin < 800 * one_millisecond) {
    const Microseconds asked = shared.now();
    const auto reply = shared.exchange(SharedBus::second_address, command(Opcode::gap, 1));
    ASSERT_TRUE(reply.has_value());
    EXPECT_EQ(reply->bytes[1], SharedBus::second_address);
    EXPECT_LE(shared.now() - asked, 2 * shared.datagram_duration() + one_millisecond);
  }
  EXPECT_EQ(shared.wait(1'000 * one_millisecond).size(), datagram_size) << "the late answer";
  EXPECT_EQ(shared.bus.collisions(), 0U);
}

TEST_P(TwoModules, ReplyAfterATelegramPauseOfTheirOwn) {
  constexpr unsigned telegram_pause = 75;
  for (const std::int32_t pause : {0, 1, 15, 255}) {
    shared.first.over_usb(command(Opcode::sgp, telegram_pause, 0, pause));
    for (const std::uint8_t address : {SharedBus::first_address, SharedBus::second_address}) {
      const Microseconds asked = shared.now();
      ASSERT_TRUE(shared.exchange(address, command(Opcode::gap, 1), 300 * one_millisecond).has_value());
      const Microseconds answered_after = shared.now() - asked - 2 * shared.datagram_duration();
      const Microseconds expected =
          address == SharedBus::first_address ? static_cast<Microseconds>(pause) * one_millisecond : 0;
      EXPECT_GE(answered_after, expected);
      // exchange() looks every 100 µs.
      EXPECT_LE(answered_after, expected + 200);
    }
  }
  EXPECT_EQ(shared.bus.collisions(), 0U);
}

}  // namespace
}  // namespace opentmcl::tests
