#include "twin/chip/eeprom.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace opentmcl::twin {
namespace {

std::vector<std::uint8_t> counting_bytes(std::size_t length) {
  std::vector<std::uint8_t> bytes(length);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

std::vector<std::uint8_t> read(const Eeprom& eeprom, std::uint16_t address, std::size_t length, std::uint64_t clock) {
  std::vector<std::uint8_t> bytes(length);
  eeprom.read(address, bytes.data(), length, clock);
  return bytes;
}

TEST(Eeprom, IsErasedWhenNew) {
  const Eeprom eeprom;
  EXPECT_TRUE(std::all_of(eeprom.image().begin(), eeprom.image().end(), [](auto byte) { return byte == 0xFF; }));
}

TEST(Eeprom, IsBusyForFiveMillisecondsAfterAPageWrite) {
  Eeprom eeprom;
  const auto bytes = counting_bytes(3);
  eeprom.write_page(100, bytes.data(), bytes.size(), 1000);
  EXPECT_TRUE(eeprom.busy(1000));
  EXPECT_TRUE(eeprom.busy(80'999));
  EXPECT_FALSE(eeprom.busy(81'000));
  EXPECT_EQ(read(eeprom, 100, 3, 80'999), (std::vector<std::uint8_t>{0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(read(eeprom, 100, 3, 81'000), bytes);
}

TEST(Eeprom, IgnoresAWriteWhileBusy) {
  Eeprom eeprom;
  const auto bytes = counting_bytes(2);
  eeprom.write_page(0, bytes.data(), 1, 0);
  eeprom.write_page(1, bytes.data(), 2, 79'999);
  EXPECT_EQ(eeprom.ignored_writes(), 1u);
  EXPECT_EQ(eeprom.image()[1], 0xFF);
}

TEST(Eeprom, WrapsAWriteWithinItsPage) {
  Eeprom eeprom;
  const auto bytes = counting_bytes(4);
  eeprom.write_page(64 + 62, bytes.data(), bytes.size(), 0);
  EXPECT_EQ(eeprom.image()[126], 1);
  EXPECT_EQ(eeprom.image()[127], 2);
  EXPECT_EQ(eeprom.image()[64], 3);
  EXPECT_EQ(eeprom.image()[65], 4);
  EXPECT_EQ(eeprom.image()[128], 0xFF);
}

TEST(Eeprom, ReadsOnFromTheBeginningPastItsEnd) {
  Eeprom eeprom;
  const std::uint8_t byte = 7;
  eeprom.write_page(0, &byte, 1, 0);
  EXPECT_EQ(read(eeprom, 16383, 2, 80'000), (std::vector<std::uint8_t>{0xFF, 7}));
}

RC_GTEST_PROP(Eeprom, KeepsExactlyTheBytesThatWereWrittenBeforeThePowerWasCut, ()) {
  const auto survivors = *rc::gen::inRange<std::size_t>(0, 129);
  Eeprom eeprom;
  eeprom.cut_power_after(survivors);
  const auto bytes = counting_bytes(64);
  eeprom.write_page(0, bytes.data(), 64, 0);
  eeprom.write_page(64, bytes.data(), 64, 80'000);
  RC_ASSERT(eeprom.power_lost() == (survivors <= 128));
  for (std::size_t i = 0; i < 128; ++i) {
    RC_ASSERT(eeprom.image()[i] == (i < survivors ? bytes[i % 64] : Eeprom::erased));
  }
}

TEST(Eeprom, WorksAgainAfterPowerUp) {
  Eeprom eeprom;
  const std::uint8_t byte = 7;
  eeprom.cut_power_after(0);
  eeprom.write_page(0, &byte, 1, 0);
  EXPECT_EQ(eeprom.image()[0], 0xFF);
  EXPECT_EQ(eeprom.bytes_written(), 0u);
  eeprom.power_up();
  EXPECT_FALSE(eeprom.busy(0));
  eeprom.write_page(0, &byte, 1, 0);
  EXPECT_EQ(eeprom.image()[0], 7);
}

TEST(Eeprom, TakesOverAnImage) {
  Eeprom first;
  const auto bytes = counting_bytes(64);
  first.write_page(4096, bytes.data(), bytes.size(), 0);
  Eeprom second;
  second.load(first.image());
  EXPECT_EQ(second.image(), first.image());
}

}  // namespace
}  // namespace opentmcl::twin
