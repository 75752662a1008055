#pragma once

#include <string>

#include "tests/conformance/conformance_table.hpp"

namespace opentmcl::conformance {

/// docs/conformance.md: manual section, its statements, their state.
std::string document_of(const ConformanceTable& table);

}  // namespace opentmcl::conformance
