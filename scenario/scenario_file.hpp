// Reads a scenario from TOML and finds all mistakes in it at once.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/problem.hpp"
#include "scenario/scenario.hpp"

namespace opentmcl::scenario {

struct ScenarioFile {
  std::optional<Scenario> scenario;  ///< none if there is a problem
  std::vector<Problem> problems;     ///< in the order of their places
};

/// Text that is not TOML has one problem; otherwise each mistake is one. Files that it names are not looked at.
ScenarioFile read_scenario(std::string_view text);

/// A line for each problem: "homing.toml:12:9: there is no quantity 'positoin': did you mean position?"
std::string format(const std::vector<Problem>& problems, std::string_view file_name);

}  // namespace opentmcl::scenario
