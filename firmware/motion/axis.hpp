#pragma once

#include <cstdint>

#include "firmware/chip/tmc429_driver.hpp"
#include "firmware/hal/hal.hpp"
#include "firmware/motion/axis_settings.hpp"
#include "firmware/motion/encoder_position.hpp"
#include "firmware/motion/motion_guard.hpp"
#include "firmware/motion/power_stage.hpp"
#include "firmware/motion/ramp_state.hpp"

namespace opentmcl {

/// One motor: the ramp generator, its power stage and encoder, what stops it at once, and 32-bit positions over the
/// chip's 24-bit counter. Nothing else moves the motor.
class Axis {
 public:
  Axis(ModuleId module, const Hal& hal);

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

  /// Stops the motor at once and keeps it from moving, whatever is commanded: there is no motor supply.
  void lock();
  /// Brings both chips up again, as the driver has lost its registers. The position stays, the motor stands until the
  /// next motion command.
  void unlock(const Wiring& wiring);
  bool is_locked() const { return locked_; }

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

  EncoderPosition& encoder() { return encoder_; }

  /// stallGuard2 value, 0…1023.
  std::int32_t load_value() { return power_stage_.load_value(); }
  /// Current scale in force, 0…31.
  std::int32_t actual_current_scale() { return power_stage_.actual_current_scale(); }
  /// Parameter 208: the low eight bits of every reply of the driver.
  std::int32_t driver_flags() { return power_stage_.flags(); }

  /// Parameter 207, AxisEvent bits: reading clears it, as every motion command does.
  std::int32_t take_error_flags();
  /// The same flags, which stay.
  std::uint8_t error_flags() const { return error_flags_; }

  /// Something happened since take_events().
  bool has_events() const { return events_ != 0; }
  /// @return AxisEvent bits
  std::uint8_t take_events();

  /// Watches the motor: stops it at a stall or a deviation, chooses its current, keeps the chip's target ahead on moves
  /// longer than its reach. To be called when it is due.
  void poll(Microseconds now);
  bool is_due(Microseconds now) const { return awake_ || is_look_due(now); }
  /// A motion command was carried out since the last poll().
  bool is_awake() const { return awake_; }
  /// Due for a look at motor and surroundings, not only because of a command.
  bool is_look_due(Microseconds now) const { return now >= next_look_; }
  /// When it is next due, if there is no command before.
  Microseconds due() const { return next_look_; }

  /// An input changed: the next poll() looks at it.
  void look_again() { next_look_ = 0; }

 private:
  void bring_up(const Wiring& wiring);
  void write_mode();
  void write_braking_factor();
  void write_target();
  void stop_at_once();
  void stop_because_of(AxisEvent event);
  void note(AxisEvent event) { events_ |= static_cast<std::uint8_t>(event); }
  bool is_positioning() const;
  bool is_held_by_switch(std::int32_t target_velocity);
  RampState ramp_state();
  void wake() { awake_ = true; }
  void lead_target();
  void note_obstacles(const RampState& ramp);
  bool guard(const RampState& ramp, std::uint32_t inputs);

  AxisSettings settings_;
  Tmc429Driver tmc429_;
  hal::Pins& pins_;
  PowerStage power_stage_;
  EncoderPosition encoder_;
  MotionGuard guard_;
  std::int32_t position_ = 0;         ///< as last read, microsteps
  std::int32_t target_position_ = 0;  ///< microsteps
  std::int32_t chip_target_ = 0;      ///< where the chip drives to: the target, or a point on the way
  bool limit_stops_enabled_ = true;
  bool locked_ = false;
  bool awake_ = true;
  bool is_held_ = false;              ///< by a limit switch, as last looked
  bool driver_is_shut_down_ = false;  ///< as last looked
  std::uint8_t error_flags_ = 0;      ///< parameter 207
  std::uint8_t events_ = 0;           ///< AxisEvent bits
  Microseconds next_look_ = 0;
};

}  // namespace opentmcl
