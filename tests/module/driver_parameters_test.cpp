// Every parameter of the TMC262, from SAP to the field of the register it belongs in.
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

using tmc262::ChopperConfiguration;
using tmc262::CoolStepControl;
using tmc262::DriverConfiguration;
using tmc262::DriverControl;
using tmc262::StallGuardAndCurrent;
using twin::Tmc262;

/// One SAP and what a field of the driver then holds.
struct Row {
  AxisParameter parameter;
  std::int32_t value;
  std::int32_t (*field)(const Tmc262&);
  std::int32_t expected;
};

template <class Field>
std::int32_t chopper(const Tmc262& chip) {
  return Field::in(chip.chopper_configuration());
}
template <class Field>
std::int32_t control(const Tmc262& chip) {
  return Field::in(chip.driver_control());
}
template <class Field>
std::int32_t cool_step(const Tmc262& chip) {
  return Field::in(chip.cool_step_control());
}
template <class Field>
std::int32_t stall_guard(const Tmc262& chip) {
  return Field::in(chip.stall_guard_and_current());
}
template <class Field>
std::int32_t configuration(const Tmc262& chip) {
  return Field::in(chip.driver_configuration());
}

class DriverParameters : public testing::TestWithParam<ModuleId> {
 protected:
  void expect(std::initializer_list<Row> rows) {
    // Moving, so that coolStep is on.
    bench.command(Opcode::ror, 0, 0, 100);
    bench.wait(100 * one_millisecond);
    for (const Row& row : rows) {
      bench.set(row.parameter, row.value);
      EXPECT_EQ(row.field(bench.module.world().tmc262()), row.expected)
          << "SAP " << static_cast<int>(row.parameter) << ", 0, " << row.value;
    }
  }

