#include "client/units.hpp"

#include <gtest/gtest.h>

namespace opentmcl::client {

// The worked examples of PD-1161 manual 6.1.
TEST(Units, TurnTheManualsVelocityIntoItsFrequency) {
  EXPECT_DOUBLE_EQ(51208.49609375, microsteps_per_second(1678, 3));
}

TEST(Units, TurnTheManualsAccelerationIntoItsOwn) {
  EXPECT_NEAR(46566, microsteps_per_second_squared(100, 3, 7), 1);
}

TEST(Units, CountTurnsOfAMotorWithTwoHundredFullSteps) {
  EXPECT_DOUBLE_EQ(60, turns_per_minute(200 * 256, 8));
  EXPECT_DOUBLE_EQ(-30, turns_per_minute(-100, 0));
}

}  // namespace opentmcl::client
