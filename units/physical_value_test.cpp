#include "units/physical_value.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"

namespace opentmcl::units {
namespace {

Command command(Opcode opcode, int type, int motor = 0, std::int32_t value = 0) {
  return {static_cast<std::uint8_t>(opcode), static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(motor), value};
}

Command set_parameter(AxisParameter parameter, std::int32_t value, int motor = 0) {
  return command(Opcode::sap, static_cast<int>(parameter), motor, value);
}

// The worked examples of PD-1161 manual 6.1.
TEST(PhysicalValue, TurnsTheManualsVelocityIntoItsFrequency) {
  EXPECT_DOUBLE_EQ(51208.49609375, microsteps_per_second(1678, factory_scale(pd1161)));
}

TEST(PhysicalValue, TurnsTheManualsAccelerationIntoItsOwn) {
  EXPECT_NEAR(46566, microsteps_per_second_squared(100, factory_scale(pd1161)), 1);
}

TEST(PhysicalValue, CountsTurnsOfAMotorWithTwoHundredFullSteps) {
  PhysicalScale scale = factory_scale(pd1161);
  EXPECT_DOUBLE_EQ(60, turns_per_minute(200 * 256, scale));
  scale.microstep_resolution = 0;
  EXPECT_DOUBLE_EQ(-30, turns_per_minute(-100, scale));
  scale.full_steps_per_turn = 400;
  EXPECT_DOUBLE_EQ(-15, turns_per_minute(-100, scale));
}

TEST(PhysicalValue, IsShownLongAndShortForEachUnit) {
  struct Example {
    Unit unit;
    std::int32_t value;
    std::string number_with;
    std::string short_form;
  };
  const Example examples[] = {
      {Unit::none, 7, "7", ""},
      {Unit::microsteps, 51200, "51200 microsteps = 1 turn", "1 turn"},
      {Unit::microsteps, -50000, "-50000 microsteps = -0.97656 turns", "-0.977 turns"},
      {Unit::microsteps, 0, "0 microsteps = 0 turns", "0 turns"},
      {Unit::internal_velocity, 1000, "1000 = 30517.6 microsteps/s = 35.76 rpm", "35.8 rpm"},
      {Unit::internal_velocity, -2047, "-2047 = -62469.5 microsteps/s = -73.21 rpm", "-73.2 rpm"},
      {Unit::internal_acceleration, 1000, "1000 = 465661 microsteps/s² = 545.7 rpm/s", "546 rpm/s"},
      {Unit::current_scale, 100, "100 = 1098 mA", "1098 mA"},
      {Unit::current_scale, 255, "255 = 2800 mA", "2800 mA"},
      {Unit::current_steps, 31, "31 = 2800 mA", "2800 mA"},
      {Unit::encoder_steps, 12, "12 encoder steps", "12 encoder steps"},
      {Unit::milliseconds, 500, "500 ms", "500 ms"},
      {Unit::ten_milliseconds, int32_maximum, "2147483647 = 21474836470 ms", "21474836470 ms"},
      {Unit::tenth_volts, 240, "240 = 24.0 V", "24.0 V"},
      {Unit::degrees_celsius, -3, "-3 °C", "-3 °C"},
      {Unit::power_of_two, 8, "8 = 256", "256"},
      {Unit::power_of_two, 31, "31", ""},
      {Unit::power_of_two, -1, "-1", ""},
  };
  const PhysicalScale scale = factory_scale(pd1161);
  for (const Example& example : examples) {
    EXPECT_EQ(example.number_with, number_with_physical_value(example.unit, example.value, scale));
    EXPECT_EQ(example.short_form, short_physical_value(example.unit, example.value, scale));
  }
}

TEST(PhysicalValue, FollowsTheDivisorsAProgramSets) {
  PhysicalScale scale = factory_scale(pd1161);
  const auto speed = [&] { return short_physical_value(Unit::internal_velocity, 1000, scale); };
  EXPECT_EQ("35.8 rpm", speed());
  follow(set_parameter(AxisParameter::pulse_divisor, 2), pd1161, scale);
  EXPECT_EQ("71.5 rpm", speed());
  follow(set_parameter(AxisParameter::microstep_resolution, 7), pd1161, scale);
  EXPECT_EQ("143.1 rpm", speed());
  follow(set_parameter(AxisParameter::ramp_divisor, 8), pd1161, scale);
  EXPECT_EQ("1091 rpm/s", short_physical_value(Unit::internal_acceleration, 1000, scale));
}

RC_GTEST_PROP(PhysicalValue, IsFollowedThroughWhatTheModuleTakesOnly, (std::int32_t value, std::uint8_t type)) {
  PhysicalScale scale = factory_scale(tmcm1110);
  const std::string before = short_physical_value(Unit::internal_velocity, 1000, scale);
  const auto is_unchanged = [&] { return before == short_physical_value(Unit::internal_velocity, 1000, scale); };
  follow(set_parameter(AxisParameter::pulse_divisor, 5, 1), tmcm1110, scale);
  follow(command(Opcode::aap, static_cast<int>(AxisParameter::pulse_divisor)), tmcm1110, scale);
  follow(command(Opcode::sgp, static_cast<int>(AxisParameter::pulse_divisor), 0, 5), tmcm1110, scale);
  RC_ASSERT(is_unchanged());

  const bool is_divisor_of_velocity = type == static_cast<int>(AxisParameter::pulse_divisor) ||
                                      type == static_cast<int>(AxisParameter::microstep_resolution);
  follow(command(Opcode::sap, type, 0, value), tmcm1110, scale);
  if (!is_divisor_of_velocity) RC_ASSERT(is_unchanged());
  follow(set_parameter(AxisParameter::pulse_divisor,
                       *rc::gen::suchThat(rc::gen::arbitrary<std::int32_t>(), [](auto n) { return n < 0 || n > 13; })),
         tmcm1110, scale);
  RC_ASSERT(scale.pulse_divisor >= 0 && scale.pulse_divisor <= 13);
  RC_ASSERT(scale.microstep_resolution >= 0 && scale.microstep_resolution <= 8);
}

}  // namespace
}  // namespace opentmcl::units
