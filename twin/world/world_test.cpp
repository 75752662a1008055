#include "twin/world/world.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "twin/world/world_test_bench.hpp"

namespace opentmcl::twin {
namespace {

TEST(World, MovesTimeOnlyForward) {
  World world;
  world.advance_to(100);
  world.advance_to(50);
  EXPECT_EQ(world.now(), 100u);
  EXPECT_EQ(world.tmc429().clock(), 100u);
}

TEST(World, TurnsTheRotorByTheStepsOfTheMotionController) {
  for (const int resolution : {0, 4, 8}) {
    World world;
    start(world, resolution);
    set<tmc429::TargetPosition>(world, -1234);
    world.advance_to(2000 * millisecond);
    EXPECT_EQ(get<tmc429::ActualPosition>(world), -1234);
    EXPECT_EQ(world.rotor_angle(), -1234 * (1 << resolution));
  }
}

TEST(World, CountsEveryStepOnceWithBothEdgesOnBothSides) {
  World world;
  start(world);
  using tmc429::InterfaceConfiguration;
  write(world, InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::StepOnBothEdges::set);
  world.transfer_tmc262(tmc262::datagram(tmc262::DriverControl::StepOnBothEdges::set));
  set<tmc429::TargetPosition>(world, 777);
  world.advance_to(2000 * millisecond);
  EXPECT_EQ(world.rotor_angle(), 777);
}

TEST(World, LeavesTheRotorWhereItIsWithoutCurrent) {
  World world;
  start(world);
  world.set_driver_disable(true);
  set<tmc429::TargetPosition>(world, 10'000);
  world.advance_to(2000 * millisecond);
  EXPECT_EQ(get<tmc429::ActualPosition>(world), 10'000);
  EXPECT_EQ(world.rotor_angle(), 0);
  world.set_driver_disable(false);  // the field is now at 10000 mod 1024 = 784, that is -240
  EXPECT_EQ(world.rotor_angle(), -240);
}

TEST(World, StopsTheMotorAtASwitch) {
  World world;
  start(world);
  set<tmc429::TargetPosition>(world, 10'000);
  world.advance_to(20 * millisecond);
  world.set_right_switch(true);
  const std::int64_t angle = world.rotor_angle();
  EXPECT_GT(angle, 0);
  world.advance_to(2000 * millisecond);
  EXPECT_EQ(world.rotor_angle(), angle);
}

TEST(World, KeepsTheEepromBusyInItsOwnTime) {
  World world;
  const std::uint8_t byte = 42;
  world.write_eeprom_page(7, &byte, 1);
  EXPECT_TRUE(world.eeprom_busy());
  world.advance_to(5 * millisecond);
  EXPECT_FALSE(world.eeprom_busy());
  std::uint8_t read = 0;
  world.read_eeprom(7, &read, 1);
  EXPECT_EQ(read, 42);
}

TEST(World, StartsWithTwentyFourVoltsAtRoomTemperature) {
  World world;
  EXPECT_EQ(world.supply_voltage(), 24'000);
  EXPECT_EQ(world.temperature(), 25);
  EXPECT_EQ(world.inputs(), 0u);
  EXPECT_EQ(world.analog_input(0), 0);
}

TEST(World, TellsTheDriverItsSupply) {
  World world;
  start(world);
  world.set_supply_voltage(5'000);
  EXPECT_FALSE(world.tmc262().bridges_on());
  set<tmc429::TargetPosition>(world, 1000);
  world.advance_to(2000 * millisecond);
  EXPECT_EQ(get<tmc429::ActualPosition>(world), 1000) << "the motion controller runs from the logic supply";
  EXPECT_EQ(world.rotor_angle(), 0);
  world.power_cycle();
  world.set_supply_voltage(24'000);
  start(world);
  EXPECT_TRUE(world.tmc262().bridges_on());
}

TEST(World, TurnsTheRotorByPulsesFromTheConnector) {
  World world;
  start(world);
  world.advance_to(millisecond);
  for (int i = 0; i < 5; ++i) {
    world.pulse_step_input(false);
  }
  EXPECT_EQ(world.rotor_angle(), 5);
  world.pulse_step_input(true);
  EXPECT_EQ(world.rotor_angle(), 4);
  EXPECT_EQ(get<tmc429::ActualPosition>(world), 0);
}

TEST(World, CountsWhatTheFirmwareHasToLookAt) {
  World world;
  world.set_inputs(1);
  world.set_inputs(1);
  EXPECT_EQ(world.input_changes(), 1u);
  world.set_supply_voltage(9'000);
  world.set_supply_voltage(9'000);
  EXPECT_EQ(world.input_changes(), 2u);
}

TEST(World, TellsTheDriverItsTemperature) {
  World world;
  start(world);
  world.set_temperature(160);
  EXPECT_TRUE(tmc262::Reply::Overtemperature::is_set({world.transfer_tmc262(0)}));
}

TEST(World, ReportsPinsOnlyWhenTheyChange) {
  TraceText trace;
  World world{&trace};
  world.advance_to(16);
  world.set_outputs(5);
  world.set_outputs(5);
  world.set_inputs(1);
  EXPECT_EQ(trace.text(), "16 outputs 5\n16 inputs 1\n");
}

TEST(World, KeepsShaftAndEepromButNoRegisterWhenTheSupplyComesBack) {
  TraceText trace;
  World world{&trace};
  start(world);
  set<tmc429::TargetPosition>(world, 300);
  world.set_left_switch(true);
  const std::uint8_t byte = 42;
  world.write_eeprom_page(7, &byte, 1);
  world.advance_to(1000 * millisecond);
  world.power_cycle();
  EXPECT_EQ(world.now(), 1000 * millisecond);
  EXPECT_EQ(world.rotor_angle(), 300);
  EXPECT_EQ(world.eeprom().image()[7], 42);
  EXPECT_FALSE(world.eeprom_busy());
  EXPECT_FALSE(world.tmc262().bridges_on());
  EXPECT_EQ(world.transfer_tmc429(0x73000000), 0x17429101u);  // all at their target, the left switch still pressed
  start(world);  // the field begins at 0 again, a quarter turn and 44 microsteps away
  EXPECT_EQ(world.rotor_angle(), 0);
  set<tmc429::TargetPosition>(world, 10);
  world.advance_to(2000 * millisecond);
  EXPECT_EQ(world.rotor_angle(), 10);
  const std::string text = trace.text();
  const std::string last_line = text.substr(text.rfind('\n', text.size() - 2) + 1);
  EXPECT_GT(std::stoull(last_line), 1000 * millisecond);  // time in the trace goes on
}

/// A move forth, a reversal before its end, and a switch; time advances in pieces of at most `stride`.
std::string trace_of_a_run(Tick stride) {
  TraceText trace;
  World world{&trace};
  const auto wait_until = [&world, stride](Tick tick) {
    while (world.now() < tick) {
      world.advance_to(std::min(world.now() + stride, tick));
    }
  };
  start(world);
  set<tmc429::TargetPosition>(world, 3000);
  wait_until(50 * millisecond);
  set<tmc429::TargetPosition>(world, -3000);
  wait_until(200 * millisecond + 7);
  world.set_left_switch(true);
  wait_until(300 * millisecond);
  return trace.text();
}

RC_GTEST_PROP(World, GivesTheSameTraceAtEverySpeed, ()) {
  static const std::string in_leaps = trace_of_a_run(millisecond * 1000);
  RC_PRE(in_leaps.size() > 10'000);
  RC_ASSERT(trace_of_a_run(*rc::gen::inRange<Tick>(100, 100'000)) == in_leaps);
}

}  // namespace
}  // namespace opentmcl::twin
