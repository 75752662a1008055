// What a manual states, and how to see whether a module does it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/hal/hal.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::conformance {

struct Statement {
  std::string id;  ///< unique; the name of the test, with the module behind it
  /// Number in the PD-1161 manual ("3.7.4"), or "TM-" and the number in that of the TMCM-1110; several with blanks.
  std::string section;
  std::string says;  ///< the statement, in one sentence
  Modules modules = Modules::both;
  hal::PortKind port = hal::PortKind::usb;  ///< the line the steps use
  /// Number of the decision file when no manual says it. Such a statement is tested too, but does not count as covered.
  std::string decision;
  std::string program;  ///< TMCL source, downloaded before the steps; empty for none
  std::string steps;    ///< lines of the language in README.md
};

using Statements = std::vector<Statement>;

/// "both", "pd1161" or "tmcm1110". @throws std::runtime_error for anything else
Modules modules_named(std::string_view name);

}  // namespace opentmcl::conformance
