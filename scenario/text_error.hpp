#pragma once

#include <cstddef>
#include <string>
#include <variant>

namespace opentmcl::scenario {

/// What is wrong with a text, and at which of its bytes.
struct TextError {
  std::size_t offset;
  std::string message;  ///< what was found, what was expected, and the nearest name if there is one
};

/// What a text says, or why it says nothing.
template <class Meaning>
using Parsed = std::variant<Meaning, TextError>;

}  // namespace opentmcl::scenario
