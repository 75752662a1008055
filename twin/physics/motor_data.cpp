#include "twin/physics/motor_data.hpp"

#include <algorithm>

namespace opentmcl::twin {

const MotorData* find_motor(std::string_view name) {
  const std::span<const MotorData> all = motors();
  const auto found =
      std::find_if(all.begin(), all.end(), [name](const MotorData& motor) { return motor.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace opentmcl::twin
