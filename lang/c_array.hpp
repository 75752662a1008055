#pragma once

#include <string>
#include <string_view>

#include "firmware/spec/modules.hpp"
#include "lang/program.hpp"
#include "lang/source.hpp"

namespace opentmcl::lang {

/// A header for C and C++ with the program as an array, for hosts that load it: each row has the seven bytes of an
/// instruction as they stand in a datagram, opcode, type, motor and value with the most significant byte first.
/// `name` becomes part of the names in it; what no identifier can have becomes an underscore.
std::string c_array(const Program& program, const Sources& sources, const ModuleDescription& module,
                    std::string_view name);

}  // namespace opentmcl::lang
