// A virtual module with a motor that has inertia, a load angle and a torque it can be asked too much of.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "firmware/motion/motion_guard.hpp"
#include "tests/module/bench.hpp"

namespace opentmcl::tests {

/// Microsteps of 1/256 full step: what a microstep is to these tests unless they change parameter 140.
inline constexpr std::int32_t full_step = 256;
inline constexpr std::int32_t turn = 200 * full_step;

/// Units of parameter 4 and its like a revolution per minute: 16·10⁶ / (2^0 × 2048 × 32) microsteps a second each
/// (PD-1161 manual 6.1.1).
inline constexpr double velocity_per_rpm = turn / 60.0 / (16e6 / 65'536.0);
inline std::int32_t velocity_of(double rpm) {
  return static_cast<std::int32_t>(std::lround(rpm * velocity_per_rpm));
}

/// N m, with which the motor of both modules holds at its full current: more is above every pull-out torque.
double holding_torque();

/// The motor of both modules on a shaft that turns freely.
VirtualModule::Options free_shaft();

/// In parameter 207.
constexpr std::int32_t flag_of(AxisEvent stop) {
  return static_cast<std::int32_t>(stop);
}

/// For the names of tests that are done with both modules.
std::string name_of_module(const testing::TestParamInfo<ModuleId>& tested);

class MotorBench : public Bench {
 public:
  /// Pulse divisor 0, so that all speeds up to 585 rpm can be had, and the full current of the module.
  explicit MotorBench(const ModuleDescription& description, const VirtualModule::Options& options = free_shaft(),
                      twin::TraceObserver* observer = nullptr);

  const twin::World& world() const { return module.world(); }
  const twin::Tmc262& driver() const { return world().tmc262(); }
  const twin::MotorShaft& motor() const { return *world().motor(); }

  void wait_ms(unsigned milliseconds) { wait(milliseconds * one_millisecond); }
  /// N m against rising positions, from now on.
  void set_load_torque(double torque);
  /// N m against any motion, from now on.
  void set_brake(double torque);
  /// From now on the shaft stays where it is.
  void jam();
  /// Turns on at that speed, up to speed when this returns. @param rpm negative to the left
  void rotate(double rpm);

  std::int32_t speed() { return get(AxisParameter::actual_speed); }
  std::int32_t position() { return get(AxisParameter::actual_position); }
  /// The ramp generator's, read at the chip: takes no time. Only while 24 bits hold it.
  std::int32_t position_at_once() const;
  double rotor_rpm() const { return motor().state().velocity / twin::MotorData::pole_pairs * 60; }
  /// Full steps of the ramp generator which the rotor has not made.
  double full_steps_lost();
};

}  // namespace opentmcl::tests
