#include "apps/tmcl/scenario_source.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "apps/tmcl/source_program.hpp"
#include "scenario/scenario_file.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using scenario::Report;

namespace {

constexpr double microseconds_a_second = 1e6;

const char* name_of(Report::Kind kind) {
  switch (kind) {
    case Report::Kind::note:
      return "note";
    case Report::Kind::met:
      return "as expected";
    case Report::Kind::failed:
      return "FAILED";
    case Report::Kind::end:
      return "end";
  }
  return "";
}

}  // namespace

Result<ScenarioSource> scenario_from_file(const std::string& path) {
  Result<std::string> text = read_file(path);
  if (!text) return text.error();
  scenario::ScenarioFile file = scenario::read_scenario(*text);
  if (!file.scenario) {
    fmt::print(stderr, "{}", scenario::format(file.problems, path));
    const std::size_t count = file.problems.size();
    return Error{ErrorKind::bad_file, fmt::format("{} has {} error{}", path, count, count == 1 ? "" : "s"), {}};
  }
  const std::string program = program_path(*file.scenario, path);
  std::error_code cannot_tell;
  if (!program.empty() && !std::filesystem::is_regular_file(program, cannot_tell)) {
    const scenario::Problem problem{file.scenario->program_place, fmt::format("there is no file '{}'", program)};
    fmt::print(stderr, "{}", scenario::format({problem}, path));
    return Error{ErrorKind::bad_file, fmt::format("{} has 1 error", path), {}};
  }
  return ScenarioSource{*std::move(text), *std::move(file.scenario)};
}

std::string program_path(const scenario::Scenario& scenario, const std::string& path) {
  if (scenario.program.empty()) return {};
  return (std::filesystem::path(path).parent_path() / scenario.program).string();
}

void print_report(const Report& report, const std::string& path, bool json) {
  const double seconds = static_cast<double>(report.time) / microseconds_a_second;
  if (json) {
    fmt::print(
        "{}\n",
        nlohmann::ordered_json{
            {"time", seconds}, {"kind", name_of(report.kind)}, {"line", report.place.line}, {"text", report.text}}
            .dump());
  } else {
    // The end by the duration has no place in the file.
    const std::string line = report.place.line == 0 ? "" : fmt::format("{}:", report.place.line);
    fmt::print("{}:{} {:.6f} s: {}: {}\n", path, line, seconds, name_of(report.kind), report.text);
  }
  std::fflush(stdout);
}

}  // namespace opentmcl::app
