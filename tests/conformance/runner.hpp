#pragma once

#include <optional>
#include <string>

#include "firmware/spec/modules.hpp"
#include "tests/conformance/statement.hpp"

namespace opentmcl::conformance {

/// Carries out the steps of a statement on a new module.
/// @return what the first step that went wrong expected and found; nothing when the module does what the statement says
/// @throws std::runtime_error when the statement itself is malformed
std::optional<std::string> run(const Statement& statement, ModuleId module);

}  // namespace opentmcl::conformance
