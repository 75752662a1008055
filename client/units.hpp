// From TMC429 numbers to physical ones. Source: PD-1161 manual 6.1, erratum E-37.
#pragma once

#include <cmath>
#include <cstdint>

namespace opentmcl::client {

inline constexpr double chip_clock = 16e6;  ///< Hz
/// Of the motors these modules are sold with: 1.8° a step.
inline constexpr double full_steps_per_turn = 200;

/// Microsteps per second of an internal velocity.
inline double microsteps_per_second(std::int32_t velocity, std::int32_t pulse_divisor) {
  return chip_clock * velocity / (std::ldexp(1.0, pulse_divisor) * 2048 * 32);
}

/// Microsteps per second² of an internal acceleration.
inline double microsteps_per_second_squared(std::int32_t acceleration, std::int32_t pulse_divisor,
                                            std::int32_t ramp_divisor) {
  return chip_clock * chip_clock * acceleration / std::ldexp(1.0, pulse_divisor + ramp_divisor + 29);
}

/// Turns per minute of a motor with `full_steps_per_turn`.
/// @param microstep_resolution axis parameter 140: 2^n microsteps per full step
inline double turns_per_minute(double microsteps_per_second, std::int32_t microstep_resolution) {
  return 60 * microsteps_per_second / (full_steps_per_turn * std::ldexp(1.0, microstep_resolution));
}

}  // namespace opentmcl::client
