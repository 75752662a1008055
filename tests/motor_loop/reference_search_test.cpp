// Every mode of the reference search on every machine, turned by a motor that swings, lags behind its field and has a
// load to pull: still the zero is within one full step of where the dimensions of the machine say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <variant>

#include "tests/machines/search_trial.hpp"
#include "twin/physics/torque_table.hpp"

namespace opentmcl::tests {
namespace {

constexpr int searches_of_each_mode = 23;

/// A velocity of 1, full steps a second: microsteps_per_millisecond in other words.
constexpr double full_steps_per_second = microsteps_per_millisecond * 1000.0 / microsteps_per_full_step;
/// An acceleration of 1, rad/s²: (16·10⁶)² / 2^(2 + 4 + 29) steps/s² of 16 a full step (PD-1161 manual 6.1.2).
constexpr double radians_per_second_squared = 256e12 / 34'359'738'368.0 / (16.0 * 200.0) * 2.0 * std::numbers::pi;

/// Of the field at the default of parameter 6, A: half of the module's 2.8 A rms.
constexpr double amplitude = 2.087;

/// A motor of the table, and speeds and a load that it can stand: the load takes up to half of the torque with which it
/// can just follow, and accelerating another fifth.
void mount_motor(Trial& trial, twin::TorqueTables& tables, Dice& dice) {
  const auto motors = twin::motors();
  const twin::MotorData& motor = motors[static_cast<std::size_t>(dice.between(0, static_cast<int>(motors.size()) - 1))];
  trial.motor = motor;
  // 69 to 297 rpm: above the resonance with the detent, near which no stepper carries half of its torque
  // (docs/decisions/0054-speeds-of-reference-searches.md).
  trial.fast = dice.between(60, 260);
  // Both edges are found up to a millisecond late; the rest of a full step is left for the lag of the rotor.
  trial.slowly = std::max(trial.slowly / 4, 1);

  const twin::Machine machine(trial.machine);
  const auto table = tables.table(motor, twin::TorqueTables::key(24, amplitude, 25));
  const double pull_out = table->pull_out_torque(trial.fast * full_steps_per_second / 4);
  const double torque = std::max(0.0, 0.5 * pull_out - motor.coulomb_friction - machine.friction());
  trial.load = torque * dice.between(-100, 100) / 100.0 / machine.torque_of(1.0);
  const double strongest = 0.2 * pull_out / (motor.rotor_inertia + machine.inertia()) / radians_per_second_squared;
  trial.acceleration = std::max(static_cast<std::int32_t>(strongest) * dice.between(50, 100) / 100, 1);
}

class ReferenceSearchWithMotorOn : public testing::TestWithParam<Search> {};

TEST_P(ReferenceSearchWithMotorOn, PutsItsZeroWithinAFullStep) {
  const Search search = GetParam();
  Dice dice = dice_for(search);
  twin::TorqueTables tables;
  for (int i = 0; i < searches_of_each_mode; ++i) {
    Trial trial = random_trial(search, dice);
    mount_motor(trial, tables, dice);
    SCOPED_TRACE(testing::Message() << "search " << i << ": " << trial);
    EXPECT_LE(std::fabs(error_of_zero(search, trial)), microsteps_per_full_step);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryMachine, ReferenceSearchWithMotorOn, testing::ValuesIn(all_searches()), name_of);

TEST(ReferenceSearchesWithMotor, AreAThousandAtLeast) {
  EXPECT_GE(all_searches().size() * searches_of_each_mode, 1'000u);
}

}  // namespace
}  // namespace opentmcl::tests
