#include "editor/dap/capabilities.hpp"

#include <algorithm>
#include <iterator>

#include "debug/twin_powers.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::editor::dap {

using client::Result;

namespace {

struct ExceptionFilter {
  debug::Trouble trouble;
  const char* filter;
  const char* label;
  const char* description;
};

constexpr ExceptionFilter exception_filters[] = {
    {debug::Trouble::stall, "stall", "Stall", "stallGuard2 reports a stall while the motor turns"},
    {debug::Trouble::deviation, "deviation", "Encoder deviation",
     "the encoder is farther off than parameter 212 allows"},
    {debug::Trouble::under_voltage, "underVoltage", "Under-voltage", "the motor supply is too low"},
};

/// Offered always, or only where the module is a twin.
constexpr const char* always[] = {
    "supportsBreakpointLocationsRequest",
    "supportsCancelRequest",
    "supportsConditionalBreakpoints",
    "supportsConfigurationDoneRequest",
    "supportsDataBreakpoints",
    "supportsDisassembleRequest",
    "supportsEvaluateForHovers",
    "supportsExceptionInfoRequest",
    "supportsFunctionBreakpoints",
    "supportsHitConditionalBreakpoints",
    "supportsInstructionBreakpoints",
    "supportsLoadedSourcesRequest",
    "supportsLogPoints",
    "supportsReadMemoryRequest",
    "supportsRestartRequest",
    "supportsSetExpression",
    "supportsSetVariable",
    "supportsSteppingGranularity",
    "supportsTerminateRequest",
    "supportTerminateDebuggee",
    "supportSuspendDebuggee",
};
constexpr const char* with_twins[] = {"supportsStepBack", "supportsGotoTargetsRequest"};

}  // namespace

json capabilities() {
  json body = json::object();
  for (const char* const capability : always) body[capability] = true;
  json filters = json::array();
  for (const ExceptionFilter& row : exception_filters) {
    filters.push_back({{"filter", row.filter}, {"label", row.label}, {"description", row.description}});
  }
  body["exceptionBreakpointFilters"] = std::move(filters);
  return body;
}

json capabilities_of_twins() {
  json body = json::object();
  for (const char* const capability : with_twins) body[capability] = true;
  return {{"capabilities", std::move(body)}};
}

Result<std::uint8_t> troubles_of_filters(const json& arguments) {
  const json& filters = member(arguments, "filters");
  if (!filters.is_array()) return mistake("'filters' must be an array");
  std::uint8_t troubles = 0;
  for (const json& filter : filters) {
    const std::string name = filter.is_string() ? filter.get<std::string>() : filter.dump();
    const auto found = std::find_if(std::begin(exception_filters), std::end(exception_filters),
                                    [&](const ExceptionFilter& row) { return name == row.filter; });
    if (found == std::end(exception_filters)) return mistake("there is no exception filter " + lang::in_quotes(name));
    troubles = static_cast<std::uint8_t>(troubles | static_cast<std::uint8_t>(found->trouble));
  }
  return troubles;
}

}  // namespace opentmcl::editor::dap
