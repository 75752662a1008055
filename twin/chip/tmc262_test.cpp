#include "twin/chip/tmc262.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "twin/chip/microstep_table.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::ChopperConfiguration;
using tmc262::CoilCurrents;
using tmc262::DriverConfiguration;
using tmc262::DriverControl;
using tmc262::Reply;
using tmc262::ReplyFormat;
using tmc262::StallGuardAndCurrent;
using tmc262::Word;

constexpr bool up = false;  // DIR low counts up
constexpr bool down = true;

template <class Register>
Word<Reply> send(Tmc262& chip, Word<Register> word, std::uint64_t clock = 0) {
  return {chip.transfer(tmc262::datagram(word), clock)};
}

void switch_bridges_on(Tmc262& chip) {
  send(chip, ChopperConfiguration::OffTime::of(4));
}

/// `count` STEP pulses.
void pulse(Tmc262& chip, bool direction, int count, std::uint64_t clock = 0) {
  for (int i = 0; i < count; ++i) {
    chip.step_edge(true, direction, clock);
    chip.step_edge(false, direction, clock);
  }
}

TEST(MicrostepTable, BeginsAndEndsAsPrinted) {
  const std::vector<std::int32_t> first = {1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17};
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(sine_current(i), first[i]);
  }
  for (std::uint32_t i = 246; i < 256; ++i) {
    EXPECT_EQ(sine_current(i), 248);
  }
}

TEST(MicrostepTable, IsTheFormulaAtEveryEntryOfTheTurn) {
  for (std::uint32_t i = 0; i < 1024; ++i) {
    const double angle = std::acos(-1.0) * (2.0 * i + 1) / 1024;
    EXPECT_EQ(sine_current(i), std::lround(248 * std::sin(angle))) << i;
  }
}

TEST(Tmc262Registers, StartAtZeroWithTheBridgesOff) {
  Tmc262 chip;
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.current_scale(), 0);
  EXPECT_EQ(chip.driver_control().bits, 0u);
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{0, 0}));
}

TEST(Tmc262Registers, TakeTheExampleWordsOfTheDatasheet) {
  Tmc262 chip;
  for (const std::uint32_t word : {0x901B4u, 0xD001Fu, 0xE0010u, 0x00000u}) {
    chip.transfer(word, 0);
  }
  EXPECT_EQ(chip.chopper_configuration().bits, 0x101B4u);
  EXPECT_EQ(chip.stall_guard_and_current().bits, 0x1001Fu);
  EXPECT_EQ(chip.driver_configuration().bits, 0x00010u);
  EXPECT_EQ(chip.unmodelled_writes(), 0u);
  EXPECT_TRUE(chip.bridges_on());
  EXPECT_EQ(chip.current_scale(), 31);
  chip.transfer(0xA8202, 0);
  EXPECT_EQ(chip.cool_step_control().bits, 0x08202u);
}

TEST(Tmc262Registers, CountWritesThatAskForWhatIsNotModelled) {
  const std::uint32_t words[] = {
      0x40000,  // unassigned
      0x00200,  // microPlyer
      0x00009,  // undefined resolution
      0x20000,  // reserved bit of DRVCTRL
      0xA0001,  // coolStep on
      0xC0080,  // reserved bit of SGCSCONF
      0xE0030,  // reserved reply format
      0xF0000,  // test mode
  };
  Tmc262 chip;
  std::uint64_t count = 0;
  for (const std::uint32_t word : words) {
    chip.transfer(word, 0);
    EXPECT_EQ(chip.unmodelled_writes(), ++count) << std::hex << word;
    EXPECT_EQ(chip.latest_unmodelled_write(), word);
  }
}

TEST(Tmc262Reply, HasTheFormatThatWasSelectedBeforeTheTransfer) {
  Tmc262 chip;
  send(chip, StallGuardAndCurrent::CurrentScale::of(21));
  switch_bridges_on(chip);
  pulse(chip, up, 300);
  const auto position = send(chip, DriverConfiguration::of(ReplyFormat::stall_guard));
  EXPECT_EQ(Reply::MicrostepPosition::in(position), 300);
  const auto stall_guard = send(chip, DriverConfiguration::of(ReplyFormat::stall_guard_and_current));
  EXPECT_EQ(Reply::StallGuardValue::in(stall_guard), 1023);
  const auto both = send(chip, DriverConfiguration::of(ReplyFormat::microstep_position));
  EXPECT_EQ(Reply::StallGuardUpperBits::in(both), 31);
  EXPECT_EQ(Reply::CurrentScale::in(both), 21);
  EXPECT_EQ(Reply::MicrostepPosition::in(send(chip, DriverControl::Resolution::of(0))), 300);
}

