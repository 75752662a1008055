#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::editor::dap {

/// The user variables that instructions name. Those that only X names (SIV, GIV, AIV) nobody knows before the program
/// runs.
std::set<std::uint8_t> used_variables(const std::vector<Command>& commands, ModuleId module);

}  // namespace opentmcl::editor::dap
