#pragma once

#include <string>

namespace opentmcl::app {

/// All tables of firmware/spec as one JSON document.
std::string spec_as_json();

/// The same for reading: a heading for each table, a line for each row.
std::string spec_as_text();

}  // namespace opentmcl::app
