// A TMCM-1110 on a CAN bus. Sources: facts of the TMCM-1110's manuals (global parameters 69 to 71 and 83, chapter 4.1),
// docs/decisions/0020-can.md.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <numeric>

#include "tests/module/bench.hpp"
#include "tests/module/test_can.hpp"

namespace opentmcl::tests {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t module_id = 1;  // global parameter 71
constexpr std::uint32_t reply_id = 2;   // global parameter 70

hal::CanFrame frame_of(std::uint32_t id, const Bytes& data, bool is_extended = false) {
  hal::CanFrame frame{id, is_extended, static_cast<std::uint8_t>(data.size()), {}};
  std::copy(data.begin(), data.end(), frame.data);
  return frame;
}

Bytes data_of(const hal::CanFrame& frame) {
  return {frame.data, frame.data + frame.length};
}

Bytes request(Opcode opcode, std::uint8_t type = 0, std::uint8_t motor = 0, std::int32_t value = 0,
              std::size_t length = 7) {
  Bytes data(length);
  data[0] = static_cast<std::uint8_t>(opcode);
  data[1] = type;
  data[2] = motor;
  put_int32(data.data() + 3, value);
  return data;
}

/// A module with a CAN bus beside a serial line.
struct CanBench {
  explicit CanBench(const ModuleDescription& description, hal::PortKind kind = hal::PortKind::usb)
      : module(description, {{&port, kind}}, options()) {
    wait(one_millisecond);
  }

  VirtualModule::Options options() {
    VirtualModule::Options result;
    result.can = &can;
    return result;
  }

  void wait(Microseconds duration) { module.advance_to(module.now() + duration); }

  /// @return the frames that come back within 60 ms, as long as a command may wait for the EEPROM
  std::vector<hal::CanFrame> send(const std::vector<hal::CanFrame>& frames) {
    can.received.clear();
    can.to_module.insert(can.to_module.end(), frames.begin(), frames.end());
    for (int turn = 0; turn < 60; ++turn) {
      module.wake();
      wait(one_millisecond);
    }
    return can.received;
  }
  std::vector<hal::CanFrame> send(const hal::CanFrame& frame) { return send(std::vector{frame}); }

  /// Sends a request with 7 bytes and expects one reply with status 100. @return its value
  std::int32_t ask(const Bytes& data, std::uint32_t id = module_id) {
    const std::vector<hal::CanFrame> replies = send(frame_of(id, data));
    EXPECT_EQ(replies.size(), 1U);
    if (replies.size() != 1) return 0;
    EXPECT_EQ(replies[0].data[1], static_cast<std::uint8_t>(Status::ok));
    EXPECT_EQ(replies[0].data[2], data[0]);
    return get_int32(replies[0].data + 3);
  }
  std::int32_t set(GlobalParameter parameter, std::int32_t value) {
    return ask(request(Opcode::sgp, static_cast<std::uint8_t>(parameter), 0, value));
  }

  std::size_t serial_replies(const Request& request) {
    const Datagram datagram = encode(request);
    port.received.clear();
    port.to_module.insert(port.to_module.end(), datagram.bytes, datagram.bytes + datagram_size);
    module.wake();
    wait(3 * one_millisecond);
    return port.received.size() / datagram_size;
  }

  TestPort port;
  TestCan can;
  VirtualModule module;
};

TEST(Can, AnswersSevenBytesWithSevenBytes) {
  CanBench bench(tmcm1110);
  const auto replies = bench.send(frame_of(module_id, request(Opcode::gap, 140)));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].id, reply_id);
  EXPECT_FALSE(replies[0].is_extended);
  EXPECT_EQ(data_of(replies[0]), (Bytes{1, 100, 6, 0, 0, 0, 8}));
}

TEST(Can, AnswersEightBytesWithEightBytesWhoseLastIsZero) {
  CanBench bench(tmcm1110);
  for (const int surplus : {0, 0x9F, 255}) {
    Bytes data = request(Opcode::gap, 140, 0, 0, 8);
    data[7] = static_cast<std::uint8_t>(surplus);
    const auto replies = bench.send(frame_of(module_id, data));
    ASSERT_EQ(replies.size(), 1U);
    EXPECT_EQ(data_of(replies[0]), (Bytes{1, 100, 6, 0, 0, 0, 8, 0}));
  }
}

