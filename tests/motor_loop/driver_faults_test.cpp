// What motor and firmware make of a driver in trouble: a dip of its supply, a short to ground, a broken wire.
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/chip/tmc262_registers.hpp"
#include "tests/motor_loop/motor_bench.hpp"

namespace opentmcl::tests {
namespace {

using Coil = twin::Tmc262::Coil;
using DriverReply = tmc262::Reply;

class DriverFaults : public testing::TestWithParam<ModuleId> {
 protected:
  /// Too short for the firmware to see it: the driver has lost its registers.
  void dip() {
    bench.module.world().set_supply_voltage(5'000);
    bench.module.world().set_supply_voltage(24'000);
  }
  /// Parameter 208: the status bits of the driver.
  tmc262::Word<DriverReply> flags() {
    return {static_cast<std::uint32_t>(bench.get(AxisParameter::driver_error_flags))};
  }

  MotorBench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, DriverFaults, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161), name_of_module);

TEST_P(DriverFaults, ASlowMotorFallsInStepAgainAfterADipThatOnlyTheDriverSees) {
  bench.rotate(60);
  dip();
  EXPECT_FALSE(bench.driver().bridges_on());
  bench.wait_ms(60);
  EXPECT_TRUE(bench.driver().bridges_on());
  bench.wait_ms(500);
  EXPECT_EQ(bench.speed(), velocity_of(60));
  const std::int64_t angle = bench.world().rotor_angle();
  bench.wait_ms(1'000);
  EXPECT_NEAR(static_cast<double>(bench.world().rotor_angle() - angle), turn, full_step) << "60 rpm, with a swing";
}

TEST_P(DriverFaults, ADipIsSeenByTheDeviationStopWhenStepsWereLost) {
  bench.set(AxisParameter::maximum_encoder_deviation, 2 * full_step);
  bench.rotate(500);
  bench.set_brake(0.2);
  bench.wait_ms(200);
  ASSERT_EQ(bench.speed(), velocity_of(500));
  dip();
  bench.wait_ms(200);
  EXPECT_EQ(bench.speed(), 0);
  EXPECT_EQ(bench.get(AxisParameter::extended_error_flags), flag_of(AxisEvent::deviation));
}

TEST_P(DriverFaults, AShortToGroundTakesOneCoilAndTheMotorStallsUnderItsLoad) {
  bench.set_brake(0.3);
  bench.rotate(100);
  EXPECT_LT(std::fabs(bench.full_steps_lost()), 2.0);
  bench.module.world().set_short_to_ground(Coil::a, true);
  bench.wait_ms(500);
  EXPECT_FALSE(bench.driver().bridge_on(Coil::a));
  EXPECT_TRUE(DriverReply::ShortToGroundA::is_set(flags()));
  EXPECT_GT(bench.full_steps_lost(), 50.0);
  bench.module.world().set_short_to_ground(Coil::a, false);
  bench.wait_ms(100);
  EXPECT_FALSE(bench.driver().bridge_on(Coil::a)) << "until the driver has been switched off";
  bench.command(Opcode::mst);
  bench.wait_ms(200);
  bench.set(AxisParameter::chopper_off_time, 0);
  bench.set(AxisParameter::chopper_off_time, 5);
  bench.rotate(100);
  const double lost = bench.full_steps_lost();
  bench.wait_ms(500);
  EXPECT_TRUE(bench.driver().bridges_on());
  EXPECT_NEAR(bench.full_steps_lost(), lost, 2.0) << "turns again";
}

TEST_P(DriverFaults, ABrokenWireIsAnOpenLoadAndTheMotorStallsUnderItsLoad) {
  bench.set_brake(0.3);
  bench.rotate(100);
  bench.module.world().set_coil_connected(Coil::b, false);
  bench.wait_ms(500);
  EXPECT_TRUE(DriverReply::OpenLoadB::is_set(flags()));
  EXPECT_TRUE(bench.driver().bridges_on()) << "the driver only tells";
  EXPECT_GT(bench.full_steps_lost(), 50.0);
  bench.module.world().set_coil_connected(Coil::b, true);
  bench.command(Opcode::mst);
  bench.wait_ms(200);
  bench.rotate(100);
  const double lost = bench.full_steps_lost();
  bench.wait_ms(500);
  EXPECT_NEAR(bench.full_steps_lost(), lost, 2.0) << "turns again";
  EXPECT_FALSE(DriverReply::OpenLoadB::is_set(flags()));
}

}  // namespace
}  // namespace opentmcl::tests
