// Registers, replies and currents of the TMC262.
#include "twin/chip/tmc262.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "twin/chip/microstep_table.hpp"
#include "twin/chip/tmc262_test_bench.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::ChopperConfiguration;
using tmc262::CoilCurrents;
using tmc262::CoolStepControl;
using tmc262::DriverConfiguration;
using tmc262::DriverControl;
using tmc262::Reply;
using tmc262::ReplyFormat;
using tmc262::StallGuardAndCurrent;
using tmc262::Word;

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

class Tmc262Chip : public testing::Test, protected Tmc262Bench {};
using Tmc262Registers = Tmc262Chip;
using Tmc262Reply = Tmc262Chip;
using Tmc262Currents = Tmc262Chip;
using Tmc262UnderVoltage = Tmc262Chip;
using Tmc262PowerUp = Tmc262Chip;

TEST_F(Tmc262Registers, StartAtZeroWithTheBridgesOff) {
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.current_scale(), 0);
  EXPECT_EQ(chip.driver_control().bits, 0u);
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{0, 0}));
}

// The words that the vendor prints in chapter 7.11, and what their bits mean by the tables of chapters 7.5 to 7.9.

TEST_F(Tmc262Registers, TakeTheVendorsChopperWords) {
  chip.transfer(0x901B4, 0);
  Word<ChopperConfiguration> chopper = chip.chopper_configuration();
  EXPECT_EQ(ChopperConfiguration::BlankTime::in(chopper), 2) << "36 clocks";
  EXPECT_FALSE(ChopperConfiguration::ConstantOffTime::is_set(chopper));
  EXPECT_FALSE(ChopperConfiguration::RandomOffTime::is_set(chopper));
  EXPECT_EQ(ChopperConfiguration::HysteresisDecrement::in(chopper), 0);
  EXPECT_EQ(ChopperConfiguration::HysteresisEnd::in(chopper), 3);
  EXPECT_EQ(ChopperConfiguration::HysteresisStart::in(chopper), 3);
  EXPECT_EQ(ChopperConfiguration::OffTime::in(chopper), 4);
  EXPECT_TRUE(chip.bridges_on());
  chip.transfer(0x94557, 0);
  chopper = chip.chopper_configuration();
  EXPECT_EQ(ChopperConfiguration::BlankTime::in(chopper), 2);
  EXPECT_TRUE(ChopperConfiguration::ConstantOffTime::is_set(chopper));
  EXPECT_FALSE(ChopperConfiguration::FastDecayByTimerOnly::is_set(chopper));
  EXPECT_FALSE(ChopperConfiguration::FastDecayTimeTopBit::is_set(chopper));
  EXPECT_EQ(ChopperConfiguration::HysteresisEnd::in(chopper), 10) << "an offset of 7";
  EXPECT_EQ(ChopperConfiguration::HysteresisStart::in(chopper), 5) << "fast decay of 160 clocks";
  EXPECT_EQ(ChopperConfiguration::OffTime::in(chopper), 7);
  EXPECT_EQ(chip.unmodelled_writes(), 0u);
}

TEST_F(Tmc262Registers, TakeTheVendorsWordForFullCurrent) {
  chip.transfer(0xD001F, 0);
  EXPECT_EQ(chip.current_scale(), 31);
  EXPECT_TRUE(StallGuardAndCurrent::Filter::is_set(chip.stall_guard_and_current()));
  EXPECT_EQ(StallGuardAndCurrent::Threshold::in(chip.stall_guard_and_current()), 0);
  EXPECT_EQ(chip.unmodelled_writes(), 0u);
}

TEST_F(Tmc262Registers, TakeTheVendorsWordForTheReplyFormat) {
  chip.transfer(0xE0010, 0);
  EXPECT_EQ(DriverConfiguration::reply_format_in(chip.driver_configuration()), ReplyFormat::stall_guard);
  EXPECT_EQ(chip.sense_voltage(), 310);
  EXPECT_EQ(chip.unmodelled_writes(), 0u);
}

