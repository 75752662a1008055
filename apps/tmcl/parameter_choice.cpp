#include "apps/tmcl/parameter_choice.hpp"

#include <CLI/CLI.hpp>

namespace opentmcl::app {

client::Result<NamedParameter> ParameterChoice::find() const {
  return is_global() ? find_global_parameter(parameter, bank()) : find_axis_parameter(parameter);
}

void add_options(CLI::App& command, ParameterChoice& choice) {
  command.add_option("PARAMETER", choice.parameter, "axis parameter: a number, a symbol or a name of `tmcl spec`")
      ->required();
  command.add_option("--global", choice.bank_number, "a global parameter of this bank instead")
      ->check(CLI::Range(0, 3));
}

}  // namespace opentmcl::app
