#pragma once

#include <cstdint>
#include <string>

#include "client/client.hpp"
#include "firmware/spec/parameter_rows.hpp"

namespace opentmcl::app {

/// What a number means: "30517.6 microsteps/s = 35.76 rpm", "1405 mA". Asks the module for the divisors a unit depends
/// on. Empty where the number says it all.
client::Result<std::string> physical_value(client::Client& client, Unit unit, std::int32_t value);

}  // namespace opentmcl::app
