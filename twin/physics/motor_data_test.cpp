#include "twin/physics/motor_data.hpp"

#include <gtest/gtest.h>

namespace opentmcl::twin {
namespace {

TEST(MotorData, HasTheMotorsOfBothFlangeSizes) {
  EXPECT_EQ(motors().size(), 8U);
  for (const MotorData& motor : motors()) {
    EXPECT_EQ(find_motor(motor.name), &motor);
    EXPECT_FALSE(motor.source.empty()) << motor.name;
  }
  EXPECT_EQ(find_motor("QSH5718"), nullptr);
}

TEST(MotorData, StartsWithTheDefaultMotorOfTheModules) {
  EXPECT_EQ(motors().front().name, "QSH5718-41-28-055");
}

// facts of the manuals: holding torque over the peak of the rated current
TEST(MotorData, DerivesTheTorqueConstant) {
  EXPECT_NEAR(find_motor("QSH5718-41-28-055")->torque_constant(), 0.139, 0.0005);
  EXPECT_NEAR(find_motor("QSH5718-51-28-101")->torque_constant(), 0.255, 0.0005);
  EXPECT_NEAR(find_motor("QSH6018-86-28-310")->torque_constant(), 0.783, 0.0005);
}

TEST(MotorData, FillsInWhatIsAssumedForAll) {
  for (const MotorData& motor : motors()) {
    EXPECT_EQ(motor.coulomb_friction, 0.008) << motor.name;
    EXPECT_EQ(motor.stall_guard_gain, 3) << motor.name;
  }
}

}  // namespace
}  // namespace opentmcl::twin
