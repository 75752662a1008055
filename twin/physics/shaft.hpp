// Units of the motor's shaft.
#pragma once

#include <cstdint>

namespace opentmcl::twin {

/// Shaft angles are counted in microsteps of 1/256 full step; the motor has 200 full steps a turn.
inline constexpr std::int64_t microsteps_per_turn = 200 * 256;

/// Quotient rounded down, also of negative numbers. @param divisor positive
constexpr std::int64_t floor_quotient(std::int64_t dividend, std::int64_t divisor) {
  return dividend / divisor - (dividend % divisor < 0 ? 1 : 0);
}

/// Quotient rounded up. @param divisor positive
constexpr std::int64_t ceiling_quotient(std::int64_t dividend, std::int64_t divisor) {
  return -floor_quotient(-dividend, divisor);
}

}  // namespace opentmcl::twin
