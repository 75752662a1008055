#include "twin/chip/tmc262_register_file.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::ChopperConfiguration;
using tmc262::CoilCurrents;
using tmc262::CoolStepControl;
using tmc262::DriverConfiguration;
using tmc262::DriverControl;
using tmc262::RegisterSelect;
using tmc262::StallGuardAndCurrent;
using tmc262::Word;

template <class Register>
bool only_sets(Word<Register> word, std::uint32_t defined_bits) {
  return (word.bits & ~defined_bits) == 0;
}

bool is_defined(Word<DriverControl> word) {
  return only_sets(word, DriverControl::Interpolation::mask | DriverControl::StepOnBothEdges::mask |
                             DriverControl::Resolution::mask) &&
         DriverControl::Resolution::in(word) <= tmc262::maximum_resolution;
}

bool is_defined(Word<CoolStepControl> word) {
  return only_sets(word, CoolStepControl::MinimumCurrent::mask | CoolStepControl::CurrentDownStep::mask |
                             CoolStepControl::HysteresisWidth::mask | CoolStepControl::CurrentUpStep::mask |
                             CoolStepControl::HysteresisStart::mask);
}

bool is_defined(Word<StallGuardAndCurrent> word) {
  return only_sets(word, StallGuardAndCurrent::Filter::mask | StallGuardAndCurrent::Threshold::mask |
                             StallGuardAndCurrent::CurrentScale::mask);
}

bool is_defined(Word<DriverConfiguration> word) {
  return only_sets(word, DriverConfiguration::SlopeHigh::mask | DriverConfiguration::SlopeLow::mask |
                             DriverConfiguration::DisableShortProtection::mask |
                             DriverConfiguration::ShortDetectionTime::mask | DriverConfiguration::StepDirOff::mask |
                             DriverConfiguration::LowSenseVoltage::mask | DriverConfiguration::Format::mask) &&
         DriverConfiguration::reply_format_in(word) != tmc262::ReplyFormat::reserved;
}

}  // namespace

bool Tmc262RegisterFile::write(std::uint32_t word) {
  switch (tmc262::register_select_of(word)) {
    case RegisterSelect::driver_control:
      if (step_dir_off()) {
        coil_currents = tmc262::word_in<CoilCurrents>(word);
        return true;
      }
      driver_control = tmc262::word_in<DriverControl>(word);
      return is_defined(driver_control);
    case RegisterSelect::chopper_configuration:
      chopper_configuration = tmc262::word_in<ChopperConfiguration>(word);
      return true;
    case RegisterSelect::cool_step_control:
      cool_step_control = tmc262::word_in<CoolStepControl>(word);
      return is_defined(cool_step_control);
    case RegisterSelect::stall_guard_and_current:
      stall_guard_and_current = tmc262::word_in<StallGuardAndCurrent>(word);
      return is_defined(stall_guard_and_current);
    case RegisterSelect::driver_configuration:
      driver_configuration = tmc262::word_in<DriverConfiguration>(word);
      return is_defined(driver_configuration);
    case RegisterSelect::unassigned:
      return false;
  }
  return false;
}

}  // namespace opentmcl::twin
