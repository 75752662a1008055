// Which bits of the TMC262 an axis parameter sets.
#pragma once

#include "firmware/chip/tmc262_driver.hpp"
#include "firmware/motion/axis_settings.hpp"

namespace opentmcl {

/// Puts every driver parameter of `settings` into the shadow registers of `driver`, current scale excepted.
/// coolStep stays off here (its lower threshold 0) unless `cool_step_allowed`.
void apply_driver_settings(const AxisSettings& settings, bool cool_step_allowed, Tmc262Driver& driver);

/// 255 is full scale, in 32 steps. Source: PD-1161 manual, parameter 6, erratum on its table.
constexpr std::int32_t current_scale_of(std::int32_t current) {
  return current / 8;
}

}  // namespace opentmcl
