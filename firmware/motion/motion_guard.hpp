#pragma once

#include <cstdint>

#include "firmware/hal/time.hpp"
#include "firmware/motion/axis_settings.hpp"
#include "firmware/motion/encoder_position.hpp"
#include "firmware/motion/ramp_state.hpp"

namespace opentmcl {

/// What happens to an axis without a command, as bits. The first two have the places of parameter 207.
enum class AxisEvent : std::uint8_t {
  stall = 1,            ///< stopped by parameter 181
  deviation = 2,        ///< stopped by parameter 212
  position_error = 4,   ///< a move in position mode was broken off, or a limit switch keeps it from its target
  driver_shutdown = 8,  ///< the TMC262 switched itself off: over-temperature or short to ground
};

/// Judges whether a moving motor may go on. Source: PD-1161 manual, parameters 181 and 212;
/// docs/decisions/0023-stall-and-deviation.md.
class MotionGuard {
 public:
  MotionGuard(const AxisSettings& settings, EncoderPosition& encoder) : settings_(settings), encoder_(encoder) {}

  /// While the motor moves, how often it has to be looked at.
  Microseconds period() const;

  /// The motor stands at `position`: what stallGuard2 measured before says nothing about the motion to come.
  void note_standstill(std::int32_t position) { standstill_position_ = position; }

  /// @param position of the ramp generator, microsteps
  /// @param stall_guard_output SG_TST of the driver
  bool sees_stall(const RampState& ramp, std::int32_t position, bool stall_guard_output) const;
  /// @param position of the ramp generator, microsteps
  bool sees_deviation(std::int32_t position);

 private:
  const AxisSettings& settings_;
  EncoderPosition& encoder_;
  std::int32_t standstill_position_ = 0;  ///< where the motion under way began
};

}  // namespace opentmcl
