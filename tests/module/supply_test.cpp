// Under-voltage of the motor supply: below 8.5 V the motor stops and cannot be moved, above 9.5 V it can again.
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

class Supply : public testing::TestWithParam<ModuleId> {
 protected:
  void wait_ms(unsigned milliseconds) { bench.wait(milliseconds * one_millisecond); }
  void set_millivolts(std::int32_t millivolts) {
    bench.module.world().set_supply_voltage(millivolts);
    wait_ms(20);
  }
  bool can_move() {
    const Status status = bench.command(Opcode::ror, 0, 0, 500).status;
    wait_ms(100);
    const bool moves = bench.get(AxisParameter::actual_speed) != 0;
    EXPECT_EQ(status, moves ? Status::ok : Status::command_not_available);
    bench.command(Opcode::mst);
    wait_ms(100);
    return moves;
  }
  /// Switches the module off, and on again with this supply.
  void power_on_with(std::int32_t millivolts) {
    wait_ms(100);  // for page writes of the EEPROM
    bench.module.world().set_supply_voltage(millivolts);
    bench.module.power_cycle();
    wait_ms(100);
  }
  std::int32_t variable(std::uint8_t number) { return bench.command(Opcode::ggp, number, 2).value; }

  Bench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, Supply, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(Supply, StopsTheMotorAtOnceBelowEightAndAHalfVolts) {
  bench.set(AxisParameter::maximum_acceleration, 10);
  bench.command(Opcode::ror, 0, 0, 1000);
  while (bench.get(AxisParameter::actual_speed) < 1000) wait_ms(100);
  set_millivolts(8'500);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 1000);
  set_millivolts(8'400);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0) << "no ramp";
}

TEST_P(Supply, ReleasesTheMotorAboveNineAndAHalfVoltsOnly) {
  for (const auto& [millivolts, moves] : {std::pair{24'000, true},
                                          {8'600, true},
                                          {8'400, false},
                                          {8'600, false},
                                          {9'500, false},
                                          {9'600, true},
                                          {8'500, true},
                                          {0, false},
                                          {24'000, true}}) {
    set_millivolts(millivolts);
    EXPECT_EQ(can_move(), moves) << millivolts;
  }
}

TEST_P(Supply, RefusesEveryCommandThatWouldMoveTheMotorAndNoOther) {
  set_millivolts(5'000);
  EXPECT_EQ(bench.command(Opcode::ror, 0, 0, 100).status, Status::command_not_available);
  EXPECT_EQ(bench.command(Opcode::rol, 0, 0, 100).status, Status::command_not_available);
  EXPECT_EQ(bench.command(Opcode::mvp, 0, 0, 100).status, Status::command_not_available);
  EXPECT_EQ(bench.command(Opcode::mvp, 1, 0, 100).status, Status::command_not_available);
  EXPECT_EQ(bench.command(Opcode::rfs, 0).status, Status::command_not_available);
  EXPECT_EQ(bench.command(Opcode::mst).status, Status::ok);
  EXPECT_EQ(bench.command(Opcode::rfs, 1).status, Status::ok);
  EXPECT_EQ(bench.command(Opcode::gap, 1).status, Status::ok);
}

TEST_P(Supply, DoesNotLetParametersMoveTheMotorEither) {
  set_millivolts(5'000);
  bench.set(AxisParameter::target_speed, 500);
  bench.set(AxisParameter::ramp_mode, 2);
  wait_ms(200);
  bench.set(AxisParameter::target_position, 10'000);
  bench.set(AxisParameter::ramp_mode, 0);
  wait_ms(200);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 0);
  set_millivolts(24'000);
  wait_ms(200);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 0) << "nor when the supply comes back";
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0);
}

TEST_P(Supply, EndsAReferenceSearch) {
  bench.command(Opcode::rfs, 0);
  wait_ms(100);
  set_millivolts(5'000);
  EXPECT_EQ(bench.command(Opcode::rfs, 2).value, 15);
}

TEST_P(Supply, GivesTheDriverItsRegistersBack) {
  bench.set(AxisParameter::maximum_current, 200);
  bench.set(AxisParameter::microstep_resolution, 6);
  bench.set(AxisParameter::stall_guard_threshold, -7);
  bench.command(Opcode::mvp, 0, 0, 1000);
  bench.wait_until_reached(1'000 * one_millisecond);
  const twin::Tmc262& driver = bench.module.world().tmc262();
  const twin::Tmc262 before = driver;
  set_millivolts(5'000);
  EXPECT_FALSE(driver.bridges_on()) << "it lost its registers";
  set_millivolts(24'000);
  EXPECT_TRUE(driver.driver_control() == before.driver_control());
  EXPECT_TRUE(driver.chopper_configuration() == before.chopper_configuration());
  EXPECT_TRUE(driver.stall_guard_and_current() == before.stall_guard_and_current());
  EXPECT_TRUE(driver.driver_configuration() == before.driver_configuration());
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 1000) << "the position counter has its own supply";
  bench.command(Opcode::mvp, 1, 0, 500);
  bench.wait_until_reached(1'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 1500);
}

TEST_P(Supply, GivesThemBackAfterADipTooShortToBeSeenToo) {
  bench.command(Opcode::ror, 0, 0, 500);
  wait_ms(500);
  bench.module.world().set_supply_voltage(5'000);
  bench.module.world().set_supply_voltage(24'000);
  EXPECT_FALSE(bench.module.world().tmc262().bridges_on());
  wait_ms(60);
  EXPECT_TRUE(bench.module.world().tmc262().bridges_on());
  EXPECT_EQ(bench.get(AxisParameter::smart_energy_actual_current), 16);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 500);
}

TEST_P(Supply, GivesThemBackBeforeTheNextMotionAfterADipAtRest) {
  bench.set(AxisParameter::microstep_resolution, 6);
  bench.set(AxisParameter::maximum_current, 200);
  const twin::Tmc262& driver = bench.module.world().tmc262();
  // Soon after a motion, and with the standby current.
  for (const unsigned rest_ms : {30U, 3'000U}) {
    for (const bool moves_to_position : {false, true}) {
      bench.command(Opcode::mvp, 1, 0, 100);
      bench.wait_until_reached(1'000 * one_millisecond);
      wait_ms(rest_ms);
      const std::int64_t angle = bench.module.world().rotor_angle();
      const std::int32_t position = bench.get(AxisParameter::actual_position);
      bench.module.world().set_supply_voltage(5'000);
      bench.module.world().set_supply_voltage(24'000);
      bench.command(moves_to_position ? Opcode::mvp : Opcode::ror, moves_to_position ? 1 : 0, 0, 800);
      EXPECT_TRUE(driver.bridges_on());
      EXPECT_EQ(driver.current_scale(), 25);
      EXPECT_EQ(driver.microsteps_per_pulse(), 4) << "64 microsteps";
      EXPECT_TRUE(tmc262::DriverConfiguration::LowSenseVoltage::is_set(driver.driver_configuration()));
      wait_ms(1'000);
      bench.command(Opcode::mst);
      wait_ms(1'000);
      const std::int64_t way = bench.get(AxisParameter::actual_position) - position;
      EXPECT_GT(way, 200);
      // The field jumps with the registers, by not more than a half turn of the currents.
      EXPECT_NEAR(static_cast<double>(bench.module.world().rotor_angle() - angle), static_cast<double>(4 * way), 512);
    }
  }
}

TEST_P(Supply, GivesThemBackWhileStepsComeFromOutside) {
  const twin::Tmc262& driver = bench.module.world().tmc262();
  const std::int32_t last_mode = GetParam() == ModuleId::pd1161 ? 5 : 1;
  bench.module.world().set_inputs(1U << static_cast<unsigned>(hal::InputPin::step_dir_enable));
  for (std::int32_t mode = 1; mode <= last_mode; ++mode) {
    bench.set(AxisParameter::step_direction_mode, mode);
    wait_ms(100);
    ASSERT_TRUE(driver.bridges_on()) << mode;
    bench.module.world().set_supply_voltage(5'000);
    bench.module.world().set_supply_voltage(24'000);
    EXPECT_FALSE(driver.bridges_on());
    for (int looks = 0; looks < 6; ++looks) {
      bench.module.world().pulse_step_input(false);
      wait_ms(10);
    }
    EXPECT_TRUE(driver.bridges_on()) << mode;
  }
}

TEST_P(Supply, BringsTheDriverUpWhenTheMotorSupplyComesLate) {
  power_on_with(0);
  EXPECT_FALSE(can_move());
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 0);
  wait_ms(3'000);
  EXPECT_EQ(bench.module.next_turn(), never) << "it sleeps meanwhile";
  set_millivolts(24'000);
  EXPECT_TRUE(bench.module.world().tmc262().bridges_on());
  EXPECT_TRUE(can_move());
}

TEST_P(Supply, WakesASleepingModule) {
  wait_ms(5'000);
  EXPECT_EQ(bench.module.next_turn(), never);
  bench.module.world().set_supply_voltage(5'000);
  EXPECT_EQ(bench.module.next_turn(), bench.module.now());
}

constexpr auto count_starts = R"(
       GGP 1, 2
       CALC ADD, 1
       AGP 1, 2
       JC EAL, Alarm
 Loop: JA Loop
Alarm: SGP 2, 2, 1
       JA Loop
)";

TEST_P(Supply, StopsTheProgramAndStartsItAgainWithAutoStart) {
  bench.set(GlobalParameter::auto_start, 1);
  bench.run_program(count_starts);
  wait_ms(100);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 1);
  EXPECT_EQ(variable(1), 1);
  set_millivolts(8'000);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  set_millivolts(9'000);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  set_millivolts(10'000);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 1);
  EXPECT_EQ(variable(1), 2) << "from its begin";
  EXPECT_EQ(variable(2), 1) << "and it can tell why";
}

TEST_P(Supply, LeavesTheProgramStoppedWithoutAutoStart) {
  bench.run_program(count_starts);
  wait_ms(100);
  set_millivolts(8'000);
  set_millivolts(24'000);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  EXPECT_EQ(variable(1), 1);
}

TEST_P(Supply, StartsTheProgramWhenItComesLate) {
  bench.set(GlobalParameter::auto_start, 1);
  bench.download(count_starts);
  power_on_with(0);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
  set_millivolts(24'000);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 1);
  EXPECT_EQ(variable(1), 1);
}

TEST_P(Supply, TellsAProgramOfAMoveThatItBrokeOff) {
  bench.run_program("MVP ABS, 0, 100000\nWAIT TICKS, 0, 1000\nJC EPO, Position\nSTOP\nPosition: SGP 1, 2, 1\nSTOP\n");
  wait_ms(100);
  set_millivolts(8'000);
  set_millivolts(24'000);
  bench.command(Opcode::run_application, 1, 0, 2);
  wait_ms(100);
  EXPECT_EQ(variable(1), 1);
}

}  // namespace
}  // namespace opentmcl::tests
