#pragma once

#include "firmware/spec/instructions.hpp"

namespace opentmcl::lang {

/// What to write on a module that lacks this instruction: "use JC and CSUB: ...". nullptr if nothing does the same.
const char* substitute_for(Opcode opcode);

}  // namespace opentmcl::lang
