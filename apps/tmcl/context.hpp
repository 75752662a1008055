#pragma once

#include <memory>
#include <string>

#include "client/client.hpp"
#include "client/error.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::app {

/// A client and the connection it uses.
struct Connection {
  std::unique_ptr<client::Transport> transport;
  std::unique_ptr<client::Client> client;
};

/// What all sub-commands share: the global options, and where a result becomes an exit code.
struct Context {
  std::string port = "sim:pd1161";
  unsigned address = 1;
  std::string time_limit = "1s";
  bool json = false;
  int exit_code = 0;

  client::Result<Connection> connect() const;

  /// Prints the error, if any, and keeps its exit code.
  void finish(const client::Result<void>& result);
};

/// The module at the other end, by its version. Error: protocol for a type OpenTMCL does not know.
client::Result<const ModuleDescription*> module_of(client::Client& client);

/// The module called `argument`; the one at the other end when that is empty. Error: usage.
client::Result<const ModuleDescription*> chosen_module(const std::string& argument, client::Client& client);
client::Result<const ModuleDescription*> named_module(const std::string& argument);

}  // namespace opentmcl::app
