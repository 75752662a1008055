#include "editor/dap/session.hpp"

#include <utility>

namespace opentmcl::editor::dap {

using client::Result;

Result<SessionRequest> SessionRequest::read(const json& arguments, bool attaches) {
  SessionRequest request;
  request.attaches = attaches;
  const std::pair<const char*, std::string*> texts[] = {{"program", &request.program},
                                                        {"module", &request.module},
                                                        {"defaultModule", &request.default_module},
                                                        {"port", &request.port},
                                                        {"scenario", &request.scenario}};
  for (const auto& [name, text] : texts) {
    Result<std::string> value = optional_text(arguments, name);
    if (!value) return value.error();
    *text = std::move(*value);
  }
  const std::pair<const char*, bool*> truths[] = {
      {"stopOnEntry", &request.stops_on_entry}, {"noDebug", &request.without_debugging}, {"trust", &request.trusts}};
  for (const auto& [name, truth] : truths) {
    const Result<bool> value = optional_truth(arguments, name, *truth);
    if (!value) return value.error();
    *truth = *value;
  }
  if (attaches && request.port.empty()) {
    return mistake("'port' is missing: attaching needs a module that runs already, such as /dev/ttyACM0");
  }
  if (!attaches && request.program.empty()) return mistake("'program' is missing: expected the path of a TMCL source");
  if (!request.scenario.empty() && !request.port.empty() && !request.port.starts_with("sim:")) {
    return mistake("'scenario' is for a twin: leave out 'port', or the scenario");
  }
  return request;
}

}  // namespace opentmcl::editor::dap
