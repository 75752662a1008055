// What the modules' internal numbers are physically. Sources: PD-1161 manual 6.1, erratum E-37.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/spec/modules.hpp"
#include "firmware/spec/parameter_rows.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::units {

inline constexpr double chip_clock = 16e6;  ///< Hz, of the TMC429

/// What the physical value of an internal number depends on.
struct PhysicalScale {
  std::int32_t pulse_divisor = 0;         ///< axis parameter 154
  std::int32_t ramp_divisor = 0;          ///< axis parameter 153
  std::int32_t microstep_resolution = 0;  ///< axis parameter 140: 2^n microsteps per full step
  double full_steps_per_turn = 200;       ///< of the motors these modules are sold with: 1.8° a step
  std::int32_t full_scale_current = 0;    ///< mA RMS at a current parameter of 255
};

/// With the factory settings of a module.
PhysicalScale factory_scale(const ModuleDescription& module);

/// Follows a program in the order of its addresses, not of its execution: an SAP of one of the axis parameters that a
/// scale holds counts from there on, until the next one. A value the module would refuse changes nothing, nor does AAP,
/// whose value nobody knows before the program runs.
void follow(const Command& command, const ModuleDescription& module, PhysicalScale& scale);

double microsteps_per_second(std::int32_t velocity, const PhysicalScale& scale);
double microsteps_per_second_squared(std::int32_t acceleration, const PhysicalScale& scale);
/// Turns of the motor: of a distance in microsteps, of a speed in microsteps per second.
double turns(double microsteps, const PhysicalScale& scale);
/// 60 times the turns per second.
double turns_per_minute(double microsteps_per_second, const PhysicalScale& scale);

/// "30517.6 microsteps/s = 35.76 rpm", "1098 mA", "51200 microsteps = 1 turn". Empty for Unit::none, and for values out
/// of the range a unit has a meaning in.
std::string physical_value(Unit unit, std::int32_t value, const PhysicalScale& scale);

/// The same in as few characters as a note beside a line of source has room for: "35.8 rpm", "1098 mA", "1 turn".
std::string short_physical_value(Unit unit, std::int32_t value, const PhysicalScale& scale);

/// The number and what it is: "1000 = 30517.6 microsteps/s = 35.76 rpm", "200 = 2000 ms", "51200 microsteps = 1 turn",
/// and the number alone where it says it all.
std::string number_with_physical_value(Unit unit, std::int32_t value, const PhysicalScale& scale);

}  // namespace opentmcl::units
