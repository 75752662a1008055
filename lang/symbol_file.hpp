#pragma once

#include <string>

#include "firmware/spec/modules.hpp"
#include "lang/assembler.hpp"

namespace opentmcl::lang {

/// Labels with their addresses, then constants with their values, each with its place; without those of the built-in
/// files. The file is TMCL itself: each line defines a constant, so that a host's program or another source can include
/// it. `result` has a program.
std::string symbol_file(const AssemblyResult& result, const ModuleDescription& module);

}  // namespace opentmcl::lang
