#include "boards/twin/rs485_bus.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

namespace opentmcl {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes read_all(hal::BytePort& node) {
  Bytes bytes(1000);
  bytes.resize(node.read(bytes.data(), bytes.size()));
  return bytes;
}

void write(hal::BytePort& node, const Bytes& bytes) {
  node.write(bytes.data(), bytes.size());
}

TEST(Rs485Bus, CarriesABytePerTenBits) {
  EXPECT_EQ(Rs485Bus(9600).byte_duration(), 16'667U) << "1.04 ms in ticks of 62.5 ns";
  EXPECT_EQ(Rs485Bus(1'000'000).byte_duration(), 160U);
}

TEST(Rs485Bus, IsHeardByAllOthersAtTheEndOfEachByte) {
  Rs485Bus bus(9600);
  hal::BytePort& sender = bus.connect();
  hal::BytePort& first = bus.connect();
  hal::BytePort& second = bus.connect();
  bus.advance_to(1000);
  write(sender, {1, 2, 3});
  for (unsigned byte = 1; byte <= 3; ++byte) {
    const twin::Tick arrival = 1000 + byte * bus.byte_duration();
    EXPECT_EQ(bus.next_arrival(), arrival);
    EXPECT_FALSE(bus.advance_to(arrival - 1));
    EXPECT_TRUE(read_all(first).empty());
    EXPECT_TRUE(bus.advance_to(arrival));
    EXPECT_EQ(read_all(first), Bytes{static_cast<std::uint8_t>(byte)});
  }
  EXPECT_EQ(read_all(second), (Bytes{1, 2, 3}));
  EXPECT_TRUE(read_all(sender).empty()) << "nobody hears itself";
  EXPECT_TRUE(bus.is_idle());
  EXPECT_EQ(bus.collisions(), 0U);
}

TEST(Rs485Bus, ReadsNoMoreThanThereIsRoomFor) {
  Rs485Bus bus(9600);
  hal::BytePort& sender = bus.connect();
  hal::BytePort& listener = bus.connect();
  write(sender, {1, 2, 3});
  bus.advance_to(3 * bus.byte_duration());
  std::uint8_t buffer[2];
  EXPECT_EQ(listener.read(buffer, 2), 2U);
  EXPECT_EQ(read_all(listener), Bytes{3});
}

TEST(Rs485Bus, CountsCollisionsAndGarblesWhatIsHeard) {
  Rs485Bus bus(9600);
  hal::BytePort& one = bus.connect();
  hal::BytePort& other = bus.connect();
  hal::BytePort& listener = bus.connect();
  write(one, {0xF0});
  bus.advance_to(bus.byte_duration() - 1);
  write(other, {0x3C, 0x55});
  bus.advance_to(10 * bus.byte_duration());
  EXPECT_EQ(bus.collisions(), 1U);
  EXPECT_EQ(read_all(listener), (Bytes{0x30, 0x30, 0x55}));
  EXPECT_EQ(read_all(one), (Bytes{0x30, 0x55})) << "it listens again when its own byte is over";
  EXPECT_TRUE(read_all(other).empty());
}

TEST(Rs485Bus, HasNoCollisionWhenOneBeginsAsTheOtherEnds) {
  Rs485Bus bus(115200);
  hal::BytePort& one = bus.connect();
  hal::BytePort& other = bus.connect();
  write(one, {1});
  bus.advance_to(bus.byte_duration());
  write(other, {2});
  bus.advance_to(2 * bus.byte_duration());
  EXPECT_EQ(bus.collisions(), 0U);
  EXPECT_EQ(read_all(other), Bytes{1});
  EXPECT_EQ(read_all(one), Bytes{2});
}

TEST(Rs485Bus, DeliversTheSameInOneStepAsInMany) {
  EXPECT_TRUE(rc::check("one step, many steps", [](const std::vector<std::pair<std::uint8_t, std::uint8_t>>& sent) {
    Rs485Bus coarse(19200);
    Rs485Bus fine(19200);
    hal::BytePort* nodes[2][3];
    for (auto*& node : nodes[0]) node = &coarse.connect();
    for (auto*& node : nodes[1]) node = &fine.connect();
    for (const auto& [sender, byte] : sent) {
      nodes[0][sender % 3]->write(&byte, 1);
      nodes[1][sender % 3]->write(&byte, 1);
    }
    const twin::Tick end = (sent.size() + 1) * coarse.byte_duration();
    coarse.advance_to(end);
    while (fine.now() < end) fine.advance_to(std::min(end, fine.now() + fine.byte_duration() / 3));
    for (int node = 0; node < 3; ++node) RC_ASSERT(read_all(*nodes[0][node]) == read_all(*nodes[1][node]));
    RC_ASSERT(coarse.collisions() == fine.collisions());
  }));
}

}  // namespace
}  // namespace opentmcl