TEST_F(Tmc262Registers, TakeTheVendorsWordsForStepsAndCoolStep) {
  chip.transfer(0x00000, 0);
  EXPECT_EQ(chip.microsteps_per_pulse(), 1) << "256 microsteps";
  chip.transfer(0xA8202, 0);
  const Word<CoolStepControl> cool_step = chip.cool_step_control();
  EXPECT_EQ(CoolStepControl::MinimumCurrent::in(cool_step), 1) << "a quarter of CS";
  EXPECT_EQ(CoolStepControl::CurrentDownStep::in(cool_step), 0);
  EXPECT_EQ(CoolStepControl::HysteresisWidth::in(cool_step), 2);
  EXPECT_EQ(CoolStepControl::CurrentUpStep::in(cool_step), 0);
  EXPECT_EQ(CoolStepControl::HysteresisStart::in(cool_step), 2);
  EXPECT_EQ(chip.unmodelled_writes(), 0u);
}

TEST_F(Tmc262Registers, CountWritesOfWhatIsNotDefined) {
  const std::uint32_t words[] = {
      0x40000,  // unassigned
      0x60000,  // unassigned
      0x00009,  // undefined resolution
      0x00010,  // reserved bits of DRVCTRL
      0x20000,
      0xB0001,  // reserved bits of SMARTEN
      0xA1000, 0xA0080, 0xA0010,
      0xC0080,  // reserved bits of SGCSCONF
      0xC8000,
      0xE0030,  // reserved reply format
      0xE0001,  // reserved bits of DRVCONF
      0xE0800,
      0xF0000,  // test mode
  };
  std::uint64_t count = 0;
  for (const std::uint32_t word : words) {
    chip.transfer(word, 0);
    EXPECT_EQ(chip.unmodelled_writes(), ++count) << std::hex << word;
    EXPECT_EQ(chip.latest_unmodelled_write(), word);
  }
}

TEST_F(Tmc262Registers, KnowEveryOtherBit) {
  for (const std::uint32_t word : {0x00308u, 0x9FFFFu, 0xAEF6Fu, 0xD7F1Fu, 0xE0000u | 0xF7E0u}) {
    chip.transfer(word & ~0x10u, 0);
    EXPECT_EQ(chip.unmodelled_writes(), 0u) << std::hex << word;
  }
}

TEST_F(Tmc262Reply, HasTheFormatThatWasSelectedBeforeTheTransfer) {
  set_current_scale(21);
  switch_bridges_on();
  pulse(up, 300);
  const auto position = send(DriverConfiguration::of(ReplyFormat::stall_guard));
  EXPECT_EQ(Reply::MicrostepPosition::in(position), 300);
  const auto stall_guard = send(DriverConfiguration::of(ReplyFormat::stall_guard_and_current));
  EXPECT_EQ(Reply::StallGuardValue::in(stall_guard), 1023);
  const auto both = send(DriverConfiguration::of(ReplyFormat::microstep_position));
  EXPECT_EQ(Reply::StallGuardUpperBits::in(both), 31);
  EXPECT_EQ(Reply::CurrentScale::in(both), 21);
  EXPECT_EQ(Reply::MicrostepPosition::in(reply()), 300);
}

TEST_F(Tmc262Reply, HasItsBitsWhereTheDatasheetHasThem) {
  // 300 = %0100101100; SG 1023 and SE 21 = %10101; the flags are STST alone.
  set_current_scale(21);
  switch_bridges_on();
  pulse(up, 300);
  wait(1 << 20);
  EXPECT_EQ(chip.transfer(0xE0010, chip.clock()), 0x4B080u);
  EXPECT_EQ(chip.transfer(0xE0020, chip.clock()), 0xFFC80u);
  EXPECT_EQ(chip.transfer(0xE0000, chip.clock()), 0xFD480u);
}

TEST_F(Tmc262Reply, TellsStandstillAfterTwoToTheTwentyClocksWithoutAStep) {
  const auto standstill_at = [this](std::uint64_t clock) {
    chip.advance(clock);
    return Reply::Standstill::is_set(reply());
  };
  EXPECT_FALSE(standstill_at((1 << 20) - 1));
  EXPECT_TRUE(standstill_at(1 << 20));
  chip.advance(2'000'000);
  pulse(up, 1);
  EXPECT_FALSE(standstill_at(2'000'000));
  EXPECT_FALSE(standstill_at(2'000'000 + (1 << 20) - 1));
  EXPECT_TRUE(standstill_at(2'000'000 + (1 << 20)));
}

