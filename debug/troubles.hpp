#pragma once

#include <cstdint>
#include <string>

#include "client/client.hpp"
#include "debug/twin_powers.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::debug {

/// Trouble bits of `wanted` that a module shows now. Only reads that change nothing: parameter 207, which says what has
/// stopped the motor, forgets it when it is read, and the program could miss it. So a stall is what the driver
/// measures while the motor turns (parameter 208), a deviation the difference of parameters 1 and 209 above 212.
client::Result<std::uint8_t> troubles_of(client::Client& client, const ModuleDescription& module, std::uint8_t wanted);

/// "stall, under-voltage".
std::string names_of_troubles(std::uint8_t troubles);

}  // namespace opentmcl::debug
