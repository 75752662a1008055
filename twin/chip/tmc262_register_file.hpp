// The registers of the TMC262 as last written.
#pragma once

#include <cstdint>

#include "firmware/chip/tmc262_registers.hpp"

namespace opentmcl::twin {

/// All 0 after reset: Step/Dir mode, 256 microsteps, bridges off, lowest current.
struct Tmc262RegisterFile {
  tmc262::Word<tmc262::DriverControl> driver_control;
  tmc262::Word<tmc262::CoilCurrents> coil_currents;  ///< what DRVCTRL holds while SDOFF = 1
  tmc262::Word<tmc262::ChopperConfiguration> chopper_configuration;
  tmc262::Word<tmc262::CoolStepControl> cool_step_control;
  tmc262::Word<tmc262::StallGuardAndCurrent> stall_guard_and_current;
  tmc262::Word<tmc262::DriverConfiguration> driver_configuration;

  /// Takes a word of 20 bits. @return false when it sets reserved bits, the test mode, an undefined code or no register
  bool write(std::uint32_t word);

  bool step_dir_off() const { return tmc262::DriverConfiguration::StepDirOff::is_set(driver_configuration); }
  bool steps_on_both_edges() const { return tmc262::DriverControl::StepOnBothEdges::is_set(driver_control); }
  /// CS: 0…31.
  std::int32_t current_scale() const { return tmc262::StallGuardAndCurrent::CurrentScale::in(stall_guard_and_current); }

  friend bool operator==(const Tmc262RegisterFile&, const Tmc262RegisterFile&) = default;
};

}  // namespace opentmcl::twin