TEST_F(Tmc262Reply, IgnoresBitsAboveTheTwentieth) {
  EXPECT_EQ(chip.transfer(0xFFFD001F, 0) >> 20, 0u);
  EXPECT_EQ(chip.current_scale(), 31);
}

RC_GTEST_FIXTURE_PROP(Tmc262Chip, TakesAnyWords, ()) {
  for (const auto word : *rc::gen::arbitrary<std::vector<std::uint32_t>>()) {
    RC_ASSERT((chip.transfer(word, chip.clock()) & ~tmc262::word_mask) == 0u);
    pulse(up, 1);
    RC_ASSERT(chip.microstep_position() < tmc262::microstep_positions);
  }
}

TEST_F(Tmc262Currents, AreSineAndCosineOfThePosition) {
  // Chapter 8, table 8.1: 0 -> A 0, B +100 %; 256 -> +100, 0; 384 -> +70.7, -70.7; 512 -> 0, -100; 768 -> -100, 0.
  const struct {
    std::uint32_t position;
    int a, b;
  } rows[] = {{0, 1, 248}, {256, 248, -1}, {384, 175, -176}, {512, -1, -248}, {768, -248, 1}};
  switch_bridges_on();
  for (const auto& row : rows) {
    pulse(up, row.position - chip.microstep_position());
    EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{row.a, row.b})) << row.position;
  }
}

RC_GTEST_FIXTURE_PROP(Tmc262Chip, HasAlmostTheSameCurrentEverywhere, ()) {
  switch_bridges_on();
  pulse(up, *rc::gen::inRange(1u, 1024u));
  const auto [a, b] = chip.coil_currents();
  RC_ASSERT(std::abs(std::hypot(a, b) - 248) < 1.0);
}

TEST_F(Tmc262Currents, ComeFromTheBusWhenStepAndDirectionAreOff) {
  switch_bridges_on();
  send(DriverConfiguration::StepDirOff::set);
  send(CoilCurrents::SignA::set | CoilCurrents::MagnitudeA::of(100) | CoilCurrents::MagnitudeB::of(255));
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{-100, 255}));
  pulse(up, 5);
  EXPECT_EQ(chip.microstep_position(), 0u);
  EXPECT_EQ(chip.microsteps_per_pulse(), 0);
}

TEST_F(Tmc262Currents, AreOffWithoutOffTimeAndWithTheEnablePinHigh) {
  switch_bridges_on();
  EXPECT_TRUE(chip.bridges_on());
  chip.set_enable_not(true);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{0, 0}));
  chip.set_enable_not(false);
  switch_bridges_off();
  EXPECT_FALSE(chip.bridges_on());
}

TEST_F(Tmc262Currents, GrowWithTheOffsetOfTheConstantOffTimeChopper) {
  // Half a unit of the table for each step of the code; the converter ends at 255.
  const auto peak_with = [this](std::int32_t code) {
    send(ChopperConfiguration::ConstantOffTime::set | ChopperConfiguration::HysteresisEnd::of(code) |
         ChopperConfiguration::OffTime::of(off_time));
    return chip.coil_currents().b;
  };
  EXPECT_EQ(peak_with(3), 248);
  EXPECT_EQ(peak_with(5), 249);
  EXPECT_EQ(peak_with(15), 254);
  EXPECT_EQ(peak_with(1), 247);
  send(DriverConfiguration::StepDirOff::set);
  send(CoilCurrents::MagnitudeB::of(253));
  EXPECT_EQ(peak_with(15), 255);
  send(CoilCurrents::MagnitudeB::of(1));
  EXPECT_EQ(peak_with(0), 0) << "an offset turns no current round";
}

TEST_F(Tmc262Currents, AreNotMovedByTheHysteresisOfSpreadCycle) {
  send(ChopperConfiguration::HysteresisEnd::of(15) | ChopperConfiguration::OffTime::of(off_time));
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{1, 248}));
}

