#include "apps/tmcl/sim_introduction.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "server/port_kinds.hpp"

namespace opentmcl::app {

namespace {

void introduce_as_json(const ModuleDescription& module, const SimEndpoints& endpoints, const std::string& control) {
  fmt::print("{}\n", nlohmann::ordered_json{{"module", module.name},
                                            {"pty", endpoints.pty_path()},
                                            {"link", endpoints.link_path()},
                                            {"port_kind", server::names_of(endpoints.port_kind()).title},
                                            {"tcp", endpoints.tcp_url()},
                                            {"slcan", endpoints.slcan_path()},
                                            {"slcan_link", endpoints.slcan_link_path()},
                                            {"can_udp", endpoints.can_udp_url()},
                                            {"can", endpoints.can_interface()},
                                            {"control", control}}
                         .dump());
}

void introduce_as_text(const ModuleDescription& module, const SimEndpoints& endpoints, const std::string& control) {
  fmt::print("Virtual {}, firmware V{}.{:02}. Talk to it at\n", module.name, module.firmware_major,
             module.firmware_minor);
  fmt::print("  {}  (serial port as {}, a link to {})\n", endpoints.link_path(),
             server::names_of(endpoints.port_kind()).title, endpoints.pty_path());
  const auto name = [](const std::string& endpoint, const std::string& remark) {
    if (!endpoint.empty()) fmt::print("  {}{}\n", endpoint, remark);
  };
  name(endpoints.tcp_url(), "");
  name(endpoints.slcan_link_path(), fmt::format("  (CAN over SLCAN, a link to {})", endpoints.slcan_path()));
  name(endpoints.can_udp_url(), "  (CAN over UDP multicast as python-can does it)");
  name(endpoints.can_interface(), "  (CAN interface)");
  name(control, "  (the bench around it, for tmcl sim ctl)");
  fmt::print("Ctrl-C ends it.\n");
}

}  // namespace

void introduce(const Context& context, const ModuleDescription& module, const SimEndpoints& endpoints,
               const std::string& control) {
  if (context.json) {
    introduce_as_json(module, endpoints, control);
  } else {
    introduce_as_text(module, endpoints, control);
  }
  std::fflush(stdout);
}

}  // namespace opentmcl::app
