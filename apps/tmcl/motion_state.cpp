#include "apps/tmcl/motion_state.hpp"

#include <fmt/format.h>

#include "client/units.hpp"

namespace opentmcl::app {

std::string describe(const MotionState& state) {
  const double frequency = client::microsteps_per_second(state.velocity, state.pulse_divisor);
  return fmt::format("position {:11d}  speed {:5d} = {:8.2f} rpm  program {}", state.position, state.velocity,
                     client::turns_per_minute(frequency, state.microstep_resolution), client::name_of(state.program));
}

}  // namespace opentmcl::app
