#pragma once

#include <cstdint>

#include "firmware/tmcl/extensions.hpp"

namespace opentmcl::examples {

/// An extension: room for measurements in global parameter bank 1, and what programs want to know about them.
///
///     SGP n, 1, value, GGP n, 1, AGP n, 1     measurement n, 0…31
///     UF0 first, last, 0                      sum of the measurements first…last
///     UF1 first, last, 0                      the largest of them
///     UF2 first, last, value                  sets all of them to the value
///
/// Sum and maximum go to the accumulator of a program and set its flags, as GGP does.
class Measurements {
 public:
  static constexpr std::uint8_t count = 32;

  /// To be given to the module; this must outlive it.
  Extensions extensions();

 private:
  static Outcome sum(void* context, const Command& command);
  static Outcome maximum(void* context, const Command& command);
  static Outcome fill(void* context, const Command& command);
  static Status get(void* context, std::uint8_t number, std::int32_t& value);
  static Status set(void* context, std::uint8_t number, std::int32_t value);

  static Measurements& self(void* context) { return *static_cast<Measurements*>(context); }
  static bool is_range(const Command& command) { return command.type <= command.motor && command.motor < count; }

  std::int32_t values_[count] = {};
};

}  // namespace opentmcl::examples