TEST(Can, AnswersA29BitIdentifierWithOne) {
  CanBench bench(tmcm1110);
  const auto replies = bench.send(frame_of(module_id, request(Opcode::gap, 140), true));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_TRUE(replies[0].is_extended);
  EXPECT_EQ(replies[0].id, reply_id);
}

TEST(Can, IgnoresFramesOfAnyOtherLength) {
  CanBench bench(tmcm1110);
  for (std::size_t length = 0; length < 7; ++length) {
    Bytes data = request(Opcode::gap, 140);
    data.resize(length);
    EXPECT_TRUE(bench.send(frame_of(module_id, data)).empty()) << length;
  }
}

TEST(Can, IsSilentForEveryOtherIdentifier) {
  CanBench bench(tmcm1110);
  std::vector<hal::CanFrame> foreign;
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    if (id != module_id) foreign.push_back(frame_of(id, request(Opcode::gap, 140)));
  }
  // Those that share their low bits with an identifier of 11 bits are others as well.
  for (const std::uint32_t id : {0x801U, 0x1000'0001U, 0x1FFF'F801U}) {
    foreign.push_back(frame_of(id, request(Opcode::gap, 140), true));
  }
  EXPECT_TRUE(bench.send(foreign).empty());
  EXPECT_EQ(bench.ask(request(Opcode::gap, 140)), 8);
}

TEST(Can, AnswersRequestsThatComeTogetherInTheirOrder) {
  CanBench bench(tmcm1110);
  std::vector<hal::CanFrame> together;
  together.reserve(5);
  for (int i = 0; i < 5; ++i) together.push_back(frame_of(module_id, request(Opcode::sgp, 7, 2, i)));
  const auto replies = bench.send(together);
  ASSERT_EQ(replies.size(), 5U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(get_int32(replies[static_cast<std::size_t>(i)].data + 3), i);
}

TEST(Can, CarriesTheTextOfTheVersionWholeInEightBytes) {
  CanBench bench(tmcm1110);
  const std::string text = "1110V108";
  const auto whole = bench.send(frame_of(module_id, request(Opcode::get_firmware_version, 0, 0, 0, 8)));
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_EQ(data_of(whole[0]), Bytes(text.begin(), text.end()));
  const auto cut = bench.send(frame_of(module_id, request(Opcode::get_firmware_version)));
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_EQ(data_of(cut[0]), Bytes(text.begin(), text.end() - 1));
}

TEST(Can, ReadsProgramMemoryWithoutAChecksum) {
  CanBench bench(tmcm1110);
  const Bytes instruction = request(Opcode::mvp, 1, 0, -5, 8);
  bench.ask(request(Opcode::enter_download_mode));
  const auto stored = bench.send(frame_of(module_id, instruction));
  ASSERT_EQ(stored.size(), 1U);
  EXPECT_EQ(stored[0].data[1], static_cast<std::uint8_t>(Status::command_loaded));
  bench.ask(request(Opcode::exit_download_mode));
  const auto read = bench.send(frame_of(module_id, request(Opcode::read_program_memory, 0, 0, 0, 8)));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(data_of(read[0]), instruction);
}

TEST(Can, AnswersAsTheSerialLineDoes) {
  // Any bytes but those that change how the module answers: each module gets the same command on its own line.
  EXPECT_TRUE(rc::check("any command", [] {
    const auto opcode = *rc::gen::suchThat(rc::gen::arbitrary<std::uint8_t>(), [](std::uint8_t code) {
      return code != static_cast<std::uint8_t>(Opcode::software_reset) &&
             code != static_cast<std::uint8_t>(Opcode::restore_factory_settings);
    });
    const Command command{opcode, *rc::gen::arbitrary<std::uint8_t>(), *rc::gen::inRange<std::uint8_t>(0, 4),
                          *rc::gen::arbitrary<std::int32_t>()};
    Bench serial(tmcm1110);
    const std::optional<Datagram> expected = serial.exchange(encode(Request{1, command}));
    CanBench bench(tmcm1110);
    const auto replies = bench.send(
        frame_of(module_id, request(static_cast<Opcode>(opcode), command.type, command.motor, command.value)));
    RC_ASSERT(replies.size() == (expected ? 1U : 0U));
    if (!expected) return;
    // The first byte is an address there and an identifier here.
    for (std::size_t i = 1; i < 7; ++i) {
      RC_ASSERT(replies[0].data[i] == expected->bytes[1 + i]);
    }
  }));
}

TEST(CanIdentifiers, AreThoseOfParameters70And71) {
  CanBench bench(tmcm1110);
  bench.set(GlobalParameter::can_reply_id, 0x7FF);
  bench.send(frame_of(module_id, request(Opcode::sgp, static_cast<std::uint8_t>(GlobalParameter::can_id), 0, 0x345)));
  EXPECT_TRUE(bench.send(frame_of(module_id, request(Opcode::gap, 140))).empty());
  const auto replies = bench.send(frame_of(0x345, request(Opcode::gap, 140)));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].id, 0x7FFU);
  EXPECT_EQ(replies[0].data[0], 0x45) << "the low byte of the module's identifier";
}

