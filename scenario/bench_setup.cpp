#include "scenario/bench_setup.hpp"

#include "boards/twin/module_wiring.hpp"

namespace opentmcl::scenario {

VirtualModule::Options BenchSetup::board() const {
  VirtualModule::Options options;
  options.machine = machine;
  options.encoder = encoder;
  options.motor = motor;
  return options;
}

twin::World::Mounted BenchSetup::mounted(const ModuleDescription& module) const {
  twin::EncoderProperties mounted_encoder = encoder;
  mounted_encoder.kind = wiring_of(module.id).encoder;
  return {.machine = machine, .encoder = twin::ShaftEncoder(mounted_encoder), .motor = motor};
}

void BenchSetup::write_initial(twin::World& world) const {
  for (const Assignment& assignment : initial) assignment.quantity->write(world, assignment.value);
}

}  // namespace opentmcl::scenario
