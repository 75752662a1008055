#include "apps/tmcl/physical_scale.hpp"

#include <initializer_list>

#include "apps/tmcl/context.hpp"
#include "firmware/spec/axis_parameters.hpp"

namespace opentmcl::app {

using client::Client;
using client::Result;
using units::PhysicalScale;

namespace {

struct ScalePart {
  AxisParameter parameter;
  std::int32_t PhysicalScale::*number;
};

constexpr ScalePart pulse_divisor{AxisParameter::pulse_divisor, &PhysicalScale::pulse_divisor};
constexpr ScalePart ramp_divisor{AxisParameter::ramp_divisor, &PhysicalScale::ramp_divisor};
constexpr ScalePart microstep_resolution{AxisParameter::microstep_resolution, &PhysicalScale::microstep_resolution};

Result<PhysicalScale> read(Client& client, std::initializer_list<ScalePart> parts) {
  PhysicalScale scale;
  for (const ScalePart& part : parts) {
    const Result<std::int32_t> value = client.axis_parameter(part.parameter);
    if (!value) return value.error();
    scale.*part.number = *value;
  }
  return scale;
}

Result<PhysicalScale> scale_of_currents(Client& client) {
  const Result<const ModuleDescription*> module = module_of(client);
  if (!module) return module.error();
  return units::factory_scale(**module);
}

}  // namespace

Result<PhysicalScale> physical_scale(Client& client, Unit unit) {
  switch (unit) {
    case Unit::internal_velocity:
      return read(client, {pulse_divisor, microstep_resolution});
    case Unit::internal_acceleration:
      return read(client, {pulse_divisor, ramp_divisor, microstep_resolution});
    case Unit::microsteps:
      return read(client, {microstep_resolution});
    case Unit::current_scale:
    case Unit::current_steps:
      return scale_of_currents(client);
    case Unit::none:
    case Unit::encoder_steps:
    case Unit::milliseconds:
    case Unit::ten_milliseconds:
    case Unit::tenth_volts:
    case Unit::degrees_celsius:
    case Unit::power_of_two:
      break;
  }
  return PhysicalScale{};
}

}  // namespace opentmcl::app