  Bench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, DriverParameters, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(DriverParameters, SetResolutionAndEdges) {
  expect({
      {AxisParameter::microstep_resolution, 0, control<DriverControl::Resolution>, 8},
      {AxisParameter::microstep_resolution, 4, control<DriverControl::Resolution>, 4},
      {AxisParameter::microstep_resolution, 8, control<DriverControl::Resolution>, 0},
      {AxisParameter::double_step, 1, control<DriverControl::StepOnBothEdges>, 1},
      {AxisParameter::double_step, 0, control<DriverControl::StepOnBothEdges>, 0},
  });
}

TEST_P(DriverParameters, InterpolateSixteenMicrostepsOnly) {
  expect({
      {AxisParameter::step_interpolation, 1, control<DriverControl::Interpolation>, 0},
      {AxisParameter::microstep_resolution, 4, control<DriverControl::Interpolation>, 1},
      {AxisParameter::microstep_resolution, 5, control<DriverControl::Interpolation>, 0},
      {AxisParameter::microstep_resolution, 4, control<DriverControl::Interpolation>, 1},
      {AxisParameter::step_interpolation, 0, control<DriverControl::Interpolation>, 0},
  });
}

TEST_P(DriverParameters, ShapeTheSpreadCycleChopper) {
  expect({
      {AxisParameter::chopper_blank_time, 0, chopper<ChopperConfiguration::BlankTime>, 0},
      {AxisParameter::chopper_blank_time, 3, chopper<ChopperConfiguration::BlankTime>, 3},
      {AxisParameter::disable_fast_decay_comparator, 1, chopper<ChopperConfiguration::HysteresisDecrement>, 1},
      {AxisParameter::chopper_hysteresis_end, 15, chopper<ChopperConfiguration::HysteresisEnd>, 15},
      {AxisParameter::chopper_hysteresis_start, 0, chopper<ChopperConfiguration::HysteresisStart>, 0},
      {AxisParameter::chopper_hysteresis_start, 7, chopper<ChopperConfiguration::HysteresisStart>, 7},
      {AxisParameter::chopper_hysteresis_start, 8, chopper<ChopperConfiguration::HysteresisStart>, 7},
      {AxisParameter::chopper_off_time, 15, chopper<ChopperConfiguration::OffTime>, 15},
      {AxisParameter::random_off_time, 1, chopper<ChopperConfiguration::RandomOffTime>, 1},
      {AxisParameter::random_off_time, 0, chopper<ChopperConfiguration::RandomOffTime>, 0},
  });
}

TEST_P(DriverParameters, ShapeTheConstantOffTimeChopper) {
  expect({
      {AxisParameter::constant_off_time_mode, 1, chopper<ChopperConfiguration::ConstantOffTime>, 1},
      {AxisParameter::disable_fast_decay_comparator, 1, chopper<ChopperConfiguration::FastDecayByTimerOnly>, 1},
      {AxisParameter::disable_fast_decay_comparator, 0, chopper<ChopperConfiguration::FastDecayByTimerOnly>, 0},
      {AxisParameter::chopper_hysteresis_end, 13, chopper<ChopperConfiguration::HysteresisStart>, 5},
      {AxisParameter::chopper_hysteresis_end, 13, chopper<ChopperConfiguration::FastDecayTimeTopBit>, 1},
      {AxisParameter::chopper_hysteresis_end, 6, chopper<ChopperConfiguration::FastDecayTimeTopBit>, 0},
      {AxisParameter::chopper_hysteresis_start, 8, chopper<ChopperConfiguration::HysteresisEnd>, 8},
      {AxisParameter::constant_off_time_mode, 0, chopper<ChopperConfiguration::HysteresisEnd>, 6},
  });
}

TEST_P(DriverParameters, SwitchTheDriverOffWithOffTimeZero) {
  expect({{AxisParameter::chopper_off_time, 0, chopper<ChopperConfiguration::OffTime>, 0}});
  EXPECT_FALSE(bench.module.world().tmc262().bridges_on());
  const std::int64_t angle = bench.module.world().rotor_angle();
  bench.wait(500 * one_millisecond);
  EXPECT_EQ(bench.module.world().rotor_angle(), angle);
}

TEST_P(DriverParameters, TuneCoolStep) {
  expect({
      {AxisParameter::smart_energy_current_minimum, 1, cool_step<CoolStepControl::MinimumCurrent>, 1},
      {AxisParameter::smart_energy_current_down_step, 3, cool_step<CoolStepControl::CurrentDownStep>, 3},
      {AxisParameter::smart_energy_hysteresis, 15, cool_step<CoolStepControl::HysteresisWidth>, 15},
      {AxisParameter::smart_energy_current_up_step, 2, cool_step<CoolStepControl::CurrentUpStep>, 2},
      {AxisParameter::smart_energy_hysteresis_start, 9, cool_step<CoolStepControl::HysteresisStart>, 9},
      {AxisParameter::smart_energy_hysteresis_start, 0, cool_step<CoolStepControl::HysteresisStart>, 0},
  });
}

TEST_P(DriverParameters, TuneStallGuard) {
  expect({
      {AxisParameter::stall_guard_filter, 0, stall_guard<StallGuardAndCurrent::Filter>, 0},
      {AxisParameter::stall_guard_filter, 1, stall_guard<StallGuardAndCurrent::Filter>, 1},
      {AxisParameter::stall_guard_threshold, -64, stall_guard<StallGuardAndCurrent::Threshold>, -64},
      {AxisParameter::stall_guard_threshold, 63, stall_guard<StallGuardAndCurrent::Threshold>, 63},
  });
}

TEST_P(DriverParameters, ConfigureSlopesAndProtection) {
  expect({
      {AxisParameter::slope_control_high_side, 1, configuration<DriverConfiguration::SlopeHigh>, 1},
      {AxisParameter::slope_control_low_side, 2, configuration<DriverConfiguration::SlopeLow>, 2},
      {AxisParameter::short_protection_disable, 1, configuration<DriverConfiguration::DisableShortProtection>, 1},
      {AxisParameter::short_detection_timer, 3, configuration<DriverConfiguration::ShortDetectionTime>, 3},
  });
  EXPECT_TRUE(DriverConfiguration::LowSenseVoltage::is_set(bench.module.world().tmc262().driver_configuration()));
}

TEST_P(DriverParameters, ReadLoadFlagsAndCurrentOfTheDriver) {
  bench.command(Opcode::ror, 0, 0, 1000);
  bench.module.world().set_load_measurement(321);
  bench.set(AxisParameter::stall_guard_threshold, 0);
  bench.wait(1'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_load_value), 321);
  bench.set(AxisParameter::stall_guard_threshold, -20);
  bench.wait(1'000 * one_millisecond);
  EXPECT_LT(bench.get(AxisParameter::actual_load_value), 321) << "lower is more sensitive";
  EXPECT_EQ(bench.get(AxisParameter::driver_error_flags), 0);
  EXPECT_EQ(bench.get(AxisParameter::smart_energy_actual_current), 16);
  bench.module.world().set_load_measurement(measured_at_a_stall);
  bench.module.world().set_temperature(120);
  bench.wait(1'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::driver_error_flags), 0x05) << "stall and temperature warning";
  bench.module.world().set_temperature(160);
  EXPECT_EQ(bench.get(AxisParameter::driver_error_flags), 0x07) << "over-temperature too";
}

}  // namespace
}  // namespace opentmcl::tests