TEST(Tmc262Reply, TellsStandstillAfterTwoToTheTwentyClocksWithoutAStep) {
  Tmc262 chip;
  const auto standstill = [&chip](std::uint64_t clock) {
    return Reply::Standstill::is_set(send(chip, DriverControl::Resolution::of(0), clock));
  };
  EXPECT_FALSE(standstill((1 << 20) - 1));
  EXPECT_TRUE(standstill(1 << 20));
  pulse(chip, up, 1, 2'000'000);
  EXPECT_FALSE(standstill(2'000'000));
  EXPECT_FALSE(standstill(2'000'000 + (1 << 20) - 1));
  EXPECT_TRUE(standstill(2'000'000 + (1 << 20)));
}

TEST(Tmc262Reply, IgnoresBitsAboveTheTwentieth) {
  Tmc262 chip;
  EXPECT_EQ(chip.transfer(0xFFFD001F, 0) >> 20, 0u);
  EXPECT_EQ(chip.current_scale(), 31);
}

TEST(Tmc262Reply, WarnsOfHeatAndSwitchesTheBridgesOff) {
  Tmc262 chip;
  switch_bridges_on(chip);
  chip.set_temperature(99);
  EXPECT_EQ(Reply::Flags::in(send(chip, DriverControl::Resolution::of(0))), 0);
  chip.set_temperature(100);
  EXPECT_EQ(send(chip, DriverControl::Resolution::of(0)), Reply::OvertemperatureWarning::set);
  EXPECT_TRUE(chip.bridges_on());
  chip.set_temperature(150);
  EXPECT_EQ(send(chip, DriverControl::Resolution::of(0)),
            Reply::OvertemperatureWarning::set | Reply::Overtemperature::set);
  EXPECT_FALSE(chip.bridges_on());
}

class Tmc262Resolution : public testing::TestWithParam<int> {};

TEST_P(Tmc262Resolution, MovesTheSequencerByTwoToItsPower) {
  Tmc262 chip;
  send(chip, DriverControl::Resolution::of(GetParam()));
  pulse(chip, up, 1);
  EXPECT_EQ(chip.microstep_position(), 1u << GetParam());
  pulse(chip, down, 2);
  EXPECT_EQ(chip.microstep_position(), 1024u - (1u << GetParam()));
  pulse(chip, up, 1 + (1024 >> GetParam()));
  EXPECT_EQ(chip.microstep_position(), 0u);
}

INSTANTIATE_TEST_SUITE_P(AllResolutions, Tmc262Resolution, testing::Range(0, 9));

TEST(Tmc262Steps, CountOnRisingEdgesUnlessBothAreEnabled) {
  Tmc262 chip;
  chip.step_edge(false, up, 0);
  EXPECT_EQ(chip.microstep_position(), 0u);
  chip.step_edge(true, up, 0);
  EXPECT_EQ(chip.microstep_position(), 1u);
  send(chip, DriverControl::StepOnBothEdges::set);
  pulse(chip, up, 1);
  EXPECT_EQ(chip.microstep_position(), 3u);
}

TEST(Tmc262Currents, AreSineAndCosineOfThePosition) {
  // Chapter 8, table 8.1: 0 -> A 0, B +100 %; 256 -> +100, 0; 384 -> +70.7, -70.7; 512 -> 0, -100; 768 -> -100, 0.
  const struct {
    std::uint32_t position;
    int a, b;
  } rows[] = {{0, 1, 248}, {256, 248, -1}, {384, 175, -176}, {512, -1, -248}, {768, -248, 1}};
  for (const auto& row : rows) {
    Tmc262 chip;
    switch_bridges_on(chip);
    pulse(chip, up, static_cast<int>(row.position));
    EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{row.a, row.b})) << row.position;
  }
}

RC_GTEST_PROP(Tmc262Currents, HaveAlmostTheSameAmplitudeEverywhere, ()) {
  Tmc262 chip;
  switch_bridges_on(chip);
  pulse(chip, up, *rc::gen::inRange(0, 1024));
  const auto [a, b] = chip.coil_currents();
  RC_ASSERT(std::abs(std::hypot(a, b) - 248) < 1.0);
}

TEST(Tmc262Currents, ComeFromTheBusWhenStepAndDirectionAreOff) {
  Tmc262 chip;
  switch_bridges_on(chip);
  send(chip, DriverConfiguration::StepDirOff::set);
  send(chip, CoilCurrents::SignA::set | CoilCurrents::MagnitudeA::of(100) | CoilCurrents::MagnitudeB::of(200));
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{-100, 200}));
  pulse(chip, up, 5);
  EXPECT_EQ(chip.microstep_position(), 0u);
}

