// The ramp and pulse generator of one TMC429 axis: parameters and time in, steps out. Integers only.
#pragma once

#include <cstdint>

#include "firmware/chip/tmc429_registers.hpp"

namespace opentmcl::twin {

/// Counts time in ticks of 32 clocks, the common input of both dividers (datasheet page 28).
class Tmc429Ramp {
 public:
  struct Settings {
    std::int32_t target_position = 0;       ///< X_TARGET, 24 bit signed
    std::int32_t minimum_velocity = 0;      ///< V_MIN, 0…2047
    std::int32_t maximum_velocity = 0;      ///< V_MAX, 0…2047
    std::int32_t target_velocity = 0;       ///< V_TARGET, -2048…2047
    std::int32_t maximum_acceleration = 0;  ///< A_MAX, 0…2047
    std::uint32_t multiplier = 128;         ///< PMUL with its fixed top bit, 128…255
    std::uint32_t divisor = 0;              ///< PDIV, 0…15
    tmc429::RampMode mode = tmc429::RampMode::ramp;
    unsigned pulse_divider = 0;  ///< a pulse tick every 2^n ticks, 0…13
    unsigned ramp_divider = 0;   ///< a ramp tick every 2^n ticks, 0…13

    friend bool operator==(const Settings&, const Settings&) = default;
  };

  /// The directions in which stop switches forbid motion.
  struct Blocked {
    bool decreasing = false;
    bool increasing = false;
    bool soft_stop = false;  ///< stop with A_MAX instead of at once

    friend bool operator==(const Blocked&, const Blocked&) = default;
  };

  const Settings& settings() const { return settings_; }
  void configure(const Settings& settings);

  std::int32_t position() const { return position_; }
  void set_position(std::int32_t position);

  /// V_ACTUAL: the integer part of the velocity.
  std::int32_t velocity() const;
  /// Takes effect at once and clears the fraction.
  void set_velocity(std::int32_t velocity);
  /// Also true for a velocity below 1, which V_ACTUAL shows as 0.
  bool moving() const { return velocity_ != 0; }
  bool decreasing() const { return velocity_ < 0; }

  /// A_ACTUAL: the change of velocity on the last ramp tick, in 1/256 velocity units.
  std::int32_t acceleration() const { return acceleration_; }

  void block(Blocked blocked);
  /// True once after a switch has stopped, or begun to stop, a motion.
  bool take_stop_event();

  bool at_target() const { return position_ == settings_.target_position; }

  /// Runs until `end`, or until the first step if that comes earlier; true when there was a step, which then happened
  /// at now(). Costs nothing while nothing changes.
  bool advance_to_step(std::uint64_t end);
  std::uint64_t now() const { return now_; }

  friend bool operator==(const Tmc429Ramp&, const Tmc429Ramp&) = default;

 private:
  bool positioning() const { return settings_.mode <= tmc429::RampMode::soft; }
  bool runs_into(const Blocked& blocked) const;
  void obey_switches();
  std::uint32_t pulse_increment() const;
  std::uint64_t next_step_tick() const;
  void accumulate_until(std::uint64_t tick);
  void ramp_tick();
  std::int32_t limited_velocity_to_target(std::int32_t distance) const;
  void approach(std::int32_t goal);
  bool pulse_tick();

  Settings settings_;
  Blocked blocked_;
  bool stop_event_ = false;
  std::int32_t position_ = 0;
  std::int32_t velocity_ = 0;  ///< 1/256 of the unit of V_ACTUAL
  std::int32_t acceleration_ = 0;
  std::uint32_t accumulator_ = 0;  ///< 0…2047, the phase within a step
  std::uint64_t now_ = 0;          ///< ticks since power-on
  /// The last ramp tick changed nothing and nothing happened since, so that further ones change nothing either.
  bool settled_ = false;
};

}  // namespace opentmcl::twin
