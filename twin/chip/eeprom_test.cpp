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
  const Eeprom::Image image = Eeprom().image();
  EXPECT_TRUE(std::all_of(image.begin(), image.end(), [](auto byte) { return byte == 0xFF; }));
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
  const Eeprom::Image image = eeprom.image();
  for (std::size_t i = 0; i < 128; ++i) {
    RC_ASSERT(image[i] == (i < survivors ? bytes[i % 64] : Eeprom::erased));
  }
}

TEST(Eeprom, KeepsTheLastPageFullOfALongerWrite) {
  Eeprom eeprom;
  const auto bytes = counting_bytes(130);
  eeprom.write_page(64 + 10, bytes.data(), bytes.size(), 0);
  for (std::size_t i = 66; i < 130; ++i) {
    EXPECT_EQ(eeprom.image()[64 + (10 + i) % 64], bytes[i]) << i;
  }
  EXPECT_EQ(eeprom.image()[128], 0xFF);
}

RC_GTEST_PROP(Eeprom, TearsAPageWhereTheSupplyFailsInTime, ()) {
  Eeprom eeprom;
  const auto old_bytes = counting_bytes(64);
  eeprom.write_page(128, old_bytes.data(), 64, 0);
  const auto length = *rc::gen::inRange<std::size_t>(1, 65);
  const auto offset = *rc::gen::inRange<std::size_t>(0, 64);
  const std::vector<std::uint8_t> new_bytes(length, 200);
  const std::uint64_t begin = 80'000;
  eeprom.write_page(static_cast<std::uint16_t>(128 + offset), new_bytes.data(), length, begin);
  const auto elapsed = *rc::gen::inRange<std::uint64_t>(0, 90'000);
  eeprom.lose_power(begin + elapsed);
  RC_ASSERT(eeprom.power_lost());
  const Eeprom::Image image = eeprom.image();
  std::vector<std::uint8_t> expected = old_bytes;
  for (std::size_t i = 0; i < length; ++i) {
    // Byte i is finished (i + 1) / length of 5 ms after the beginning.
    if (elapsed * length >= (i + 1) * 80'000) expected[(offset + i) % 64] = 200;
  }
  RC_ASSERT(std::vector<std::uint8_t>(image.begin() + 128, image.begin() + 192) == expected);
}

TEST(Eeprom, TakesNoWriteBetweenTheLossOfPowerAndPowerUp) {
  Eeprom eeprom;
  const std::uint8_t byte = 7;
  eeprom.lose_power(1'000);
  eeprom.write_page(0, &byte, 1, 1'000);
  EXPECT_EQ(eeprom.image()[0], 0xFF);
  eeprom.power_up();
  EXPECT_FALSE(eeprom.busy(1'000));
  eeprom.write_page(0, &byte, 1, 1'000);
  EXPECT_EQ(eeprom.image()[0], 7);
}

TEST(Eeprom, SpendsMemoryOnPagesThatHoldSomethingOnly) {
  Eeprom eeprom;
  EXPECT_EQ(eeprom.stored_pages(), 0u);
  const std::vector<std::uint8_t> erased(64, Eeprom::erased);
  eeprom.write_page(640, erased.data(), 64, 0);
  EXPECT_EQ(eeprom.stored_pages(), 0u);
  EXPECT_TRUE(eeprom.busy(1)) << "it takes its time all the same";
  const std::uint8_t byte = 7;
  eeprom.write_page(1'000, &byte, 1, 80'000);
  EXPECT_EQ(eeprom.stored_pages(), 1u);
  Eeprom second;
  second.load(eeprom.image());
  EXPECT_EQ(second.stored_pages(), 1u);
  second.load(Eeprom().image());
  EXPECT_EQ(second.stored_pages(), 0u);
}

/// The pages together behave as one array does.
RC_GTEST_PROP(Eeprom, ReadsWhatWasWritten, ()) {
  Eeprom eeprom;
  Eeprom::Image expected = eeprom.image();
  std::uint64_t clock = 0;
  for (int i = 0; i < 20; ++i) {
    const auto address = *rc::gen::inRange<std::uint16_t>(0, Eeprom::size);
    const auto bytes = *rc::gen::container<std::vector<std::uint8_t>>(*rc::gen::inRange<std::size_t>(1, 65),
                                                                      rc::gen::arbitrary<std::uint8_t>());
    eeprom.write_page(address, bytes.data(), bytes.size(), clock);
    clock += Eeprom::page_write_clocks;
    for (std::size_t k = 0; k < bytes.size(); ++k) expected[address / 64 * 64 + (address + k) % 64] = bytes[k];
  }
  RC_ASSERT(eeprom.image() == expected);
  const auto address = *rc::gen::inRange<std::uint16_t>(0, Eeprom::size);
  const auto bytes = read(eeprom, address, *rc::gen::inRange<std::size_t>(0, 500), clock);
  for (std::size_t k = 0; k < bytes.size(); ++k) RC_ASSERT(bytes[k] == expected[(address + k) % Eeprom::size]);
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
