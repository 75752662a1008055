#include "twin/physics/motor_data.hpp"

#include <algorithm>
#include <iterator>

namespace opentmcl::twin {
namespace {

constexpr MotorData motor_table[] = {
#include "motors.inc"  // made from twin/motors/motors.toml
};

}  // namespace

std::span<const MotorData> motors() {
  return motor_table;
}

const MotorData* find_motor(std::string_view name) {
  const auto* const found = std::find_if(std::begin(motor_table), std::end(motor_table),
                                         [name](const MotorData& motor) { return motor.name == name; });
  return found == std::end(motor_table) ? nullptr : found;
}

}  // namespace opentmcl::twin
