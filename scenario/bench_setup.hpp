// What stands on the bench of a module: the machine, its motor and encoder, and how all of it is in the beginning.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "firmware/spec/modules.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::scenario {

struct Assignment {
  const twin::Quantity* quantity;
  double value;  ///< in its unit, and one that it can have
};

/// As `kind` in [machine] has it.
std::string_view name_of(const twin::MachineDimensions& machine);
/// As `name` in [motor] has it.
std::string_view name_of(const std::optional<twin::MotorData>& motor);

/// Scenarios and farms describe it in the same words (docs/scenarios.md).
struct BenchSetup {
  twin::MachineDimensions machine = twin::LinearStageDimensions{};
  twin::EncoderProperties encoder;  ///< its kind is that of the module
  /// Nothing: an ideal one, whose rotor is always where the field is.
  std::optional<twin::MotorData> motor = twin::motors().front();
  std::vector<Assignment> initial;  ///< the load first

  /// Of a virtual module on this bench.
  VirtualModule::Options board() const;
  /// Of a world with it.
  twin::World::Mounted mounted(const ModuleDescription& module) const;
  /// To be called before the module gets its supply.
  void write_initial(twin::World& world) const;
};

}  // namespace opentmcl::scenario