TEST(CanIdentifiers, SurviveARestart) {
  CanBench bench(tmcm1110);
  bench.send(frame_of(module_id, request(Opcode::sgp, static_cast<std::uint8_t>(GlobalParameter::can_id), 0, 99)));
  bench.wait(100 * one_millisecond);
  bench.module.power_cycle();
  EXPECT_EQ(bench.ask(request(Opcode::gap, 140), 99), 8);
}

TEST(CanSecondaryIdentifier, IsObeyedAndNeverAnswered) {
  CanBench bench(tmcm1110);
  constexpr std::uint32_t group = 0x123;
  EXPECT_TRUE(bench.send(frame_of(group, request(Opcode::sgp, 9, 2, 1))).empty());
  EXPECT_EQ(bench.ask(request(Opcode::ggp, 9, 2)), 0) << "not set yet";
  bench.set(GlobalParameter::can_secondary_id, group);
  EXPECT_TRUE(bench.send(frame_of(group, request(Opcode::sgp, 9, 2, 4711))).empty());
  EXPECT_TRUE(bench.send(frame_of(group, request(Opcode::gap, 140))).empty());
  EXPECT_TRUE(bench.send(frame_of(group, request(Opcode::get_firmware_version))).empty());
  EXPECT_EQ(bench.ask(request(Opcode::ggp, 9, 2)), 4711);
}

TEST(CanSecondaryIdentifier, GivesWayToTheModulesOwn) {
  CanBench bench(tmcm1110);
  bench.set(GlobalParameter::can_secondary_id, module_id);
  EXPECT_EQ(bench.ask(request(Opcode::gap, 140)), 8);
}

TEST(CanBitRate, IsThatOfParameter69AfterTheNextStart) {
  CanBench bench(tmcm1110);
  EXPECT_EQ(bench.can.bit_rate, 1'000'000U);
  constexpr std::uint32_t rates[] = {20'000, 50'000, 100'000, 125'000, 250'000, 500'000, 1'000'000};
  for (std::int32_t code = 2; code <= 8; ++code) {
    const std::uint32_t before = bench.can.bit_rate;
    bench.set(GlobalParameter::can_bit_rate, code);
    EXPECT_EQ(bench.can.bit_rate, before);
    bench.wait(100 * one_millisecond);
    bench.module.power_cycle();
    bench.wait(one_millisecond);
    EXPECT_EQ(bench.can.bit_rate, rates[code - 2]);
  }
}

TEST(CanAndSerial, GetTheirOwnReplies) {
  CanBench bench(tmcm1110);
  const Datagram serial = encode(Request{1, {static_cast<std::uint8_t>(Opcode::sgp), 1, 2, 11}});
  bench.port.to_module.insert(bench.port.to_module.end(), serial.bytes, serial.bytes + datagram_size);
  const auto replies = bench.send(frame_of(module_id, request(Opcode::sgp, 2, 2, 22)));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(get_int32(replies[0].data + 3), 22);
  ASSERT_EQ(bench.port.received.size(), datagram_size);
  EXPECT_EQ(bench.port.received[7], 11);
}

