#include "twin/physics/torque_table.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace opentmcl::twin {
namespace {

constexpr double turns_per_second_and_rpm = MotorData::pole_pairs / 60;

std::shared_ptr<const TorqueTable> table_of(const MotorData& motor, double supply) {
  TorqueTables tables;
  return tables.table(motor, TorqueTables::key(supply, motor.rated_amplitude(), 20));
}

const MotorData& motor() {
  return *find_motor("QSH5718-41-28-055");
}

double friction_at(double rpm) {
  return motor().coulomb_friction + motor().viscous_friction * rpm / 60 * radians_per_turn;
}

// Pull-out torque at the shaft of the motor of 41 mm at 24 V, as the averaged model gave it when this was prototyped.
TEST(TorqueTable, HasThePullOutTorqueOverSpeed) {
  const auto table = table_of(motor(), 24);
  struct Row {
    double rpm;
    double torque;
  };
  for (const auto& [rpm, torque] : {Row{200, 0.538}, {600, 0.529}, {1000, 0.474}, {1500, 0.322}, {2000, 0.223}}) {
    EXPECT_NEAR(table->pull_out_torque(rpm * turns_per_second_and_rpm) - friction_at(rpm), torque, 0.004) << rpm;
  }
}

TEST(TorqueTable, FollowsTheSineOfTheLoadAngleWhereTheSupplySuffices) {
  const auto table = table_of(motor(), 24);
  const double most = motor().holding_torque;
  for (const double share : {-0.9, -0.3, 0.0, 0.5, 0.95}) {
    const TorqueTable::Point point = table->at(100, share * most);
    EXPECT_FALSE(point.saturated);
    EXPECT_NEAR(point.load_angle, std::asin(share), 2e-4);
    EXPECT_NEAR(point.stiffness, most * std::sqrt(1 - share * share), 1e-4);
    EXPECT_NEAR(point.pull_out_torque, most, 1e-4);  // the amplitude is rounded to 1 mA
  }
}

TEST(TorqueTable, GivesMoreTorqueAtSpeedWithMoreSupply) {
  for (const MotorData& each : motors()) {
    const double speed = 1000 * turns_per_second_and_rpm;
    EXPECT_GT(table_of(each, 48)->pull_out_torque(speed), 1.05 * table_of(each, 24)->pull_out_torque(speed))
        << each.name;
  }
}

RC_GTEST_PROP(TorqueTable, IsMirroredForTheOtherDirection, ()) {
  static const auto table = table_of(motor(), 24);
  const double speed = *rc::gen::inRange(1, 2000);
  const double torque = *rc::gen::inRange(-40, 40) * 1e-2;
  const TorqueTable::Point forward = table->at(speed, torque);
  const TorqueTable::Point backward = table->at(-speed, -torque);
  RC_ASSERT(forward.load_angle == -backward.load_angle);
  RC_ASSERT(forward.stiffness == backward.stiffness);
  RC_ASSERT(forward.pull_out_torque == backward.pull_out_torque);
}

RC_GTEST_PROP(TorqueTable, LeadsMoreUnderMoreTorque, ()) {
  static const auto table = table_of(*find_motor("QSH6018-86-28-310"), 24);
  const double speed = *rc::gen::inRange(0, 600);
  const double most = table->pull_out_torque(speed);
  const double share = *rc::gen::inRange(-90, 89) * 1e-2;
  RC_ASSERT(table->at(speed, share * most).load_angle < table->at(speed, (share + 0.01) * most).load_angle);
}

// Whatever was asked before, and in whatever order.
TEST(TorqueTable, GivesTheSameInAnyOrder) {
  const auto upwards = table_of(motor(), 24);
  const auto downwards = table_of(motor(), 24);
  std::vector<double> first;
  for (int speed = 10; speed < 3000; speed += 130) first.push_back(upwards->at(speed, 0.2).load_angle);
  std::vector<double> second;
  for (int speed = 10; speed < 3000; speed += 130) second.push_back(0);
  for (std::size_t i = second.size(); i-- > 0;)
    second[i] = downwards->at(10 + 130 * static_cast<double>(i), 0.2).load_angle;
  EXPECT_EQ(first, second);
}

TEST(TorqueTables, HasOneTableForConditionsThatRoundToTheSame) {
  TorqueTables tables;
  const auto table = [&](double supply, double amplitude, double temperature) {
    return tables.table(motor(), TorqueTables::key(supply, amplitude, temperature));
  };
  EXPECT_EQ(table(24, 3.96, 25), table(24.1, 3.9604, 22));
  EXPECT_NE(table(24, 3.96, 25), table(24.5, 3.96, 25));
  EXPECT_NE(table(24, 3.96, 25), table(24, 3.9, 25));
  EXPECT_NE(table(24, 3.96, 24), table(24, 3.96, 36));
}

TEST(TorqueTables, ForgetsOnlyTablesThatNobodyHolds) {
  TorqueTables tables;
  const auto held = tables.table(motor(), TorqueTables::key(24, 1, 20));
  for (int milliamperes = 1; milliamperes < 2000; ++milliamperes)
    tables.table(motor(), TorqueTables::key(24, 2 + milliamperes * 1e-3, 20));
  EXPECT_LT(tables.size(), 300U);
  EXPECT_EQ(tables.table(motor(), TorqueTables::key(24, 1, 20)), held);
}

// With currents that follow at once a swing dies down with half of all that is proportional to speed, over the inertia.
TEST(AveragedMotor, SwingsDieDownAsTheDampingSaysWhereTheSupplySuffices) {
  const MotorData& data = motor();
  const AveragedMotor averaged({.torque_constant = data.torque_constant(),
                                .inductance = data.winding_inductance,
                                .resistance = data.winding_resistance,
                                .supply = 24,
                                .amplitude = data.rated_amplitude()},
                               100 * radians_per_turn);
  constexpr double inertia = 2.2e-5;
  const double drag = data.viscous_friction + data.eddy_damping;
  const double decay = drag / (2 * inertia);
  const AveragedMotor::Response response = averaged.response(averaged.at(0.3), 0.3);
  EXPECT_TRUE(swings_die_down(response, inertia, drag, 0.9 * decay));
  EXPECT_FALSE(swings_die_down(response, inertia, drag, 1.1 * decay));
}

// The motor of 51 mm loses step at 700 to 1000 rpm under half of the load it could carry there: mid-band instability.
TEST(AveragedMotor, SwingsGrowInTheMiddleOfTheSpeedsOfALargeMotor) {
  const MotorData& data = *find_motor("QSH5718-51-28-101");
  const auto table = table_of(data, 24);
  const double inertia = data.rotor_inertia + 1e-5;
  const double drag = data.viscous_friction + data.eddy_damping;
  const auto stable = [&](double rpm, double share) {
    const double speed = rpm * turns_per_second_and_rpm;
    const TorqueTable::Point point = table->at(speed, share * table->pull_out_torque(speed));
    return !point.saturated || swings_die_down(point.response, inertia, drag, 0);
  };
  EXPECT_TRUE(stable(200, 0.5));
  EXPECT_FALSE(stable(700, 0.6));
  EXPECT_FALSE(stable(900, 0.6));
  EXPECT_TRUE(stable(700, 0.0));
}

}  // namespace
}  // namespace opentmcl::twin
