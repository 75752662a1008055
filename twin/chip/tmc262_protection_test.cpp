// What the TMC262 notices of heat, shorts and broken wires, and what it does then.
#include <gtest/gtest.h>

#include "twin/chip/tmc262_test_bench.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::DriverConfiguration;
using tmc262::DriverControl;
using tmc262::Reply;
using Coil = Tmc262::Coil;

class Tmc262Protection : public testing::Test, protected Tmc262Bench {
 protected:
  Tmc262Protection() {
    switch_bridges_on();
    set_current_scale(16);
  }
  /// Two slow decay phases of 12 + 32 · 4 clocks take half of a cycle.
  static constexpr std::uint64_t chopper_cycle = 560;
};
using Tmc262Heat = Tmc262Protection;
using Tmc262Short = Tmc262Protection;
using Tmc262OpenLoad = Tmc262Protection;

TEST_F(Tmc262Heat, IsWarnedOfAndSwitchesTheBridgesOff) {
  chip.set_temperature(99);
  EXPECT_EQ(Reply::Flags::in(reply()), 0);
  chip.set_temperature(100);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::OvertemperatureWarning::mask);
  chip.set_temperature(149);
  EXPECT_TRUE(chip.bridges_on());
  chip.set_temperature(150);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::OvertemperatureWarning::mask | Reply::Overtemperature::mask);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{0, 0}));
  chip.set_temperature(149);
  EXPECT_TRUE(chip.bridges_on()) << "this silicon has no hysteresis";
}

TEST_F(Tmc262Short, ShutsItsBridgeOffAtTheThirdDetection) {
  chip.set_short_to_ground(Coil::a, true);
  EXPECT_EQ(chip.next_shut_off(), 3 * chopper_cycle);
  wait(3 * chopper_cycle - 1);
  EXPECT_TRUE(chip.bridges_on());
  EXPECT_EQ(Reply::Flags::in(reply()), 0);
  wait(1);
  EXPECT_FALSE(chip.bridge_on(Coil::a));
  EXPECT_TRUE(chip.bridge_on(Coil::b));
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{0, 248}));
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::ShortToGroundA::mask);
  EXPECT_EQ(chip.next_shut_off(), std::nullopt);
  chip.set_short_to_ground(Coil::b, true);
  wait(3 * chopper_cycle);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::ShortToGroundA::mask | Reply::ShortToGroundB::mask);
}

