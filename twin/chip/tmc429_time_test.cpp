// The TMC429 model does the same however time is cut, at whatever moment registers and switches change.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "twin/chip/dice.hpp"
#include "twin/chip/tmc429.hpp"
#include "twin/chip/tmc429_test_bench.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::AxisRegister;
using tmc429::Datagram;
using tmc429::InterfaceConfiguration;
using tmc429::RampMode;

/// Runs that follow one another in the same direction, joined.
std::vector<StepRun> joined(const std::vector<StepRun>& runs, unsigned motor) {
  std::vector<StepRun> result;
  for (const StepRun& run : runs) {
    if (run.motor != motor) {
      continue;
    }
    if (!result.empty() && result.back().direction == run.direction) {
      result.back().count += run.count;
      result.back().last_clock = run.last_clock;
    } else {
      result.push_back(run);
    }
  }
  return result;
}

/// A chip and a way to let time pass.
class Specimen {
 public:
  explicit Specimen(StepDetail detail) {
    chip_.set_detail(detail);
    chip_.transfer(tmc429::write_datagram(InterfaceConfiguration::EnableStepDir::set |
                                          InterfaceConfiguration::EnableRightSwitches::set));
  }

  Tmc429& chip() { return chip_; }
  std::vector<StepRun>& runs() { return steps_.events; }

 private:
  StepRecorder steps_;
  Tmc429 chip_{steps_};
};

/// The same three chips in three kinds of time.
class ThreeTimes {
 public:
  explicit ThreeTimes(std::uint64_t seed) : dice_(seed) {
    for (unsigned motor = 0; motor < tmc429::motor_count; ++motor) {
      start(motor);
    }
  }

  void one_action() {
    act();
    const std::uint64_t clocks = dice_.of_any_length(18);
    leaping_.chip().advance(clocks);
    creep(clocks);
    halt(clocks);
    compare();
  }

 private:
  void write(std::uint32_t datagram) {
    const std::uint32_t reply = leaping_.chip().transfer(datagram);
    ASSERT_EQ(creeping_.chip().transfer(datagram), reply);
    ASSERT_EQ(halting_.chip().transfer(datagram), reply);
  }

  template <class Register>
  void write(tmc429::Word<Register> word, unsigned motor = 0) {
    write(tmc429::write_datagram(word, motor));
  }

  void start(unsigned motor) {
    write(tmc429::Mode::of(RampMode::ramp), motor);
    write(tmc429::MinimumVelocity::Value::of(1), motor);
    write(tmc429::MaximumVelocity::Value::of(dice_.between(1, 2047)), motor);
    write(tmc429::MaximumAcceleration::Value::of(dice_.between(1, 2047)), motor);
    write(tmc429::BrakingFactor::Multiplier::of(237) | tmc429::BrakingFactor::Divisor::of(dice_.between(2, 8)), motor);
    write(tmc429::Dividers::Pulse::of(dice_.between(0, 5)) | tmc429::Dividers::Ramp::of(dice_.between(0, 7)), motor);
    write(tmc429::Word<tmc429::Interrupts>{dice_.once_in(2) ? 0xFF00u : 0u}, motor);
    write(tmc429::ReferenceTolerance::Value::of(dice_.between(0, 300)), motor);
  }

  /// Something that firmware, a person or a machine may do.
  void act() {
    const auto motor = dice_.once_in(3) ? static_cast<unsigned>(dice_.below(3)) : 0;
    const bool level = dice_.once_in(2);
    switch (dice_.below(20)) {
      case 0:
      case 1:
        return each([&](Tmc429& chip) { chip.set_left_switch(level, motor); });
      case 2:
      case 3:
        return each([&](Tmc429& chip) { chip.set_right_switch(level, motor); });
      case 4:
      case 5:
      case 6:
        return write(tmc429::TargetPosition::Value::of(dice_.between(-700, 700)), motor);
      case 7:
        return write(tmc429::ActualPosition::Value::of(dice_.between(-700, 700)), motor);
      case 8:
      case 9:
        return write(tmc429::TargetVelocity::Value::of(dice_.between(-2047, 2047)), motor);
      case 10:
        return write(tmc429::ActualVelocity::Value::of(dice_.between(-2047, 2047)), motor);
      case 11:
        return write(tmc429::Word<tmc429::Mode>{static_cast<std::uint32_t>(dice_.below(0x1000))}, motor);
      case 12:
        return write(tmc429::Mode::of(static_cast<RampMode>(dice_.below(4))), motor);
      case 13:
        return write(tmc429::Word<tmc429::Interrupts>{static_cast<std::uint32_t>(dice_.below(0x10000))}, motor);
      case 14:
        write(tmc429::ComparePosition::Value::of(dice_.between(0, 300)));
        return write(tmc429::ComparePositionInterrupt::Enabled::of(!dice_.once_in(4)) |
                     tmc429::ComparePositionInterrupt::Occurred::of(dice_.once_in(2)));
      case 15:
        return write(InterfaceConfiguration::EnableStepDir::of(!dice_.once_in(8)) |
                     InterfaceConfiguration::EnableRightSwitches::set |
                     InterfaceConfiguration::StepOnBothEdges::of(dice_.once_in(2)) |
                     InterfaceConfiguration::InvertStep::of(dice_.once_in(2)) |
                     InterfaceConfiguration::InvertDirection::of(dice_.once_in(4)) |
                     InterfaceConfiguration::InvertSwitches::of(dice_.once_in(4)) |
                     InterfaceConfiguration::ComparedMotor::of(dice_.between(0, 3)));
      case 16:
        return write(tmc429::GlobalParameters::StepPulseLength::of(dice_.between(0, 15)));
      case 17:
        return write(tmc429::write_datagram(tmc429::address_of(AxisRegister::latched_position, motor), 0));
      case 18:
        if (dice_.once_in(4)) {
          write(tmc429::write_datagram(tmc429::address_of(tmc429::CommonRegister::power_down), 0));
        }
        return;
      default:
        return start(motor);
    }
  }

