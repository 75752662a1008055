#pragma once

#include <optional>
#include <string_view>

#include "firmware/spec/modules.hpp"

namespace opentmcl::lang {

/// What a source says it is for: `// module: tmcm1110` on a line of its own before the first statement.
struct ModuleComment {
  std::string_view written;                   ///< the name as the source has it, a part of its text
  const ModuleDescription* module = nullptr;  ///< none if there is no such module
};

/// The first such comment of a source, if it has one (docs/decisions/0074-module-of-a-source.md).
std::optional<ModuleComment> module_named_in(std::string_view text);

/// The module of this name, as on a command line ("tmcm1110") or on its manual ("TMCM-1110"), or nullptr. Case does
/// not matter.
const ModuleDescription* find_module(std::string_view name);

}  // namespace opentmcl::lang
