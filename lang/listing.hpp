#pragma once

#include <string>

#include "lang/program.hpp"
#include "lang/source.hpp"

namespace opentmcl::lang {

/// The sources with address and bytes before each line that became an instruction. Files without instructions are left
/// out, but never the first.
std::string listing(const Program& program, const Sources& sources);

}  // namespace opentmcl::lang