TEST_F(Tmc262Short, IsForgottenOnlyWhenTheDriverIsDisabled) {
  chip.set_short_to_ground(Coil::b, true);
  wait(3 * chopper_cycle);
  chip.set_short_to_ground(Coil::b, false);
  pulse_every(100, up, 10'000);
  chip.set_temperature(200);
  chip.set_temperature(20);
  send(DriverConfiguration::DisableShortProtection::set);
  EXPECT_FALSE(chip.bridge_on(Coil::b));
  switch_bridges_on();
  EXPECT_FALSE(chip.bridge_on(Coil::b)) << "the word it has already";
  switch_bridges_off();
  EXPECT_FALSE(Reply::ShortToGroundB::is_set(reply()));
  switch_bridges_on();
  EXPECT_TRUE(chip.bridges_on());
}

TEST_F(Tmc262Short, IsDetectedAgainAfterTheDriverWasEnabledByItsPin) {
  chip.set_short_to_ground(Coil::b, true);
  wait(3 * chopper_cycle);
  EXPECT_FALSE(chip.bridge_on(Coil::b));
  chip.set_enable_not(true);
  EXPECT_EQ(chip.next_shut_off(), std::nullopt);
  wait(1'000);
  chip.set_enable_not(false);
  EXPECT_TRUE(chip.bridge_on(Coil::b));
  wait(3 * chopper_cycle);
  EXPECT_FALSE(chip.bridge_on(Coil::b));
}

TEST_F(Tmc262Short, IsNotLookedForWithTheProtectionOff) {
  send(DriverConfiguration::DisableShortProtection::set);
  chip.set_short_to_ground(Coil::a, true);
  wait(100 * chopper_cycle);
  EXPECT_TRUE(chip.bridges_on());
  send(DriverConfiguration::DisableShortProtection::of(0));
  wait(3 * chopper_cycle);
  EXPECT_FALSE(chip.bridges_on());
}

TEST_F(Tmc262Short, IsDetectedThreeTimesWhateverElseGoesOn) {
  chip.set_short_to_ground(Coil::a, true);
  for (int look = 0; look < 10; ++look) {
    wait(chopper_cycle / 4);
    chip.set_temperature(20 + look);
    set_current_scale(look);
    switch_bridges_on();
    pulse(up, 300);
  }
  EXPECT_EQ(chip.next_shut_off(), 3 * chopper_cycle);
}

TEST_F(Tmc262Short, CountsDetectionsUpAndPolarityChangesDown) {
  const auto touch_twice = [this] {
    chip.set_short_to_ground(Coil::a, true);
    wait(2 * chopper_cycle);
    chip.set_short_to_ground(Coil::a, false);
  };
  const auto cycles_to_shut_off = [this]() -> std::uint64_t {
    chip.set_short_to_ground(Coil::a, true);
    const std::uint64_t cycles = (*chip.next_shut_off() - chip.clock()) / chopper_cycle;
    chip.set_short_to_ground(Coil::a, false);
    return cycles;
  };
  touch_twice();
  EXPECT_EQ(cycles_to_shut_off(), 1u);
  take_full_steps(1);  // coil B's polarity
  EXPECT_EQ(cycles_to_shut_off(), 1u);
  take_full_steps(1);
  EXPECT_EQ(cycles_to_shut_off(), 2u);
  take_full_steps(100);
  EXPECT_EQ(cycles_to_shut_off(), 3u);
}

TEST_F(Tmc262Short, CutsARunOfStepsWhereItShutsTheBridgeOff) {
  // A full step each 100 clocks; the bridge goes off after 1680 of them: 16 are measured.
  send(DriverControl::Resolution::of(tmc262::maximum_resolution));
  send(tmc262::CoolStepControl::HysteresisStart::of(1) | tmc262::CoolStepControl::CurrentDownStep::of(2));
  chip.set_short_to_ground(Coil::a, true);
  pulse_every(100, up, 1'000);
  EXPECT_EQ(chip.current_scale(), 16 - 16 / 2);
}

TEST_F(Tmc262OpenLoad, IsToldAfterAPeriodWithoutChopping) {
  send(DriverControl::Resolution::of(tmc262::maximum_resolution));
  pulse(up, 8);
  EXPECT_EQ(Reply::Flags::in(reply()), 0);
  chip.set_coil_connected(Coil::a, false);
  EXPECT_EQ(chip.coil_currents(), (Tmc262::CoilPair{0, 248}));
  EXPECT_FALSE(chip.coil_connected(Coil::a));
  pulse(up, 2);
  EXPECT_EQ(Reply::Flags::in(reply()), 0) << "it was chopped at the period's beginning";
  pulse(up, 2);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::OpenLoadA::mask);
  chip.set_coil_connected(Coil::a, true);
  pulse(up, 1);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::OpenLoadA::mask) << "until the next period ends";
  pulse(up, 1);
  EXPECT_EQ(Reply::Flags::in(reply()), 0);
}

TEST_F(Tmc262OpenLoad, IsTheSameForTheOtherCoilAndForLongRuns) {
  chip.set_coil_connected(Coil::b, false);
  pulse(up, 100'000);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::OpenLoadB::mask);
}

TEST_F(Tmc262OpenLoad, IsNotJudgedBelowASixteenthOfTheCurrentNorWithoutAny) {
  chip.set_coil_connected(Coil::a, false);
  set_current_scale(1);
  pulse(up, 10'000);
  EXPECT_EQ(Reply::Flags::in(reply()), 0);
  set_current_scale(2);
  switch_bridges_off();
  pulse(up, 10'000);
  EXPECT_EQ(Reply::Flags::in(reply()), 0);
  switch_bridges_on();
  pulse(up, 10'000);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::OpenLoadA::mask);
  set_current_scale(1);
  chip.set_coil_connected(Coil::a, true);
  pulse(up, 10'000);
  EXPECT_EQ(Reply::Flags::in(reply()), Reply::OpenLoadA::mask) << "nor is it taken back";
}

}  // namespace
}  // namespace opentmcl::twin
