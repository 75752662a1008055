#pragma once

#include <cstdint>

#include "firmware/chip/tmc262_driver.hpp"
#include "firmware/chip/tmc429_driver.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/motion/axis_settings.hpp"

namespace opentmcl {

/// One motor: the ramp generator, its power stage, and 32-bit positions over the chip's 24-bit counter. Nothing else
/// moves the motor.
class Axis {
 public:
  Axis(ModuleId module, hal::SpiDevice& tmc429, hal::SpiDevice& tmc262);

  /// The values that axis parameters set. After changing one, call apply() with the parameter.
  AxisSettings& settings() { return settings_; }
  const AxisSettings& settings() const { return settings_; }

  /// What bank 0 of the global parameters says about the wiring of the axis.
  struct Wiring {
    bool reverse_shaft = false;          ///< global parameter 90
    bool switches_active_low = false;    ///< global parameter 79
    std::int32_t step_pulse_length = 0;  ///< global parameter 86, 0…15: 1 + n µs
  };

  /// Brings both chips from power-on to the present settings; position 0, motor at rest.
  void initialise(const Wiring& wiring);
  void apply(const Wiring& wiring);

  /// Brings a changed setting to the chips.
  void apply(AxisParameter parameter);

  /// Velocity mode. @param velocity internal units, -2047…2047; positive increases the position
  void rotate(std::int32_t velocity);
  /// Velocity mode with target velocity 0: stops along the ramp.
  void stop() { rotate(0); }
  /// Position mode. Distances wrap at 32 bits: more than 2^31 - 1 goes the other way round (manual 3.7.4).
  void move_to(std::int32_t position);

  /// @return microsteps
  std::int32_t position();
  std::int32_t target_position() const { return target_position_; }
  /// Sets the counter. In position mode the motor then drives back to its target, as the chip does.
  void set_position(std::int32_t position);
  /// Sets the target without selecting position mode.
  void set_target_position(std::int32_t position);
  /// Sets the chip's target velocity without selecting velocity mode. @param velocity -2047…2047
  void set_target_velocity(std::int32_t velocity);

  std::int32_t target_velocity() { return tmc429_.value<tmc429::TargetVelocity>(); }
  std::int32_t actual_velocity() { return tmc429_.value<tmc429::ActualVelocity>(); }
  std::int32_t actual_acceleration() { return tmc429_.value<tmc429::ActualAcceleration>(); }
  bool position_reached() { return position() == target_position_; }
  bool left_switch_active();
  bool right_switch_active();

  /// Lets the limit switches stop the motor as parameters 12 and 13 say, or not at all (reference search).
  void enable_limit_stops(bool enabled);

  /// stallGuard2 value, 0…1023.
  std::int32_t load_value();
  /// Current scale in force, 0…31.
  std::int32_t actual_current_scale();
  /// Parameter 208: the low eight bits of every reply of the driver.
  std::int32_t driver_flags();

  /// Sets the current. @param current 0…255, see parameter 6
  void set_current(std::int32_t current);

  /// Follows the position counter, keeps the chip's target ahead on moves longer than its reach, and switches between
  /// run and standby current. @return when it must be called again
  Microseconds poll(Microseconds now) { return awake_ || now >= next_check_ ? follow_motion(now) : next_check_; }

  /// A motion command was carried out: poll() has work to do at once.
  bool is_awake() const { return awake_; }

 private:
  enum class Power : std::uint8_t { run, settling, standby };

  void write_mode();
  void write_braking_factor();
  void write_target();
  void apply_driver();
  bool is_positioning() const;
  void wake();
  Microseconds follow_motion(Microseconds now);
  Microseconds follow_position(Microseconds now);
  Microseconds follow_current(Microseconds now);

  AxisSettings settings_;
  Tmc429Driver tmc429_;
  Tmc262Driver tmc262_;
  std::int32_t position_ = 0;         ///< as last read, microsteps
  std::int32_t target_position_ = 0;  ///< microsteps
  std::int32_t chip_target_ = 0;      ///< where the chip drives to: the target, or a point on the way
  bool limit_stops_enabled_ = true;
  bool awake_ = true;
  Power power_ = Power::run;
  Microseconds at_rest_since_ = 0;
  Microseconds next_check_ = 0;
};

}  // namespace opentmcl
