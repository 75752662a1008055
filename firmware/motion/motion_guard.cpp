#include "firmware/motion/motion_guard.hpp"

#include "firmware/motion/power_stage.hpp"
#include "firmware/motion/wrapping.hpp"

namespace opentmcl {

namespace {

/// The driver filters over so many full steps; until then its output is that of the motion before. The TMC262 makes no
/// measurement at standstill, so after a stall the output stays.
constexpr std::int32_t full_steps_to_a_measurement = 4;

}  // namespace

Microseconds MotionGuard::period() const {
  const bool is_armed =
      settings_[AxisParameter::stop_on_stall] != 0 || settings_[AxisParameter::maximum_encoder_deviation] != 0;
  return is_armed ? one_millisecond : PowerStage::period;
}

bool MotionGuard::sees_stall(const RampState& ramp, std::int32_t position, bool stall_guard_output) const {
  const std::int32_t threshold = settings_[AxisParameter::stop_on_stall];
  if (threshold == 0 || !stall_guard_output || ramp.speed() <= threshold) return false;
  const std::int32_t way = wrapping_difference(position, standstill_position_);
  const std::int32_t measured_after = full_steps_to_a_measurement << settings_[AxisParameter::microstep_resolution];
  return way >= measured_after || way <= -measured_after;
}

bool MotionGuard::sees_deviation(std::int32_t position) {
  const std::int32_t limit = settings_[AxisParameter::maximum_encoder_deviation];
  if (limit == 0) return false;
  const std::int32_t difference = wrapping_difference(position, encoder_.position());
  // Both ways round, and -2^31 without overflow.
  return difference > limit || difference < -limit;
}

}  // namespace opentmcl
