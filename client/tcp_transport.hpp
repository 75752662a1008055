#pragma once

#include <memory>
#include <string>

#include "client/transport.hpp"

namespace opentmcl::client {

/// Connects to a module, gateway or virtual module that carries raw 9-byte datagrams over TCP.
/// @param host name, IPv4 or IPv6 address (without brackets)
/// @param port 1…65535
/// @param limit for each address the name stands for
/// Errors: no_such_device (unknown host, nobody listens, no answer), input_output.
Result<std::unique_ptr<Transport>> connect_tcp(const std::string& host, unsigned port, Duration limit);

}  // namespace opentmcl::client
