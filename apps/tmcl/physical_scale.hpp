#pragma once

#include <cstdint>
#include <string>

#include "client/client.hpp"
#include "firmware/spec/parameter_rows.hpp"
#include "units/physical_value.hpp"

namespace opentmcl::app {

/// The numbers `unit` depends on, as the module has them now; those it does not depend on are not asked for.
client::Result<units::PhysicalScale> physical_scale(client::Client& client, Unit unit);

}  // namespace opentmcl::app