TEST_F(Tmc262Currents, HaveThePeakOfScaleSenseVoltageAndResistor) {
  // Full scale on both modules: 2.8 A RMS, 3.96 A peak. The nearest resistance of whole milliohms.
  send(DriverConfiguration::LowSenseVoltage::set);
  EXPECT_EQ(chip.sense_voltage(), 165);
  set_current_scale(31);
  EXPECT_EQ(chip.current_amplitude(), 3928);
  EXPECT_NEAR(chip.current_amplitude() / std::sqrt(2.0), 2'800, 25);
  set_current_scale(15);
  EXPECT_EQ(chip.current_amplitude(), 3928 / 2);
  send(DriverConfiguration::LowSenseVoltage::of(0));
  EXPECT_EQ(chip.sense_voltage(), 310);
  EXPECT_EQ(chip.current_amplitude(), 3690);
}

TEST(Tmc262Board, ReachesTheCurrentsOfTheVendorsTable) {
  // Chapter 9.1, CS = 31: sense resistor in mΩ, RMS in mA with VSENSE = 0 and 1. Printed to a tenth of an ampere and
  // partly for less than the full sense voltage.
  const struct {
    std::int32_t resistor;
    double high, low;
  } rows[] = {{330, 700, 350},  {270, 800, 430},   {220, 1000, 530},
              {150, 1500, 800}, {120, 1800, 1000}, {100, 2200, 1200}};
  for (const auto& row : rows) {
    Tmc262Bench bench{Tmc262(Tmc262::Board{.sense_resistor = row.resistor})};
    bench.set_current_scale(31);
    EXPECT_NEAR(bench.chip.current_amplitude() / std::sqrt(2.0), row.high, 55) << row.resistor;
    bench.send(DriverConfiguration::LowSenseVoltage::set);
    EXPECT_NEAR(bench.chip.current_amplitude() / std::sqrt(2.0), row.low, 55) << row.resistor;
  }
}

TEST_F(Tmc262UnderVoltage, TakesAllRegistersAndTheSequencer) {
  switch_bridges_on();
  set_current_scale(21);
  send(DriverConfiguration::of(ReplyFormat::stall_guard_and_current));
  pulse(up, 300);
  chip.set_supply_voltage(7'000);
  EXPECT_TRUE(chip.bridges_on());
  EXPECT_EQ(chip.microstep_position(), 300u);
  chip.set_supply_voltage(6'999);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.current_scale(), 0);
  EXPECT_EQ(chip.microstep_position(), 0u);
  chip.set_supply_voltage(24'000);
  EXPECT_FALSE(chip.bridges_on()) << "nobody wrote them again";
  EXPECT_EQ(Reply::CurrentScale::in(reply(ReplyFormat::stall_guard_and_current)), 0) << "the symptom of it";
}

TEST_F(Tmc262UnderVoltage, KeepsTheChipFromTakingWordsAndSteps) {
  chip.set_supply_voltage(0);
  switch_bridges_on();
  EXPECT_EQ(chip.transfer(tmc262::datagram(DriverControl::Resolution::of(4)), 0), 0u);
  EXPECT_EQ(chip.microsteps_per_pulse(), 0);
  pulse(up, 10);
  chip.set_supply_voltage(24'000);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.microstep_position(), 0u);
  switch_bridges_on();
  EXPECT_TRUE(chip.bridges_on());
}

TEST_F(Tmc262UnderVoltage, LetsTheStandstillCounterBeginAnew) {
  wait(2'000'000);
  chip.set_supply_voltage(0);
  wait(2'000'000);
  chip.set_supply_voltage(24'000);
  wait((1 << 20) - 1);
  EXPECT_FALSE(Reply::Standstill::is_set(reply()));
  wait(1);
  EXPECT_TRUE(Reply::Standstill::is_set(reply()));
}

TEST_F(Tmc262PowerUp, LeavesWhatIsAroundTheChip) {
  chip.set_temperature(160);
  chip.set_load_measurement(77);
  chip.set_coil_connected(Tmc262::Coil::b, false);
  Tmc262 fresh = chip;
  switch_bridges_on();
  set_current_scale(7);
  chip.set_enable_not(true);
  pulse(up, 700);
  chip.transfer(0xF0000, 5);
  chip.power_up();
  EXPECT_EQ(chip, fresh);
}

}  // namespace
}  // namespace opentmcl::twin
