#include "scenario/scenario.hpp"

#include "boards/twin/module_wiring.hpp"

namespace opentmcl::scenario {

VirtualModule::Options Scenario::board() const {
  VirtualModule::Options options;
  options.machine = machine;
  options.encoder = encoder;
  options.motor = motor;
  return options;
}

twin::World::Mounted Scenario::mounted() const {
  twin::EncoderProperties mounted_encoder = encoder;
  mounted_encoder.kind = wiring_of(module->id).encoder;
  return {.machine = machine, .encoder = twin::ShaftEncoder(mounted_encoder), .motor = motor};
}

}  // namespace opentmcl::scenario