TEST(Tmc262Currents, AreOffWithoutOffTimeAndWithTheEnablePinHigh) {
  Tmc262 chip;
  switch_bridges_on(chip);
  EXPECT_TRUE(chip.bridges_on());
  chip.set_enable_not(true);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{0, 0}));
  chip.set_enable_not(false);
  send(chip, ChopperConfiguration::OffTime::of(0));
  EXPECT_FALSE(chip.bridges_on());
}

TEST(Tmc262Currents, HaveTwoSenseVoltages) {
  Tmc262 chip;
  EXPECT_EQ(chip.sense_voltage(), 310);
  send(chip, DriverConfiguration::LowSenseVoltage::set);
  EXPECT_EQ(chip.sense_voltage(), 165);
}

class Tmc262StallGuard : public testing::Test {
 protected:
  std::int32_t value() {
    return Reply::StallGuardValue::in(send(chip, DriverConfiguration::of(ReplyFormat::stall_guard)));
  }

  Tmc262StallGuard() {
    switch_bridges_on(chip);
    send(chip, DriverConfiguration::of(ReplyFormat::stall_guard));
  }

  Tmc262 chip;
};

TEST_F(Tmc262StallGuard, MeasuresNothingBeforeTheFirstFullStep) {
  pulse(chip, up, 255);
  EXPECT_EQ(value(), 0);
  EXPECT_FALSE(chip.stall_guard_output());
  pulse(chip, up, 1);
  EXPECT_EQ(value(), 1023);
}

TEST_F(Tmc262StallGuard, NeedsFourFullStepsWithTheFilter) {
  send(chip, StallGuardAndCurrent::Filter::set);
  pulse(chip, up, 1023);
  EXPECT_EQ(value(), 0);
  pulse(chip, up, 1);
  EXPECT_EQ(value(), 1023);
}

TEST_F(Tmc262StallGuard, MeasuresNothingWithoutCurrent) {
  chip.set_enable_not(true);
  pulse(chip, up, 2000);
  EXPECT_EQ(value(), 0);
}

RC_GTEST_PROP(Tmc262Bus, TakesAnyWords, ()) {
  Tmc262 chip;
  for (const auto word : *rc::gen::arbitrary<std::vector<std::uint32_t>>()) {
    RC_ASSERT((chip.transfer(word, 0) & ~tmc262::word_mask) == 0u);
    pulse(chip, up, 1);
    RC_ASSERT(chip.microstep_position() < tmc262::microstep_positions);
  }
}

TEST(Tmc262UnderVoltage, TakesAllRegistersAndTheSequencer) {
  Tmc262 chip;
  switch_bridges_on(chip);
  send(chip, StallGuardAndCurrent::CurrentScale::of(21));
  pulse(chip, up, 300);
  chip.set_supply_voltage(7'000);
  EXPECT_TRUE(chip.bridges_on());
  EXPECT_EQ(chip.microstep_position(), 300u);
  chip.set_supply_voltage(6'999);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.current_scale(), 0);
  EXPECT_EQ(chip.microstep_position(), 0u);
  chip.set_supply_voltage(24'000);
  EXPECT_FALSE(chip.bridges_on()) << "nobody wrote them again";
}

TEST(Tmc262UnderVoltage, KeepsTheChipFromTakingWordsAndSteps) {
  Tmc262 chip;
  chip.set_supply_voltage(0);
  switch_bridges_on(chip);
  EXPECT_EQ(chip.transfer(tmc262::datagram(DriverControl::Resolution::of(4)), 0), 0u);
  pulse(chip, up, 10);
  chip.set_supply_voltage(24'000);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.microstep_position(), 0u);
  switch_bridges_on(chip);
  EXPECT_TRUE(chip.bridges_on());
}

TEST(Tmc262Load, IsMeasuredAtTheNextFullStep) {
  Tmc262 chip;
  switch_bridges_on(chip);
  send(chip, DriverConfiguration::of(ReplyFormat::stall_guard));
  chip.set_load_measurement(123);
  EXPECT_EQ(Reply::StallGuardValue::in(send(chip, DriverControl::Resolution::of(0))), 0);
  pulse(chip, up, 256);
  EXPECT_EQ(Reply::StallGuardValue::in(send(chip, DriverControl::Resolution::of(0))), 123);
  chip.set_load_measurement(0);
  pulse(chip, up, 255);
  EXPECT_FALSE(chip.stall_guard_output()) << "within the full step";
  pulse(chip, up, 1);
  EXPECT_TRUE(chip.stall_guard_output());
  EXPECT_TRUE(Reply::StallGuardReached::is_set(send(chip, DriverControl::Resolution::of(0))));
}

}  // namespace
}  // namespace opentmcl::twin
