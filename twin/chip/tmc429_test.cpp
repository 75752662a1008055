#include "twin/chip/tmc429.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "twin/chip/tmc429_test_bench.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::ActualPosition;
using tmc429::ActualVelocity;
using tmc429::InterfaceConfiguration;
using tmc429::Interrupts;
using tmc429::LatchedPosition;
using tmc429::MaximumAcceleration;
using tmc429::MaximumVelocity;
using tmc429::Mode;
using tmc429::RampMode;
using tmc429::Status;
using tmc429::TargetPosition;
using tmc429::TargetVelocity;

constexpr std::uint64_t millisecond = tmc429::clock_frequency / 1000;

TEST(Tmc429Bus, AnswersTheTypeWordAfterPowerOnWithAllMotorsAtTheirTarget) {
  StepRecorder steps;
  Tmc429 chip{steps};
  EXPECT_EQ(chip.transfer(0x73000000), 0x15429101u);
}

TEST(Tmc429Bus, WritesAndReadsBackTheExampleOfTheDatasheet) {
  StepRecorder steps;
  Tmc429 chip{steps};
  EXPECT_EQ(chip.transfer(0x1A000123), 0x15000000u);
  EXPECT_EQ(chip.transfer(0x1B000000), 0x15000123u);
}

TEST(Tmc429Bus, ShowsInTheStatusByteWhichMotorIsNotAtItsTarget) {
  Tmc429Bench bench;
  bench.set<TargetPosition>(1000, 0);
  EXPECT_EQ(bench.chip.transfer(0x73000000), 0x14429101u);  // as seen on hardware
}

TEST(Tmc429Bus, HasTheResetValuesOfTheDatasheet) {
  StepRecorder steps;
  Tmc429 chip{steps};
  for (unsigned motor = 0; motor < tmc429::motor_count; ++motor) {
    for (unsigned index = 0; index < 16; ++index) {
      const auto address = tmc429::address_of(static_cast<tmc429::AxisRegister>(index), motor);
      const std::uint32_t expected = index == 9 ? 0x8000 : 0;  // PMUL's top bit is always 1
      EXPECT_EQ(tmc429::data_of(chip.transfer(tmc429::read_datagram(address))), expected) << motor << ' ' << index;
    }
  }
  EXPECT_EQ(tmc429::data_of(chip.transfer(0x7F000000)), 0x000F00u);
  EXPECT_EQ(tmc429::data_of(chip.transfer(0x69000000)), 0u);
}

RC_GTEST_PROP(Tmc429Bus, KeepsWhatIsWrittenToARegisterOfAnyMotor, ()) {
  // Without those that the chip itself changes or that are read only.
  using tmc429::AxisRegister;
  const auto index = *rc::gen::element(
      AxisRegister::target_position, AxisRegister::minimum_velocity, AxisRegister::maximum_velocity,
      AxisRegister::target_velocity, AxisRegister::maximum_acceleration, AxisRegister::current_scaling,
      AxisRegister::dividers, AxisRegister::reference_tolerance, AxisRegister::microstep_counter, AxisRegister::mode);
  const auto motor = *rc::gen::inRange(0u, tmc429::motor_count);
  const auto data = *rc::gen::arbitrary<std::uint32_t>();
  StepRecorder steps;
  Tmc429 chip{steps};
  chip.transfer(tmc429::write_datagram(tmc429::address_of(index, motor), data));
  RC_ASSERT(tmc429::data_of(chip.transfer(tmc429::read_datagram(tmc429::address_of(index, motor)))) ==
            (data & Tmc429Axis::writable_bits(index)));
}

