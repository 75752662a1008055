#include "scenario/scenario.hpp"

namespace opentmcl::scenario {

VirtualModule::Options Scenario::board() const {
  VirtualModule::Options options;
  options.stage.reset();
  if (machine.kind == MachineDescription::Kind::stage) options.stage = machine.stage;
  return options;
}

}  // namespace opentmcl::scenario
