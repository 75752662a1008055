#pragma once

#include <cstdint>

namespace opentmcl {

/// What the ramp generator is doing, read once and then judged by all that watch the motor.
struct RampState {
  std::int32_t velocity = 0;         ///< internal units
  std::int32_t target_velocity = 0;  ///< internal units; in position mode what the braking law allows at present
  bool at_rest = true;               ///< nothing will happen until somebody commands it
  bool held_by_switch = false;       ///< it wants to move, and a limit switch does not let it

  bool is_accelerating() const { return velocity != target_velocity && !held_by_switch; }
  std::int32_t speed() const { return velocity < 0 ? -velocity : velocity; }
};

}  // namespace opentmcl
