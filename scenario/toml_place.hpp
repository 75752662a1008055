// Where things stand in a TOML file, and what they are called in messages.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "scenario/scenario.hpp"

namespace opentmcl::scenario {

Place place_of(const toml::source_region& region);
Place place_of(const toml::node& node);

/// Where byte `offset` of a string's content stands. Only that of a basic string on one line without escapes is known
/// exactly; others are named by their begin.
Place place_within(const toml::node& node, std::size_t offset);

/// What is wrong with text that is no TOML.
std::string description_of(const toml::parse_error& error);

/// "a number", "a table".
std::string_view kind_of(const toml::node& node);

}  // namespace opentmcl::scenario
