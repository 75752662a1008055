#include "apps/tmcl/motion_state.hpp"

#include <fmt/format.h>

#include "client/units.hpp"
#include "firmware/module/module.hpp"

namespace opentmcl::app {

MotionState motion_state_of(VirtualModule& module) {
  const Module::Snapshot snapshot = module.module().snapshot();
  return {snapshot.position, snapshot.velocity, snapshot.microstep_resolution, snapshot.pulse_divisor,
          static_cast<client::ProgramStatus::State>(snapshot.program)};
}

std::string describe(const MotionState& state) {
  const double frequency = client::microsteps_per_second(state.velocity, state.pulse_divisor);
  return fmt::format("position {:11d}  speed {:5d} = {:8.2f} rpm  program {}", state.position, state.velocity,
                     client::turns_per_minute(frequency, state.microstep_resolution), client::name_of(state.program));
}

}  // namespace opentmcl::app
