// Statements that are written out one by one: the TOML files of tables/.
#pragma once

#include <string>

#include "tests/conformance/statement.hpp"

namespace opentmcl::conformance {

/// @throws std::runtime_error with file, line and what is wrong
Statements read_statements(const std::string& path);

}  // namespace opentmcl::conformance
