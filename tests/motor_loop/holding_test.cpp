// A motor that stands or is thrown off: standby current (7), freewheeling (204) and the deviation stop (212).
#include <gtest/gtest.h>

#include <cmath>

#include "tests/motor_loop/motor_bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr double friction_and_detent = 0.028;        // N m, of the motor of both modules
constexpr std::int32_t encoder_count = turn / 1024;  // microsteps

class Holding : public testing::TestWithParam<ModuleId> {
 protected:
  /// How far the shaft has turned since, in full steps.
  double turned_since(std::int64_t angle) const {
    return static_cast<double>(bench.world().rotor_angle() - angle) / full_step;
  }
  void make_a_turn() {
    bench.command(Opcode::mvp, 1, 0, turn);
    bench.wait_until_reached(5'000 * one_millisecond);
  }
  /// A pulse of torque that no motor stands.
  void be_thrown_back() {
    bench.set_load_torque(1.5 * holding_torque());
    bench.wait_ms(10);
    bench.set_load_torque(0);
  }

  MotorBench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, Holding, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161), name_of_module);

TEST_P(Holding, CarriesWithTheStandbyCurrentItsShareOfTheHoldingTorqueAndLetsGoAbove) {
  bench.set(AxisParameter::power_down_delay, 50);
  for (const std::int32_t standby_current : {16, 40, 80, 160, 255}) {
    SCOPED_TRACE(standby_current);
    bench.set(AxisParameter::standby_current, standby_current);
    bench.set_load_torque(0);
    make_a_turn();
    bench.wait_ms(1'000);
    const double share = (bench.driver().current_scale() + 1) / 32.0;
    EXPECT_EQ(bench.driver().current_scale(), standby_current / 8);
    const std::int64_t angle = bench.world().rotor_angle();
    double torque = 0;
    while (turned_since(angle) > -2.0 && torque < 1.0) {
      torque += 1e-3;
      bench.set_load_torque(torque);
      bench.wait_ms(10);
    }
    EXPECT_GT(torque, share * holding_torque());
    EXPECT_LT(torque, share * holding_torque() + friction_and_detent);
    bench.wait_ms(100);
    EXPECT_LT(turned_since(angle), -50.0) << "let go";
  }
}

TEST_P(Holding, CarriesMoreUntilThePowerDownDelayIsOver) {
  bench.set(AxisParameter::standby_current, 40);
  bench.set(AxisParameter::power_down_delay, 100);
  make_a_turn();
  const std::int64_t angle = bench.world().rotor_angle();
  bench.set_load_torque(0.5 * holding_torque());
  bench.wait_ms(900);
  EXPECT_LT(std::fabs(turned_since(angle)), 1.5) << "with the full current";
  bench.wait_ms(500);
  EXPECT_LT(turned_since(angle), -50.0) << "with a fifth of it";
}

TEST_P(Holding, LetsTheShaftTurnFreelyAfterTheFreewheelingDelay) {
  bench.set(AxisParameter::freewheeling_delay, 50);
  make_a_turn();
  const std::int64_t angle = bench.world().rotor_angle();
  constexpr double torque = 0.05;
  bench.set_load_torque(torque);
  bench.wait_ms(400);
  EXPECT_LT(std::fabs(turned_since(angle)), 1.5);
  bench.wait_ms(300);
  const double without_current = turned_since(angle);
  EXPECT_LT(without_current, -50.0) << "falls";
  bench.set_load_torque(0);
  bench.wait_ms(2'000);
  const double lost = bench.full_steps_lost();
  EXPECT_GT(lost, 50.0);
  // A command brings the current back, and the shaft follows the field again from where it is.
  make_a_turn();
  bench.wait_ms(200);
  EXPECT_NEAR(std::remainder(bench.full_steps_lost(), 4.0), 0.0, 0.2) << "by whole turns of the currents";
}

TEST_P(Holding, StopsAfterASlipWhenTheEncoderDeviatesTooMuch) {
  bench.set(AxisParameter::maximum_encoder_deviation, 2 * full_step);
  bench.rotate(150);
  bench.wait_ms(300);
  EXPECT_EQ(bench.speed(), velocity_of(150)) << "swings and the load angle are less";
  be_thrown_back();
  bench.wait_ms(300);
  EXPECT_EQ(bench.speed(), 0);
  EXPECT_EQ(bench.get(AxisParameter::extended_error_flags), flag_of(AxisEvent::deviation));
}

TEST_P(Holding, RunsOnAfterASlipWithoutDeviationStopWholeTurnsOfTheCurrentsBehind) {
  bench.rotate(150);
  bench.wait_ms(300);
  be_thrown_back();
  bench.wait_ms(500);
  EXPECT_EQ(bench.speed(), velocity_of(150));
  EXPECT_EQ(bench.get(AxisParameter::extended_error_flags), 0);
  EXPECT_NEAR(bench.rotor_rpm(), 150, 1) << "it has fallen in step again";
  bench.command(Opcode::mst);
  bench.wait_ms(1'000);
  const double lost = bench.full_steps_lost();
  EXPECT_GT(lost, 3.0);
  EXPECT_NEAR(std::remainder(lost, 4.0), 0.0, 0.2);
  const std::int32_t deviation = bench.position() - bench.get(AxisParameter::encoder_position);
  EXPECT_NEAR(deviation, lost * full_step, encoder_count) << "and the encoder shows it";
}

}  // namespace
}  // namespace opentmcl::tests
