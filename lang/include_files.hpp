// The files a source can include although nobody has written them: their constants are the symbols of the tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "firmware/spec/modules.hpp"

namespace opentmcl::lang {

inline constexpr const char* parameter_file_name = "TMCLParam.tmc";
inline constexpr const char* interrupt_file_name = "Interrupts.inc";

/// TMCLParam.tmc: the motors, axis parameters and global parameters the module has.
std::string parameter_file(const ModuleDescription& module);

/// Interrupts.inc: the interrupts the module has.
std::string interrupt_file(const ModuleDescription& module);

/// The built-in file of this name, ignoring case.
std::optional<std::string> built_in_file(std::string_view name, const ModuleDescription& module);

}  // namespace opentmcl::lang
