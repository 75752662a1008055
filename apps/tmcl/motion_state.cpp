#include "apps/tmcl/motion_state.hpp"

#include <fmt/format.h>

#include "firmware/module/module.hpp"
#include "units/physical_value.hpp"

namespace opentmcl::app {

MotionState motion_state_of(VirtualModule& module) {
  const Module::Snapshot snapshot = module.module().snapshot();
  return {snapshot.position, snapshot.velocity, snapshot.microstep_resolution, snapshot.pulse_divisor,
          static_cast<client::ProgramStatus::State>(snapshot.program)};
}

std::string describe(const MotionState& state) {
  units::PhysicalScale scale;
  scale.pulse_divisor = state.pulse_divisor;
  scale.microstep_resolution = state.microstep_resolution;
  const double frequency = units::microsteps_per_second(state.velocity, scale);
  return fmt::format("position {:11d}  speed {:5d} = {:8.2f} rpm  program {}", state.position, state.velocity,
                     units::turns_per_minute(frequency, scale), client::name_of(state.program));
}

}  // namespace opentmcl::app
