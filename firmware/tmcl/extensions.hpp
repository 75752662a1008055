#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/instructions.hpp"
#include "firmware/tmcl/outcome.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

inline constexpr std::size_t user_function_count =
    static_cast<std::size_t>(Opcode::uf7) - static_cast<std::size_t>(Opcode::uf0) + 1;

/// What a board adds to TMCL: the instructions UF0 to UF7 and the global parameters of bank 1, which the manuals keep
/// for customers (PD-1161 manual 3.7.51 and 5.2). What is nullptr does not exist. Everything is called from
/// Module::poll() or Module::handle() and must return at once; docs/extensions.md has an example.
struct Extensions {
  /// Executes a user function. Type, motor and value of `command` mean what the function wants, and are not checked.
  /// @return Form::normal: the status and the value of the reply. Form::result: likewise, and in a program the value
  ///         goes to the accumulator and sets the flags. Form::busy: to be called again on a later turn.
  using UserFunction = Outcome (*)(void* context, const Command& command);
  /// GGP of bank 1. @return ok, or wrong_type for a number that does not exist
  using GetVariable = Status (*)(void* context, std::uint8_t number, std::int32_t& value);
  /// SGP and AGP of bank 1. @return ok, wrong_type for a number that does not exist, or invalid_value
  using SetVariable = Status (*)(void* context, std::uint8_t number, std::int32_t value);

  void* context = nullptr;  ///< is passed to each of them
  UserFunction user_functions[user_function_count] = {};
  GetVariable get_variable = nullptr;
  SetVariable set_variable = nullptr;
};

/// The modules as they are delivered: user functions answer "invalid command", bank 1 "invalid value".
inline constexpr Extensions no_extensions{};

}  // namespace opentmcl
