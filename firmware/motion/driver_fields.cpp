#include "firmware/motion/driver_fields.hpp"

namespace opentmcl {

using tmc262::ChopperConfiguration;
using tmc262::CoolStepControl;
using tmc262::DriverConfiguration;
using tmc262::DriverControl;
using tmc262::ReplyFormat;
using tmc262::StallGuardAndCurrent;

namespace {

tmc262::Word<DriverControl> driver_control(const AxisSettings& settings) {
  constexpr std::int32_t sixteen_microsteps = 4;
  const std::int32_t resolution = settings[AxisParameter::microstep_resolution];
  // The chip interpolates 16 microsteps per full step and nothing else; with another resolution the setting waits.
  const bool interpolate = settings[AxisParameter::step_interpolation] != 0 && resolution == sixteen_microsteps;
  return DriverControl::Resolution::of(tmc262::maximum_resolution - resolution) |
         DriverControl::StepOnBothEdges::of(settings[AxisParameter::double_step]) |
         DriverControl::Interpolation::of(interpolate ? 1 : 0);
}

/// Parameters 164 to 166 mean different fields in the two chopper modes (PD-1161 manual, chapter 4).
tmc262::Word<ChopperConfiguration> chopper_configuration(const AxisSettings& settings, bool bridges_on) {
  const std::int32_t decay = settings[AxisParameter::disable_fast_decay_comparator];
  const std::int32_t end = settings[AxisParameter::chopper_hysteresis_end];
  const std::int32_t start = settings[AxisParameter::chopper_hysteresis_start];
  const auto common = ChopperConfiguration::BlankTime::of(settings[AxisParameter::chopper_blank_time]) |
                      ChopperConfiguration::RandomOffTime::of(settings[AxisParameter::random_off_time]) |
                      ChopperConfiguration::OffTime::of(bridges_on ? settings[AxisParameter::chopper_off_time] : 0);
  if (settings[AxisParameter::constant_off_time_mode] == 0) {
    constexpr std::int32_t start_limit = ChopperConfiguration::HysteresisStart::maximum;  // the manual's 8 is one more
    return common | ChopperConfiguration::HysteresisDecrement::of(decay) |
           ChopperConfiguration::HysteresisEnd::of(end) |
           ChopperConfiguration::HysteresisStart::of(start < start_limit ? start : start_limit);
  }
  // Fast decay time (165) has four bits, the top one apart; the sine wave offset (166) sits where the end value does.
  return common | ChopperConfiguration::ConstantOffTime::set |
         ChopperConfiguration::FastDecayByTimerOnly::of(decay != 0 ? 1 : 0) |
         ChopperConfiguration::FastDecayTimeTopBit::of(end >> ChopperConfiguration::HysteresisStart::width) |
         ChopperConfiguration::HysteresisStart::of(end) | ChopperConfiguration::HysteresisEnd::of(start);
}

tmc262::Word<CoolStepControl> cool_step_control(const AxisSettings& settings, bool allowed) {
  return CoolStepControl::MinimumCurrent::of(settings[AxisParameter::smart_energy_current_minimum]) |
         CoolStepControl::CurrentDownStep::of(settings[AxisParameter::smart_energy_current_down_step]) |
         CoolStepControl::HysteresisWidth::of(settings[AxisParameter::smart_energy_hysteresis]) |
         CoolStepControl::CurrentUpStep::of(settings[AxisParameter::smart_energy_current_up_step]) |
         CoolStepControl::HysteresisStart::of(allowed ? settings[AxisParameter::smart_energy_hysteresis_start] : 0);
}

tmc262::Word<DriverConfiguration> driver_configuration(const AxisSettings& settings, ReplyFormat format) {
  return DriverConfiguration::SlopeHigh::of(settings[AxisParameter::slope_control_high_side]) |
         DriverConfiguration::SlopeLow::of(settings[AxisParameter::slope_control_low_side]) |
         DriverConfiguration::DisableShortProtection::of(settings[AxisParameter::short_protection_disable]) |
         DriverConfiguration::ShortDetectionTime::of(settings[AxisParameter::short_detection_timer]) |
         DriverConfiguration::LowSenseVoltage::of(settings[AxisParameter::sense_resistor_voltage]) |
         DriverConfiguration::of(format);
}

}  // namespace

void apply_driver_settings(const AxisSettings& settings, const DriverState& state, Tmc262Driver& driver) {
  driver.driver_control = driver_control(settings);
  driver.chopper_configuration = chopper_configuration(settings, state.bridges_on);
  driver.cool_step_control = cool_step_control(settings, state.cool_step);
  driver.stall_guard_and_current = StallGuardAndCurrent::Filter::of(settings[AxisParameter::stall_guard_filter]) |
                                   StallGuardAndCurrent::Threshold::of(settings[AxisParameter::stall_guard_threshold]) |
                                   StallGuardAndCurrent::CurrentScale::of(current_scale_of(state.current));
  driver.driver_configuration =
      driver_configuration(settings, DriverConfiguration::reply_format_in(driver.driver_configuration));
}

}  // namespace opentmcl
