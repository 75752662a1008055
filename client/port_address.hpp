#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "client/error.hpp"

namespace opentmcl::client {

/// A serial port: /dev/ttyACM0.
struct SerialAddress {
  std::string path;
};

/// tcp://HOST:PORT; an IPv6 address stands in brackets.
struct TcpAddress {
  std::string host;
  unsigned port = 0;  ///< 1…65535
};

/// A virtual module inside the process: sim:pd1161.
struct SimulatedAddress {
  std::string module;  ///< ModuleDescription::argument; not checked here
};

using PortAddress = std::variant<SerialAddress, TcpAddress, SimulatedAddress>;

/// What the user gave as --port. Error: usage.
Result<PortAddress> parse_port_address(std::string_view text);

}  // namespace opentmcl::client
