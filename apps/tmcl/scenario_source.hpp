#pragma once

#include <string>

#include "client/error.hpp"
#include "scenario/scenario.hpp"
#include "scenario/scenario_run.hpp"

namespace opentmcl::app {

/// A scenario and the text that says it.
struct ScenarioSource {
  std::string text;
  scenario::Scenario scenario;
};

/// Reads a scenario and prints what is wrong with it on stderr. Errors: bad_file.
client::Result<ScenarioSource> scenario_from_file(const std::string& path);

/// Where the program of a scenario in the file `path` is, from the working directory; empty: it has none.
std::string program_path(const scenario::Scenario& scenario, const std::string& path);

/// Prints on stdout what a scenario in the file `path` says while it runs.
void print_report(const scenario::Report& report, const std::string& path, bool json);

}  // namespace opentmcl::app
