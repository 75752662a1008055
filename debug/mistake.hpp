#pragma once

#include <string>
#include <utility>

#include "client/error.hpp"

namespace opentmcl::debug {

/// Something that a person, or the editor of one, asked for and that cannot be done.
/// @param message what is wrong, and what was expected
inline client::Error mistake(std::string message) {
  return {client::ErrorKind::usage, std::move(message), {}};
}

}  // namespace opentmcl::debug
