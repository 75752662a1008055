// Registers that only a twin shows, in words.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "debug/twin_powers.hpp"

namespace opentmcl::debug {

/// "lower", "equal or zero", "greater".
const char* name_of(Comparison comparison);

/// "ETO EDV", as CLE names them; "none".
std::string names_of_error_flags(std::uint8_t flags);

/// Symbols of the built-in include files with their numbers; "none".
std::string names_of_interrupts(const std::vector<std::uint8_t>& numbers);

}  // namespace opentmcl::debug
