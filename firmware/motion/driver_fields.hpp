// Which bits of the TMC262 an axis parameter sets.
#pragma once

#include "firmware/chip/tmc262_driver.hpp"
#include "firmware/motion/axis_settings.hpp"

namespace opentmcl {

/// What the driver is to do at present, beside what its parameters say.
struct DriverState {
  std::int32_t current = 0;  ///< 0…255, see parameter 6
  bool cool_step = false;    ///< false: coolStep is off whatever parameter 172 says
  bool bridges_on = true;    ///< false: no current at all, the shaft turns freely
};

/// Puts every driver parameter of `settings` into the shadow registers of `driver`.
void apply_driver_settings(const AxisSettings& settings, const DriverState& state, Tmc262Driver& driver);

/// 255 is full scale, in 32 steps. Source: PD-1161 manual, parameter 6, erratum on its table.
constexpr std::int32_t current_scale_of(std::int32_t current) {
  return current / 8;
}

}  // namespace opentmcl
