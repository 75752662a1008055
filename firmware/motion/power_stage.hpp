#pragma once

#include <cstdint>

#include "firmware/chip/tmc262_driver.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/motion/axis_settings.hpp"
#include "firmware/motion/driver_fields.hpp"
#include "firmware/motion/ramp_state.hpp"

namespace opentmcl {

/// The TMC262 and how much current it gives the motor: run, boost, slow run, standby or none (parameters 6, 7, 150,
/// 182, 183, 200, 204, 214 and 254). docs/decisions/0022-motor-current.md has the rules.
class PowerStage {
 public:
  PowerStage(ModuleId module, const AxisSettings& settings, hal::SpiDevice& tmc262)
      : module_(module), settings_(settings), tmc262_(tmc262) {}

  /// Writes all registers, as after power-on or an under-voltage of the driver, and starts with the run current.
  void initialise();
  /// Brings a changed driver or current parameter to the chip.
  void apply(AxisParameter parameter);

  /// A motion command comes: no more standby, and not without current.
  void energise();

  /// Chooses the current. @param enable level of the ENABLE input (parameter 254)
  /// @return when to look again while the ramp generator stays at rest, or never
  Microseconds follow(const RampState& ramp, bool enable, Microseconds now);

  /// stallGuard2 value, 0…1023.
  std::int32_t load_value();
  /// Current scale in force, 0…31.
  std::int32_t actual_current_scale();
  /// Parameter 208: the low eight bits of every reply of the driver.
  std::int32_t flags();
  /// The driver switched itself off: over-temperature or short to ground.
  bool is_shut_down();

  /// How often it is looked whether the motor is still moving, as in the vendor's firmware.
  static constexpr Microseconds period = 10 * one_millisecond;

 private:
  enum class Power : std::uint8_t { run, standby, off };

  bool takes_external_steps() const { return settings_[AxisParameter::step_direction_mode] != 0; }
  Microseconds follow_rest(bool at_rest, Microseconds now, Power& power);
  void set(Power power, const RampState& ramp);
  void send_changes();
  void send_current();

  ModuleId module_;
  const AxisSettings& settings_;
  Tmc262Driver tmc262_;
  DriverState state_;
  AxisParameter current_source_ = AxisParameter::maximum_current;  ///< which parameter's current is in force
  Power power_ = Power::run;
  bool at_rest_ = false;
  Microseconds at_rest_since_ = 0;
};

}  // namespace opentmcl
