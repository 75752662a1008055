// Numbers with units, as typed on the command line.
#pragma once

#include <string>
#include <string_view>

#include "client/error.hpp"
#include "firmware/hal/time.hpp"

namespace opentmcl::app {

/// "5s", "500ms", "2min", "1.5h", "250us". Error: usage.
client::Result<Microseconds> parse_duration(std::string_view text);

/// "1", "0.1", "100", or "max" for server::Pace::maximum. Error: usage.
client::Result<double> parse_speed(std::string_view text);

}  // namespace opentmcl::app
