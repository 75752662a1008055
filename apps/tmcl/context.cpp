#include "apps/tmcl/context.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "apps/tmcl/quantity.hpp"
#include "server/open_transport.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

Result<Connection> Context::connect() const {
  const Result<Microseconds> limit = parse_duration(time_limit);
  if (!limit) return limit.error();
  client::Client::Options options;
  options.address = static_cast<std::uint8_t>(address);
  options.time_limit = client::Duration(*limit);

  Result<std::unique_ptr<client::Transport>> transport = server::open_transport(port, options.time_limit);
  if (!transport) return transport.error();
  auto opened = std::make_unique<client::Client>(**transport, options);
  return Connection{std::move(*transport), std::move(opened)};
}

void Context::finish(const Result<void>& result) {
  if (result.ok()) return;
  fmt::print(stderr, "tmcl: {}\n", result.error().message);
  exit_code = client::exit_code_of(result.error().kind);
}

Result<const ModuleDescription*> module_of(client::Client& client) {
  const Result<client::FirmwareVersion> version = client.firmware_version();
  if (!version) return version.error();
  if (const ModuleDescription* module = version->module()) return module;
  return Error{ErrorKind::protocol,
               fmt::format("the module says it is a {}, whose commands are not known here; choose one that comes close "
                           "with --module",
                           version->type_number),
               {}};
}

Result<const ModuleDescription*> named_module(const std::string& argument) {
  if (const ModuleDescription* module = server::find_module(argument)) return module;
  std::string known;
  for (const ModuleDescription& module : modules) {
    known += fmt::format("{}{}", known.empty() ? "" : " or ", module.argument);
  }
  return Error{ErrorKind::usage, fmt::format("no module \"{}\": expected {}", argument, known), {}};
}

Result<const ModuleDescription*> chosen_module(const std::string& argument, client::Client& client) {
  return argument.empty() ? module_of(client) : named_module(argument);
}

}  // namespace opentmcl::app