  template <class Action>
  void each(Action action) {
    for (Specimen* specimen : {&leaping_, &creeping_, &halting_}) {
      action(specimen->chip());
    }
  }

  /// In parts of less than a tick up to many.
  void creep(std::uint64_t clocks) {
    const std::uint64_t longest = 1 + dice_.of_any_length(10);
    while (clocks > 0) {
      const std::uint64_t part = std::min(clocks, 1 + dice_.below(longest + 30));
      creeping_.chip().advance(part);
      clocks -= part;
    }
  }

  /// With pauses where the velocity begins to change, and at random.
  void halt(std::uint64_t clocks) {
    const std::uint64_t end = halting_.chip().clock() + clocks;
    while (halting_.chip().clock() < end) {
      if (dice_.once_in(2)) {
        halting_.chip().advance_until_change(end - halting_.chip().clock());
      } else {
        halting_.chip().advance(dice_.below(end - halting_.chip().clock() + 1));
      }
    }
  }

  void compare() {
    for (unsigned address = 0; address < 64; ++address) {
      const std::uint32_t read = (Datagram::Address::of(static_cast<std::int32_t>(address)) | Datagram::Read::set).bits;
      const std::uint32_t reply = leaping_.chip().transfer(read);
      ASSERT_EQ(creeping_.chip().transfer(read), reply) << "address " << address;
      ASSERT_EQ(halting_.chip().transfer(read), reply) << "address " << address;
    }
    for (unsigned motor = 0; motor < tmc429::motor_count; ++motor) {
      const Tmc429::Motion motion = leaping_.chip().motion(motor);
      ASSERT_EQ(creeping_.chip().motion(motor), motion);
      ASSERT_EQ(halting_.chip().motion(motor), motion);
      ASSERT_EQ(creeping_.chip().step_pin(motor), leaping_.chip().step_pin(motor));
      ASSERT_EQ(creeping_.chip().direction_pin(motor), leaping_.chip().direction_pin(motor));
      const std::vector<StepRun> runs = joined(leaping_.runs(), motor);
      ASSERT_EQ(joined(creeping_.runs(), motor), runs);
      ASSERT_EQ(joined(halting_.runs(), motor), runs);
    }
    for (Specimen* specimen : {&leaping_, &creeping_, &halting_}) {
      specimen->runs().clear();
    }
  }

  Dice dice_;
  Specimen leaping_{StepDetail::runs};
  Specimen creeping_{StepDetail::edges};
  Specimen halting_{StepDetail::runs};
};

