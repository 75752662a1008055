#pragma once

#include <string>

#include "apps/tmcl/context.hpp"
#include "apps/tmcl/sim_endpoints.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::app {

/// Says on stdout where a virtual module is to be found: as text, or as a line of JSON for programs.
/// @param control path of the control interface's socket; empty: none
void introduce(const Context& context, const ModuleDescription& module, const SimEndpoints& endpoints,
               const std::string& control);

}  // namespace opentmcl::app
