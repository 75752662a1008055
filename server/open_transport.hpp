#pragma once

#include <memory>
#include <string_view>

#include "client/transport.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::server {

/// The module with this name on a command line ("pd1161"), or nullptr.
const ModuleDescription* find_module(std::string_view argument);

/// Opens what the user calls a port: /dev/ttyACM0, tcp://HOST:PORT or sim:MODULE.
/// @param limit for a TCP connection to come about
/// Errors: usage, no_such_device, input_output.
client::Result<std::unique_ptr<client::Transport>> open_transport(std::string_view address, client::Duration limit);

}  // namespace opentmcl::server
