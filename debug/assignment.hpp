#pragma once

#include <string_view>

#include "client/error.hpp"
#include "debug/engine.hpp"

namespace opentmcl::debug {

/// Gives what a person names another value: A, X, VAR(number), GAP(parameter [, motor]), GGP(parameter, bank),
/// GIO(port, bank) or, in a twin, a quantity of the bench.
/// Errors: usage; refused (a parameter that cannot be written, or not with this value); those of client::Client.
client::Result<void> assign(Engine& engine, std::string_view subject, double value);

}  // namespace opentmcl::debug
