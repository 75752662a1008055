#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "editor/dap/protocol.hpp"

namespace opentmcl::editor::dap {

/// What the adapter can do with every module: the body of an initialize response.
json capabilities();

/// What it can do with a twin beyond that: the body of a capabilities event.
json capabilities_of_twins();

/// Trouble bits (debug/twin_powers.hpp) of the exception filters. Error: usage, for one that does not exist.
client::Result<std::uint8_t> troubles_of_filters(const json& arguments);

}  // namespace opentmcl::editor::dap
