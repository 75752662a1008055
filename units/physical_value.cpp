#include "units/physical_value.hpp"

#include <charconv>
#include <cmath>
#include <cstddef>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/lookup.hpp"

namespace opentmcl::units {
namespace {

std::string fixed(double value, int decimals) {
  char digits[400];  // the longest double has 309 digits before the point
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, decimals);
  return {digits, end};
}

/// Without zeros at the end.
std::string up_to(double value, int decimals) {
  std::string digits = fixed(value, decimals);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

std::string turns_text(std::int32_t microsteps, const PhysicalScale& scale, int decimals) {
  const std::string number = up_to(turns(microsteps, scale), decimals);
  return number + (number == "1" || number == "-1" ? " turn" : " turns");
}

std::string rpm_text(std::int32_t velocity, const PhysicalScale& scale, int decimals) {
  return fixed(turns_per_minute(microsteps_per_second(velocity, scale), scale), decimals) + " rpm";
}

/// The speed gained in a second.
std::string rpm_per_second_text(std::int32_t acceleration, const PhysicalScale& scale, int decimals) {
  return fixed(turns_per_minute(microsteps_per_second_squared(acceleration, scale), scale), decimals) + " rpm/s";
}

std::string current_text(double part, const PhysicalScale& scale) {
  return fixed(part * scale.full_scale_current, 0) + " mA";
}

std::string power_text(std::int32_t exponent) {
  return exponent >= 0 && exponent < 31 ? std::to_string(std::int64_t{1} << exponent) : std::string();
}

const ParameterColumn& column_of(AxisParameter parameter, const ModuleDescription& module) {
  return axis_parameter_columns[static_cast<std::size_t>(module.id)][row_of(parameter)];
}

/// The number of a scale that an axis parameter is, or nullptr.
std::int32_t* number_of(std::uint8_t parameter, PhysicalScale& scale) {
  switch (static_cast<AxisParameter>(parameter)) {
    case AxisParameter::pulse_divisor:
      return &scale.pulse_divisor;
    case AxisParameter::ramp_divisor:
      return &scale.ramp_divisor;
    case AxisParameter::microstep_resolution:
      return &scale.microstep_resolution;
    default:
      return nullptr;
  }
}

}  // namespace

PhysicalScale factory_scale(const ModuleDescription& module) {
  PhysicalScale scale;
  scale.pulse_divisor = column_of(AxisParameter::pulse_divisor, module).default_value;
  scale.ramp_divisor = column_of(AxisParameter::ramp_divisor, module).default_value;
  scale.microstep_resolution = column_of(AxisParameter::microstep_resolution, module).default_value;
  scale.full_scale_current = module.full_scale_current;
  return scale;
}

void follow(const Command& command, const ModuleDescription& module, PhysicalScale& scale) {
  if (command.opcode != static_cast<std::uint8_t>(Opcode::sap) || command.motor != 0) return;
  std::int32_t* const number = number_of(command.type, scale);
  if (number == nullptr) return;
  const ParameterColumn& column = column_of(static_cast<AxisParameter>(command.type), module);
  if (command.value >= column.minimum && command.value <= column.maximum) *number = command.value;
}

double microsteps_per_second(std::int32_t velocity, const PhysicalScale& scale) {
  return chip_clock * velocity / (std::ldexp(1.0, scale.pulse_divisor) * 2048 * 32);
}

double microsteps_per_second_squared(std::int32_t acceleration, const PhysicalScale& scale) {
  return chip_clock * chip_clock * acceleration / std::ldexp(1.0, scale.pulse_divisor + scale.ramp_divisor + 29);
}

double turns(double microsteps, const PhysicalScale& scale) {
  return microsteps / (scale.full_steps_per_turn * std::ldexp(1.0, scale.microstep_resolution));
}

double turns_per_minute(double microsteps_per_second, const PhysicalScale& scale) {
  return 60 * turns(microsteps_per_second, scale);
}

std::string physical_value(Unit unit, std::int32_t value, const PhysicalScale& scale) {
  switch (unit) {
    case Unit::internal_velocity:
      return fixed(microsteps_per_second(value, scale), 1) + " microsteps/s = " + rpm_text(value, scale, 2);
    case Unit::internal_acceleration:
      return fixed(microsteps_per_second_squared(value, scale), 0) +
             " microsteps/s² = " + rpm_per_second_text(value, scale, 1);
    case Unit::microsteps:
      return std::to_string(value) + " " + name_of(unit) + " = " + turns_text(value, scale, 5);
    case Unit::encoder_steps:
    case Unit::milliseconds:
    case Unit::degrees_celsius:
      return std::to_string(value) + " " + name_of(unit);
    case Unit::none:
    case Unit::current_scale:
    case Unit::current_steps:
    case Unit::ten_milliseconds:
    case Unit::tenth_volts:
    case Unit::power_of_two:
      break;
  }
  return short_physical_value(unit, value, scale);
}

std::string short_physical_value(Unit unit, std::int32_t value, const PhysicalScale& scale) {
  switch (unit) {
    case Unit::internal_velocity:
      return rpm_text(value, scale, 1);
    case Unit::internal_acceleration:
      return rpm_per_second_text(value, scale, 0);
    case Unit::microsteps:
      return turns_text(value, scale, 3);
    case Unit::current_scale:
      return current_text(value / 255.0, scale);
    case Unit::current_steps:
      return current_text((value + 1.0) / 32, scale);
    case Unit::ten_milliseconds:
      return std::to_string(std::int64_t{value} * 10) + " ms";
    case Unit::tenth_volts:
      return fixed(value / 10.0, 1) + " V";
    case Unit::power_of_two:
      return power_text(value);
    case Unit::encoder_steps:
    case Unit::milliseconds:
    case Unit::degrees_celsius:
      return std::to_string(value) + " " + name_of(unit);
    case Unit::none:
      break;
  }
  return {};
}

std::string number_with_physical_value(Unit unit, std::int32_t value, const PhysicalScale& scale) {
  std::string number = std::to_string(value);
  std::string physical = physical_value(unit, value, scale);
  if (physical.empty()) return number;
  // "51200 microsteps = 1 turn" begins with the number already.
  return physical.compare(0, number.size() + 1, number + " ") == 0 ? physical : number + " = " + physical;
}

}  // namespace opentmcl::units
