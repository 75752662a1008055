#pragma once

#include <memory>
#include <string>

#include "client/transport.hpp"

namespace opentmcl::client {

/// What the modules start with (global parameter 65 = 0). USB and pseudo terminals ignore it.
inline constexpr unsigned default_baud_rate = 9600;

/// Opens a serial port raw, 8 data bits, no parity, one stop bit, no flow control, and locks it (flock) against other
/// programs that lock too, for as long as the transport lives.
/// Errors: usage (a baud rate the system does not know), no_such_device (missing, not a serial port, no permission, in
/// use), input_output.
Result<std::unique_ptr<Transport>> open_serial(const std::string& path, unsigned baud_rate = default_baud_rate);

}  // namespace opentmcl::client
