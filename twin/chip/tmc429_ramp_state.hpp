// What the ramp and pulse generators of one TMC429 axis hold, and the two laws of their ticks. Integers only.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/tmc429_choices.hpp"

namespace opentmcl::twin {

/// The registers that shape a motion.
struct Tmc429RampSettings {
  std::int32_t target_position = 0;       ///< X_TARGET, 24 bit signed
  std::int32_t minimum_velocity = 0;      ///< V_MIN, 0…2047
  std::int32_t maximum_velocity = 0;      ///< V_MAX, 0…2047
  std::int32_t target_velocity = 0;       ///< V_TARGET, -2048…2047; the chip writes it in ramp_mode and soft_mode
  std::int32_t maximum_acceleration = 0;  ///< A_MAX, 0…2047
  std::uint32_t multiplier = 128;         ///< PMUL with its fixed top bit, 128…255
  std::uint32_t divisor = 0;              ///< PDIV, 0…15
  tmc429::RampMode mode = tmc429::RampMode::ramp;
  unsigned pulse_divider = 0;  ///< a pulse tick every 2^n ticks, 0…13
  unsigned ramp_divider = 0;   ///< a ramp tick every 2^n ticks, 0…13

  friend bool operator==(const Tmc429RampSettings&, const Tmc429RampSettings&) = default;
};

/// The directions in which stop switches forbid motion.
struct Tmc429Blocked {
  bool decreasing = false;
  bool increasing = false;
  bool soft_stop = false;  ///< stop with A_MAX instead of at once

  friend bool operator==(const Tmc429Blocked&, const Tmc429Blocked&) = default;
};

/// Time is counted in ticks of 32 clocks, the common input of both dividers (datasheet page 28). A ramp tick falls on
/// each multiple of 2^ramp_divider, a pulse tick on each of 2^pulse_divider; where both fall on one tick, the ramp tick
/// comes first.
struct Tmc429RampState {
  Tmc429RampSettings settings;
  Tmc429Blocked blocked;
  std::int32_t position = 0;      ///< X_ACTUAL, 24 bit signed
  std::int32_t velocity = 0;      ///< 1/256 of the unit of V_ACTUAL
  std::int32_t acceleration = 0;  ///< A_ACTUAL: the change of velocity on the last ramp tick, in the same unit
  std::uint32_t accumulator = 0;  ///< 0…2047, the phase within a step
  std::uint64_t now = 0;          ///< ticks since power-on

  /// A new velocity and, when positioning, a new V_TARGET.
  void ramp_tick();
  /// Adds the velocity to the phase; true when that gave a step.
  bool pulse_tick();

  /// ramp_mode or soft_mode.
  bool positioning() const { return settings.mode <= tmc429::RampMode::soft; }
  /// Steps to X_TARGET on the 24-bit circle, -2^23…2^23-1.
  std::int32_t distance_to_target() const { return tmc429_choices::distance(position, settings.target_position); }
  /// The velocity that positioning may have at 1…2^23 steps from the target, in the unit of V_ACTUAL.
  std::int32_t velocity_limit(std::uint64_t distance) const;
  /// The shortest distance at which velocity_limit() is at least `limit`, which must be one of its values.
  std::uint64_t shortest_distance(std::int32_t limit) const;
  /// The velocity to which a ramp tick goes from here, in the unit of V_ACTUAL; only that of hold_mode has none.
  std::int32_t goal() const;
  /// What a pulse tick adds to the phase: |V_ACTUAL|, 0…2047.
  std::uint32_t pulse_increment() const {
    return static_cast<std::uint32_t>(std::abs(tmc429_choices::integer_velocity(velocity)));
  }
  /// Moves in a direction in which a stop switch is active.
  bool runs_into(const Tmc429Blocked& switches) const {
    return (switches.decreasing && velocity < 0) || (switches.increasing && velocity > 0);
  }
  /// Counts steps around the 24-bit circle.
  void move(bool decreasing, std::uint64_t steps) {
    const auto moved = static_cast<std::uint32_t>(decreasing ? 0 - steps : steps);
    position = tmc429_choices::distance(0, static_cast<std::int32_t>(static_cast<std::uint32_t>(position) + moved));
  }

  friend bool operator==(const Tmc429RampState&, const Tmc429RampState&) = default;
};

}  // namespace opentmcl::twin