RC_GTEST_PROP(Tmc429Bus, TakesAnyDatagramsAndGoesOnRunning, ()) {
  Tmc429Bench bench;
  for (const auto datagram : *rc::gen::arbitrary<std::vector<std::uint32_t>>()) {
    bench.chip.transfer(datagram);
    bench.chip.advance(10'000);
    const std::int32_t velocity = bench.get<ActualVelocity>();
    RC_ASSERT(-2047 <= velocity && velocity <= 2047);
  }
  RC_ASSERT(bench.read<tmc429::TypeVersion>().bits == tmc429::TypeVersion::value);
}

TEST(Tmc429Bus, KeepsTheTopBitOfTheMultiplierAtOne) {
  Tmc429Bench bench;
  bench.write(tmc429::Word<tmc429::BrakingFactor>{0x006D04});
  EXPECT_EQ(bench.read<tmc429::BrakingFactor>().bits, 0x00ED04u);
}

TEST(Tmc429Bus, CountsWritesToWhatIsNotModelled) {
  Tmc429Bench bench;
  EXPECT_EQ(bench.chip.unmodelled_writes(), 0u);
  bench.chip.transfer(0x6E000001);  // an unassigned register
  EXPECT_EQ(bench.chip.unmodelled_writes(), 1u);
  bench.chip.transfer(0x7E200000);  // mot1r, for the 16-pin package
  EXPECT_EQ(bench.chip.latest_unmodelled_write(), 0x7E200000u);
  bench.chip.transfer(0x0E000000);  // a zero to read-only A_ACTUAL, as the vendor's start-up sends it
  EXPECT_EQ(bench.chip.unmodelled_writes(), 2u);
}

TEST(Tmc429Bus, StopsItsClocksInPowerDownUntilTheNextDatagram) {
  Tmc429Bench bench;
  bench.hold_velocity(1024);
  bench.chip.transfer(0x70000000);
  bench.chip.advance(10 * millisecond);
  EXPECT_TRUE(bench.steps.events.empty());
  EXPECT_EQ(bench.get<ActualPosition>(), 0);
  bench.chip.advance(10 * millisecond);
  EXPECT_NEAR(bench.get<ActualPosition>(), 2500, 1);
  EXPECT_GT(bench.steps.events.front().first_clock, 10 * millisecond);
}

TEST(Tmc429Switches, ShowTheLeftOneInTheStatusByteAndBothInTheirRegister) {
  Tmc429Bench bench;
  bench.chip.set_left_switch(true);
  EXPECT_TRUE(Status::LeftSwitch1::is_set(bench.status()));
  EXPECT_EQ(bench.read<tmc429::ReferenceSwitches>(), tmc429::ReferenceSwitches::Left1::set);
  bench.chip.set_left_switch(false);
  bench.chip.set_right_switch(true, 1);
  EXPECT_EQ(bench.read<tmc429::ReferenceSwitches>(), tmc429::ReferenceSwitches::Right2::set);
}

TEST(Tmc429Switches, IgnoreTheRightPinUnlessItIsEnabled) {
  Tmc429Bench bench;
  bench.write(InterfaceConfiguration::EnableStepDir::set);
  bench.chip.set_right_switch(true);
  EXPECT_EQ(bench.read<tmc429::ReferenceSwitches>().bits, 0u);
}

TEST(Tmc429Switches, AreActiveAtALowLevelWhenInverted) {
  Tmc429Bench bench;
  bench.write(InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::InvertSwitches::set);
  EXPECT_TRUE(Status::LeftSwitch1::is_set(bench.status()));
  bench.chip.set_left_switch(true);
  EXPECT_FALSE(Status::LeftSwitch1::is_set(bench.status()));
}

struct StopCase {
  bool left;
  std::int32_t velocity;
  std::uint32_t disable;
  bool stops;
};

class Tmc429StopSwitch : public testing::TestWithParam<StopCase> {};

TEST_P(Tmc429StopSwitch, StopsOnlyTheMotionTowardsItAndOnlyWhenEnabled) {
  const StopCase& stop = GetParam();
  Tmc429Bench bench;
  bench.write(Mode::of(RampMode::velocity) | tmc429::Word<Mode>{stop.disable});
  bench.set<MaximumVelocity>(2047);
  bench.set<MaximumAcceleration>(2047);
  bench.set<TargetVelocity>(stop.velocity);
  bench.chip.advance(millisecond);
  ASSERT_EQ(bench.get<ActualVelocity>(), stop.velocity);
  stop.left ? bench.chip.set_left_switch(true) : bench.chip.set_right_switch(true);
  EXPECT_EQ(bench.get<ActualVelocity>(), stop.stops ? 0 : stop.velocity);
  EXPECT_EQ(bench.get<TargetVelocity>(), stop.velocity);
  const std::int32_t position = bench.get<ActualPosition>();
  bench.chip.advance(millisecond);
  EXPECT_EQ(bench.get<ActualPosition>() == position, stop.stops);
}

INSTANTIATE_TEST_SUITE_P(AllCases, Tmc429StopSwitch,
                         testing::Values(StopCase{true, -500, 0, true}, StopCase{true, 500, 0, false},
                                         StopCase{false, 500, 0, true}, StopCase{false, -500, 0, false},
                                         StopCase{true, -500, Mode::DisableLeftStop::set.bits, false},
                                         StopCase{true, -500, Mode::DisableRightStop::set.bits, true},
                                         StopCase{false, 500, Mode::DisableRightStop::set.bits, false},
                                         StopCase{true, -500, Mode::ReferenceIsRight::set.bits, true}));

TEST(Tmc429Switches, LetTheMotorRunOnToItsTargetWhenTheyAreReleased) {
  Tmc429Bench bench;
  bench.set<tmc429::MinimumVelocity>(1);
  bench.set<MaximumVelocity>(1000);
  bench.set<MaximumAcceleration>(500);
  bench.write(tmc429::BrakingFactor::Multiplier::of(237) | tmc429::BrakingFactor::Divisor::of(4));
  bench.set_dividers(2, 3);
  bench.set<TargetPosition>(-5000);
  bench.chip.advance(20 * millisecond);
  bench.chip.set_left_switch(true);
  const std::int32_t stopped_at = bench.get<ActualPosition>();
  bench.chip.advance(1000 * millisecond);
  EXPECT_EQ(bench.get<ActualPosition>(), stopped_at);
  EXPECT_EQ(bench.get<TargetPosition>(), -5000);
  bench.chip.set_left_switch(false);
  bench.chip.advance(1000 * millisecond);
  EXPECT_EQ(bench.get<ActualPosition>(), -5000);
}

TEST(Tmc429Switches, StopWithTheAccelerationWhenAskedForASoftStop) {
  Tmc429Bench bench;
  bench.write(Mode::of(RampMode::velocity) | Mode::SoftStop::set);
  bench.set_dividers(3, 7);
  bench.set<MaximumVelocity>(2047);
  bench.set<MaximumAcceleration>(100);
  bench.set<TargetVelocity>(1000);
  bench.chip.advance(2000 * millisecond);
  bench.chip.set_right_switch(true);
  EXPECT_EQ(bench.get<ActualVelocity>(), 1000);
  bench.chip.advance(millisecond);
  EXPECT_NEAR(bench.get<ActualVelocity>(), 1000 - 100.0 / 256 * 3.906, 1.0);
  bench.chip.advance(1000 * millisecond);
  EXPECT_EQ(bench.get<ActualVelocity>(), 0);
}

TEST(Tmc429Switches, DoNotStopWithinTheReferenceTolerance) {
  Tmc429Bench bench;
  bench.set<tmc429::ReferenceTolerance>(100);
  bench.chip.set_right_switch(true);
  bench.hold_velocity(100);
  bench.chip.advance(100 * millisecond);
  EXPECT_EQ(bench.get<ActualPosition>(), 101);
  EXPECT_EQ(bench.get<ActualVelocity>(), 0);
}

TEST(Tmc429Latch, TakesThePositionAtTheNextEdgeOfTheReferenceSwitchAndDisarms) {
  Tmc429Bench bench;
  bench.write(Mode::of(RampMode::hold) | Mode::DisableLeftStop::set);
  bench.set<LatchedPosition>(0);
  EXPECT_TRUE(Mode::LatchArmed::is_set(bench.read<Mode>()));
  bench.chip.set_left_switch(true);  // at rest: no edge counts
  bench.chip.set_left_switch(false);
  EXPECT_TRUE(Mode::LatchArmed::is_set(bench.read<Mode>()));
  bench.set<ActualVelocity>(-1024);
  bench.chip.advance(10 * millisecond);
  const std::int32_t edge = bench.get<ActualPosition>();
  bench.chip.set_right_switch(true);  // not the reference switch
  bench.chip.set_left_switch(true);
  bench.chip.advance(10 * millisecond);
  EXPECT_EQ(bench.get<LatchedPosition>(), edge);
  EXPECT_LT(edge, -2000);
  EXPECT_FALSE(Mode::LatchArmed::is_set(bench.read<Mode>()));
}

TEST(Tmc429Latch, FollowsTheRightSwitchWhenThatIsTheReference) {
  Tmc429Bench bench;
  bench.write(Mode::of(RampMode::hold) | Mode::ReferenceIsRight::set);
  bench.set<LatchedPosition>(0);
  bench.set<ActualVelocity>(1024);
  bench.chip.advance(10 * millisecond);
  bench.chip.set_right_switch(true);
  EXPECT_EQ(bench.get<LatchedPosition>(), bench.get<ActualPosition>());
  EXPECT_GT(bench.get<LatchedPosition>(), 2000);
}

TEST(Tmc429Interrupts, AreSetOnlyWhileTheirMaskIsOne) {
  Tmc429Bench bench;
  bench.chip.set_left_switch(true);
  EXPECT_EQ(bench.flags().bits, 0u);
  bench.write(tmc429::Word<Interrupts>{0x1000});
  bench.chip.set_left_switch(false);
  EXPECT_EQ(bench.flags(), Interrupts::LeftSwitchFalls::set);
  EXPECT_FALSE(bench.chip.interrupt_pin());
  EXPECT_TRUE(Status::Interrupt::is_set(bench.status()));
  bench.write(tmc429::Word<Interrupts>{0});
  EXPECT_EQ(bench.flags().bits, 0u);
  EXPECT_TRUE(bench.chip.interrupt_pin());
}

TEST(Tmc429Interrupts, AreClearedByWritingOneAndLeftAloneByWritingZero) {
  Tmc429Bench bench;
  bench.write(tmc429::Word<Interrupts>{0xFF00});
  bench.chip.set_left_switch(true);
  bench.chip.set_right_switch(true);
  const auto both = Interrupts::LeftSwitchRises::set | Interrupts::RightSwitchRises::set;
  ASSERT_EQ(Interrupts::Flags::in(bench.read<Interrupts>()) & static_cast<std::int32_t>(both.bits),
            static_cast<std::int32_t>(both.bits));
  bench.write(tmc429::Word<Interrupts>{0xFF00} | Interrupts::LeftSwitchRises::set);
  EXPECT_FALSE(Interrupts::LeftSwitchRises::is_set(bench.flags()));
  EXPECT_TRUE(Interrupts::RightSwitchRises::is_set(bench.flags()));
}

TEST(Tmc429Interrupts, TellTheEndOfAPositioningOnce) {
  Tmc429Bench bench;
  bench.write(tmc429::Word<Interrupts>{0x0100});
  bench.hold_velocity(1024);
  bench.set<TargetPosition>(10);
  EXPECT_EQ(bench.flags().bits, 0u);
  bench.chip.advance(millisecond);
  EXPECT_EQ(bench.flags(), Interrupts::PositionEnd::set);
  bench.write(tmc429::Word<Interrupts>{0x0101});
  bench.chip.advance(millisecond);
  EXPECT_EQ(bench.flags().bits, 0u);
}

TEST(Tmc429Interrupts, TellThatASwitchStoppedTheMotion) {
  Tmc429Bench bench;
  bench.write(tmc429::Word<Interrupts>{0x0800});
  bench.chip.set_left_switch(true);  // no motion, no stop
  EXPECT_EQ(bench.flags().bits, 0u);
  bench.chip.set_left_switch(false);
  bench.hold_velocity(-100);
  bench.chip.advance(millisecond);
  bench.chip.set_left_switch(true);
  EXPECT_EQ(bench.flags(), Interrupts::Stop::set);
}

TEST(Tmc429Interrupts, TellAReferenceSwitchThatIsNotWhereItShouldBe) {
  Tmc429Bench bench;
  bench.write(tmc429::Word<Interrupts>{0x0600});
  bench.hold_velocity(1024);
  bench.set<ActualPosition>(-50);
  bench.chip.advance(10 * millisecond);  // passes 0 while the switch is not active
  EXPECT_EQ(bench.flags(), Interrupts::ReferenceMissed::set);
  bench.chip.set_left_switch(true);  // active far away from 0
  EXPECT_EQ(bench.flags(), Interrupts::ReferenceMissed::set | Interrupts::ReferenceWrong::set);
}

TEST(Tmc429Interrupts, TellThatTheComparePositionWasMet) {
  Tmc429Bench bench;
  using Compare = tmc429::ComparePositionInterrupt;
  bench.set<tmc429::ComparePosition>(20);
  bench.write(Compare::Enabled::set);
  bench.hold_velocity(1024);
  bench.chip.advance(millisecond);
  EXPECT_TRUE(Compare::Occurred::is_set(bench.read<Compare>()));
  EXPECT_FALSE(bench.chip.interrupt_pin());
  bench.write(Compare::Enabled::set | Compare::Occurred::set);
  EXPECT_TRUE(bench.chip.interrupt_pin());
  EXPECT_FALSE(bench.chip.position_compare_output());
  bench.set<tmc429::ComparePosition>(bench.get<ActualPosition>());
  EXPECT_TRUE(bench.chip.position_compare_output());
}

TEST(Tmc429Outputs, StayHighWhileTheChipServesSpiDrivers) {
  StepRecorder steps;
  Tmc429 chip{steps};
  EXPECT_TRUE(chip.step_pin());
  EXPECT_TRUE(chip.direction_pin());
  chip.transfer(tmc429::write_datagram(Mode::of(RampMode::hold)));
  chip.transfer(tmc429::write_datagram(ActualVelocity::Value::of(1000)));
  chip.advance(10 * millisecond);
  EXPECT_TRUE(steps.events.empty());
  EXPECT_GT(tmc429::data_of(chip.transfer(tmc429::read_datagram<ActualPosition>())), 0u);
}

TEST(Tmc429Outputs, GiveAPulseOfTheSetLengthForEveryStep) {
  Tmc429Bench bench;
  bench.write(tmc429::GlobalParameters::StepPulseLength::of(3));  // 64 clocks
  bench.hold_velocity(2047);
  bench.set_dividers(3, 0);
  while (bench.steps.events.empty()) {
    bench.chip.advance(1);
  }
  EXPECT_EQ(bench.steps.events[0].signal, StepSignal::pulse);
  EXPECT_EQ(bench.steps.events[0].first_clock, bench.chip.clock());
  EXPECT_TRUE(bench.chip.step_pin());
  bench.chip.advance(63);
  EXPECT_TRUE(bench.chip.step_pin());
  bench.chip.advance(1);
  EXPECT_FALSE(bench.chip.step_pin());
}

TEST(Tmc429Outputs, TurnTheDirectionOnePulseLengthBeforeTheStep) {
  Tmc429Bench bench;
  bench.write(tmc429::GlobalParameters::StepPulseLength::of(1));  // 32 clocks
  bench.hold_velocity(-100);
  while (bench.get<ActualPosition>() == 0) {
    bench.chip.advance(1);
  }
  const std::uint64_t reversal = bench.chip.clock();
  EXPECT_TRUE(bench.chip.direction_pin());
  EXPECT_TRUE(bench.steps.events.empty());
  bench.chip.advance(100);
  ASSERT_EQ(bench.steps.events.size(), 1u);
  EXPECT_EQ(bench.steps.events[0].first_clock, reversal + 32);
  EXPECT_TRUE(bench.steps.events[0].direction);
}

TEST(Tmc429Outputs, ToggleStepWhenBothEdgesCount) {
  Tmc429Bench bench;
  bench.write(InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::StepOnBothEdges::set |
              InterfaceConfiguration::InvertDirection::set);
  bench.hold_velocity(1024);
  bench.chip.advance(millisecond);
  ASSERT_GT(bench.steps.events.size(), 10u);
  for (std::size_t i = 0; i < bench.steps.events.size(); ++i) {
    EXPECT_EQ(bench.steps.events[i].signal, i % 2 == 0 ? StepSignal::rising : StepSignal::falling);
    EXPECT_TRUE(bench.steps.events[i].direction);
  }
}

}  // namespace
}  // namespace opentmcl::twin
