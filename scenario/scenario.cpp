#include "scenario/scenario.hpp"

namespace opentmcl::scenario {

VirtualModule::Options Scenario::board() const {
  VirtualModule::Options options;
  options.machine = machine;
  options.encoder = encoder;
  return options;
}

twin::World::Mounted Scenario::mounted() const {
  return {.machine = machine, .encoder = twin::ShaftEncoder(encoder)};
}

}  // namespace opentmcl::scenario
