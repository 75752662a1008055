// Parameters as a user names them.
#pragma once

#include <cstdint>
#include <string_view>

#include "client/error.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"

namespace opentmcl::app {

struct NamedParameter {
  std::uint8_t number = 0;
  /// From the parameter's row; of a number without a row: empty and Unit::none.
  std::string_view symbol = {};
  std::string_view name = {};
  Unit unit = Unit::none;
};

/// A number 0…255, a symbol (APActualPosition, with or without AP) or the name in the tables ("actual position"), where
/// case, spaces, - and _ do not matter. Error: usage, with the most similar name if there is one.
client::Result<NamedParameter> find_axis_parameter(std::string_view text);

/// The same for a bank: module settings have names, interrupt settings those of the interrupts, others only numbers.
client::Result<NamedParameter> find_global_parameter(std::string_view text, Bank bank);

}  // namespace opentmcl::app
