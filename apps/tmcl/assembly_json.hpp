// What the assembler finds out, for machines. The forms are described in docs/assembler.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "lang/diagnostic.hpp"
#include "lang/program.hpp"
#include "lang/source.hpp"

namespace opentmcl::app {

nlohmann::ordered_json diagnostics_as_json(const std::vector<lang::Diagnostic>& diagnostics,
                                           const lang::Sources& sources);

/// Every warning with its summary.
nlohmann::ordered_json warnings_as_json();

/// Where in the sources each instruction comes from.
std::string source_map_as_json(const lang::Program& program, const lang::Sources& sources,
                               const ModuleDescription& module);

}  // namespace opentmcl::app
