#include "server/open_transport.hpp"

#include <string>

#include "client/port_address.hpp"
#include "client/serial_transport.hpp"
#include "client/tcp_transport.hpp"
#include "server/simulated_transport.hpp"

namespace opentmcl::server {

namespace {

using Opened = client::Result<std::unique_ptr<client::Transport>>;

Opened open(const client::SerialAddress& address, client::Duration) {
  return client::open_serial(address.path);
}

Opened open(const client::TcpAddress& address, client::Duration limit) {
  return client::connect_tcp(address.host, address.port, limit);
}

Opened open(const client::SimulatedAddress& address, client::Duration) {
  const ModuleDescription* description = find_module(address.module);
  if (description != nullptr) return {std::make_unique<SimulatedTransport>(*description)};
  std::string known;
  for (const ModuleDescription& module : modules)
    known += std::string(known.empty() ? "" : " or ") + "sim:" + module.argument;
  return client::Error{client::ErrorKind::usage, "no virtual module \"" + address.module + "\": expected " + known, {}};
}

}  // namespace

const ModuleDescription* find_module(std::string_view argument) {
  for (const ModuleDescription& module : modules) {
    if (argument == module.argument) return &module;
  }
  return nullptr;
}

Opened open_transport(std::string_view address, client::Duration limit) {
  const client::Result<client::PortAddress> parsed = client::parse_port_address(address);
  if (!parsed) return parsed.error();
  return std::visit([limit](const auto& kind) { return open(kind, limit); }, *parsed);
}

}  // namespace opentmcl::server
