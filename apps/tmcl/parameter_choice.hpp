// The parameter that `tmcl get` and `tmcl set` are about.
#pragma once

#include <string>

#include "apps/tmcl/parameter_name.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace opentmcl::app {

struct ParameterChoice {
  std::string parameter;
  int bank_number = -1;  ///< of a global parameter; negative for an axis parameter

  bool is_global() const { return bank_number >= 0; }
  Bank bank() const { return static_cast<Bank>(bank_number); }

  /// Error: usage.
  client::Result<NamedParameter> find() const;
};

/// PARAMETER and --global.
void add_options(CLI::App& command, ParameterChoice& choice);

}  // namespace opentmcl::app