class Tmc429Cuts : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Tmc429Cuts, OfTimeChangeNothing) {
  Dice seeds{GetParam()};
  for (int runs = 0; runs < 200 && !HasFatalFailure(); ++runs) {
    ThreeTimes times{seeds.below(1u << 31)};
    for (int actions = 0; actions < 60 && !HasFatalFailure(); ++actions) {
      times.one_action();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Tmc429Cuts, testing::Range<std::uint64_t>(0, 5));

/// A move of `distance` steps with a ramp of some ten milliseconds.
void start_move(Tmc429& chip, std::int32_t distance) {
  chip.transfer(tmc429::write_datagram(tmc429::MinimumVelocity::Value::of(1)));
  chip.transfer(tmc429::write_datagram(tmc429::MaximumVelocity::Value::of(1000)));
  chip.transfer(tmc429::write_datagram(tmc429::MaximumAcceleration::Value::of(500)));
  chip.transfer(
      tmc429::write_datagram(tmc429::BrakingFactor::Multiplier::of(237) | tmc429::BrakingFactor::Divisor::of(4)));
  chip.transfer(tmc429::write_datagram(tmc429::Dividers::Pulse::of(2) | tmc429::Dividers::Ramp::of(3)));
  chip.transfer(tmc429::write_datagram(tmc429::TargetPosition::Value::of(distance)));
}

TEST(Tmc429Leap, TellsAMoveInOneRun) {
  Specimen specimen{StepDetail::runs};
  start_move(specimen.chip(), 10'000);
  specimen.chip().advance(2 * tmc429::clock_frequency);
  ASSERT_EQ(specimen.runs().size(), 1u);
  EXPECT_EQ(specimen.runs()[0].count, 10'000u);
}

TEST(Tmc429Leap, ListsTheClockOfEveryStepThatLeavesTheChip) {
  Specimen listing{StepDetail::runs};
  Specimen telling{StepDetail::edges};
  std::vector<std::uint64_t> clocks;
  for (const std::int32_t target : {3000, -200, -201, -200}) {  // with reversals, each delaying a step
    for (Specimen* specimen : {&listing, &telling}) {
      start_move(specimen->chip(), target);
    }
    listing.chip().advance_listing(tmc429::clock_frequency, clocks);
    telling.chip().advance(tmc429::clock_frequency);
  }
  ASSERT_EQ(telling.runs().size(), 3000u + 3200 + 1 + 1);
  ASSERT_EQ(clocks.size(), telling.runs().size());
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    ASSERT_EQ(clocks[i], telling.runs()[i].first_clock) << i;
  }
}

TEST(Tmc429Leap, ListsNothingWhileTheChipServesSpiDrivers) {
  Specimen specimen{StepDetail::runs};
  specimen.chip().transfer(tmc429::write_datagram(tmc429::Word<InterfaceConfiguration>{}));
  start_move(specimen.chip(), 100);
  std::vector<std::uint64_t> clocks;
  specimen.chip().advance_listing(tmc429::clock_frequency, clocks);
  EXPECT_TRUE(clocks.empty());
  EXPECT_EQ(specimen.chip().motion().position, 100);
}

TEST(Tmc429Leap, EndsOnTheTickThatBeginsToChangeAConstantVelocity) {
  Specimen specimen{StepDetail::runs};
  Tmc429& chip = specimen.chip();
  chip.advance(12'345);
  start_move(chip, 10'000);
  constexpr std::uint64_t ramp_period = 32u << 3;

  // The start: the first ramp tick adds A_MAX.
  ASSERT_TRUE(chip.advance_until_change(tmc429::clock_frequency));
  EXPECT_EQ(chip.clock(), (12'345 / ramp_period + 1) * ramp_period);
  EXPECT_EQ(chip.motion().velocity_with_fraction, 500);

  // It accelerates for 512 ramp ticks; that is not the begin of a change.
  ASSERT_FALSE(chip.advance_until_change(600 * ramp_period));
  EXPECT_EQ(chip.motion().velocity_with_fraction, 1000 * 256);

  // The braking begins.
  ASSERT_TRUE(chip.advance_until_change(tmc429::clock_frequency));
  EXPECT_LT(chip.motion().velocity_with_fraction, 1000 * 256);
  EXPECT_GE(chip.motion().velocity_with_fraction, 1000 * 256 - 500);

  // At rest nothing ever changes.
  chip.advance(tmc429::clock_frequency);
  ASSERT_EQ(chip.motion().position, 10'000);
  EXPECT_FALSE(chip.advance_until_change(tmc429::clock_frequency));
}

TEST(Tmc429Leap, EndsOnTheStepThatStopsAtTheTarget) {
  Specimen specimen{StepDetail::runs};
  Tmc429& chip = specimen.chip();
  start_move(chip, 10);
  chip.transfer(tmc429::write_datagram(tmc429::MinimumVelocity::Value::of(50)));
  chip.transfer(tmc429::write_datagram(tmc429::MaximumVelocity::Value::of(50)));
  chip.advance(tmc429::clock_frequency / 500);
  ASSERT_EQ(chip.motion().velocity_with_fraction, 50 * 256);
  ASSERT_TRUE(chip.advance_until_change(tmc429::clock_frequency));
  EXPECT_EQ(chip.motion().velocity_with_fraction, 0);
  EXPECT_EQ(chip.motion().position, 10);
  ASSERT_EQ(specimen.runs().back().last_clock, chip.clock());
}

}  // namespace
}  // namespace opentmcl::twin