TEST(CanAndSerial, GetTheSecondReplyOfCommand138WhereTheMoveCameFrom) {
  CanBench bench(tmcm1110);
  bench.ask(request(Opcode::request_position_reached, 0, 0, 1));
  bench.ask(request(Opcode::mvp, 0, 0, 20'000));
  bench.can.received.clear();
  bench.port.received.clear();
  bench.wait(2000 * one_millisecond);
  ASSERT_EQ(bench.can.received.size(), 1U);
  EXPECT_EQ(bench.can.received[0].id, reply_id);
  EXPECT_EQ(data_of(bench.can.received[0]), (Bytes{1, 128, 138, 0, 0, 0, 1}));
  EXPECT_TRUE(bench.port.received.empty());
}

TEST(CanHeartbeat, StopsTheMotorWhenNoFrameForTheModuleComes) {
  CanBench bench(tmcm1110);
  bench.set(GlobalParameter::can_heartbeat, 200);
  bench.ask(request(Opcode::ror, 0, 0, 100));
  for (int i = 0; i < 10; ++i) {
    bench.wait(100 * one_millisecond);
    ASSERT_EQ(bench.ask(request(Opcode::gap, 3)), 100) << i;
  }
  // Serial commands and frames for others do not count.
  for (int i = 0; i < 10; ++i) {
    bench.serial_replies({1, {static_cast<std::uint8_t>(Opcode::gap), 3, 0, 0}});
    bench.send(frame_of(900, request(Opcode::gap, 3)));
  }
  EXPECT_EQ(bench.ask(request(Opcode::gap, 3)), 0);
}

TEST(CanHeartbeat, IsOffWhenItIs0) {
  CanBench bench(tmcm1110);
  bench.ask(request(Opcode::ror, 0, 0, 100));
  bench.wait(70'000 * one_millisecond);
  EXPECT_NE(bench.ask(request(Opcode::gap, 2)), 0);
}

TEST(SuppressReply, HoldsOnCanToo) {
  CanBench bench(tmcm1110);
  bench.send(frame_of(module_id, request(Opcode::sgp, 255, 0, 1)));
  EXPECT_TRUE(bench.send(frame_of(module_id, request(Opcode::mst))).empty());
  EXPECT_EQ(bench.ask(request(Opcode::gap, 140)), 8);
}

TEST(Pd1161, DoesNotListenToCan) {
  CanBench bench(pd1161);
  EXPECT_TRUE(bench.send(frame_of(module_id, request(Opcode::gap, 140))).empty());
  EXPECT_EQ(bench.can.bit_rate, 0U);
  EXPECT_EQ(bench.serial_replies({1, {static_cast<std::uint8_t>(Opcode::gap), 140, 0, 0}}), 1U);
}

TEST(AnyFrames, GetAtMostOneReplyEachAndLeaveTheModuleAlive) {
  EXPECT_TRUE(rc::check("any frames", [] {
    CanBench bench(tmcm1110);
    const auto count = *rc::gen::inRange(1, 20);
    for (int i = 0; i < count; ++i) {
      const Bytes data =
          *rc::gen::container<Bytes>(*rc::gen::inRange<std::size_t>(0, 9), rc::gen::arbitrary<std::uint8_t>());
      const auto id = *rc::gen::inRange<std::uint32_t>(0, 4);
      RC_ASSERT(bench.send(frame_of(id, data, *rc::gen::arbitrary<bool>())).size() <= 1U);
    }
    // Reads are answered whatever was switched off, wherever the identifiers have gone: over the serial line.
    std::size_t replies = 0;
    for (int i = 0; i < 100 && replies == 0; ++i) {
      replies = bench.serial_replies({1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}});
      bench.wait(6 * one_millisecond);
    }
    RC_ASSERT(replies == 1U);
  }));
}

}  // namespace
}  // namespace opentmcl::tests
