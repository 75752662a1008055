#pragma once

#include <string>

namespace opentmcl::scenario {

/// The JSON schema of scenario files, for editors that know schemas of TOML: docs/scenario.schema.json. It is made from
/// the tables that the reader uses. What it cannot say, such as what a condition is, only the reader checks.
std::string scenario_schema();

/// Everything that can be recorded, compared and changed, as a page: docs/signals.md.
std::string signals_document();

}  // namespace opentmcl::scenario
