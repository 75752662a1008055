#include "scenario/bench_setup.hpp"

#include <variant>

#include "boards/twin/module_wiring.hpp"
#include "scenario/section.hpp"

namespace opentmcl::scenario {

std::string_view name_of(const twin::MachineDimensions& machine) {
  std::string_view name;
  for_each_machine_kind([&](const MachineKind& kind, auto, auto dimensions) {
    if (std::holds_alternative<decltype(dimensions)>(machine)) name = kind.name;
  });
  return name;
}

std::string_view name_of(const std::optional<twin::MotorData>& motor) {
  return motor ? motor->name : ideal_motor;
}

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
