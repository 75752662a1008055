#pragma once

#include <string>

#include "client/error.hpp"
#include "client/file_descriptor.hpp"

namespace opentmcl::server {

/// A pseudo terminal: to a host, a serial port.
struct Pty {
  client::FileDescriptor own_side;
  /// The host's side. Held open so that our side does not hang up whenever a host closes it, and keeps its settings.
  client::FileDescriptor terminal;
  std::string path;  ///< what a host opens: "/dev/pts/3"

  /// Bytes pass unchanged and unechoed even before a host has configured the port. Error: input_output.
  static client::Result<Pty> open();
};

}  // namespace opentmcl::server
