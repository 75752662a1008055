#include "apps/tmcl/physical_value.hpp"

#include <fmt/format.h>

#include "apps/tmcl/context.hpp"
#include "client/units.hpp"

namespace opentmcl::app {

using client::Client;
using client::Result;

namespace {

Result<std::string> velocity_text(Client& client, std::int32_t value) {
  const Result<std::int32_t> pulse_divisor = client.axis_parameter(AxisParameter::pulse_divisor);
  if (!pulse_divisor) return pulse_divisor.error();
  const Result<std::int32_t> resolution = client.axis_parameter(AxisParameter::microstep_resolution);
  if (!resolution) return resolution.error();
  const double frequency = client::microsteps_per_second(value, *pulse_divisor);
  return fmt::format("{:.1f} microsteps/s = {:.2f} rpm", frequency, client::turns_per_minute(frequency, *resolution));
}

Result<std::string> acceleration_text(Client& client, std::int32_t value) {
  const Result<std::int32_t> pulse_divisor = client.axis_parameter(AxisParameter::pulse_divisor);
  if (!pulse_divisor) return pulse_divisor.error();
  const Result<std::int32_t> ramp_divisor = client.axis_parameter(AxisParameter::ramp_divisor);
  if (!ramp_divisor) return ramp_divisor.error();
  return fmt::format("{:.0f} microsteps/s²",
                     client::microsteps_per_second_squared(value, *pulse_divisor, *ramp_divisor));
}

Result<std::string> current_text(Client& client, double part) {
  const Result<const ModuleDescription*> module = module_of(client);
  if (!module) return module.error();
  return fmt::format("{:.0f} mA", part * (*module)->full_scale_current);
}

}  // namespace

Result<std::string> physical_value(Client& client, Unit unit, std::int32_t value) {
  switch (unit) {
    case Unit::internal_velocity:
      return velocity_text(client, value);
    case Unit::internal_acceleration:
      return acceleration_text(client, value);
    case Unit::current_scale:
      return current_text(client, value / 255.0);
    case Unit::current_steps:
      return current_text(client, (value + 1) / 32.0);
    case Unit::ten_milliseconds:
      return fmt::format("{} ms", value * 10LL);
    case Unit::tenth_volts:
      return fmt::format("{:.1f} V", value / 10.0);
    case Unit::power_of_two:
      return value >= 0 && value < 31 ? fmt::format("{}", 1LL << value) : std::string();
    case Unit::none:
    case Unit::microsteps:
    case Unit::encoder_steps:
    case Unit::milliseconds:
    case Unit::degrees_celsius:
      return fmt::format("{}", name_of(unit));
  }
  return std::string();
}

}  // namespace opentmcl::app
