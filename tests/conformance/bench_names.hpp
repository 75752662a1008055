// What steps can change and look at around a module, by the names they use.
#pragma once

#include <cstdint>
#include <string_view>

#include "twin/world/world.hpp"

namespace opentmcl::conformance {

/// "left switch", "right switch", "home switch", "enable", "input 0" to "input 7": 0 or 1;
/// "analog 0": converter value; "supply": mV; "temperature": °C; "load": what stallGuard2 measures, 0 to 1023;
/// "step input": so many pulses on the connector, negative ones with the other direction.
/// @throws std::runtime_error for another name
void set_world(twin::World& world, std::string_view name, std::int64_t value);

/// "output 0" to "output 7", "pull-ups": levels; "rotor": angle of the shaft in 1/256 full steps; "current": the
/// current scale SE of the TMC262; "bridges": 1 while current can flow; fields of the TMC262 by the names of its
/// datasheet, such as "TOFF".
/// @throws std::runtime_error for another name
std::int64_t look_at(const twin::World& world, std::string_view name);

}  // namespace opentmcl::conformance
