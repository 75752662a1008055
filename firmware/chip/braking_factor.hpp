#pragma once

#include <cstdint>

#include "firmware/chip/tmc429_registers.hpp"

namespace opentmcl::tmc429 {

/// Multiplier (PMUL with its fixed top bit, 128…255) and divisor (PDIV, 0…13) of the factor p that tells the ramp
/// generator where to brake.
struct BrakingPair {
  std::int32_t multiplier;
  std::int32_t divisor;

  constexpr Word<BrakingFactor> word() const {
    return BrakingFactor::Multiplier::of(multiplier) | BrakingFactor::Divisor::of(divisor);
  }

  friend constexpr bool operator==(const BrakingPair&, const BrakingPair&) = default;
};

/// Percentage by which p is chosen smaller than the value that just reaches the target. With less the motor overshoots
/// by a microstep in a noticeable share of moves (measured: 27 % of random moves at 1 %, 0.07 % at 5 %).
inline constexpr std::int32_t braking_reduction_percent = 5;

/// The vendor's method (TMC429 datasheet, pages 29 to 31) in integers: p = a / (128 · 2^(ramp_div − pulse_div)),
/// reduced; the divisor is the one that puts 8 · p · 2^divisor into 128…255. Where no divisor does (acceleration
/// outside the limits of the manual's 6.1.3) the nearest representable p is returned.
/// @param acceleration 0…2047  @param ramp_divisor,pulse_divisor 0…13
constexpr BrakingPair braking_pair(std::int32_t acceleration, std::int32_t ramp_divisor, std::int32_t pulse_divisor) {
  constexpr std::uint32_t percent = 100;
  const std::uint32_t reduced =
      static_cast<std::uint32_t>(acceleration) * (percent - static_cast<std::uint32_t>(braking_reduction_percent));
  if (acceleration == 0) return {128, maximum_divider};  // no motion at all
  for (std::int32_t divisor = 0; divisor <= maximum_divider; ++divisor) {
    const std::int32_t exponent = divisor - 4 - ramp_divisor + pulse_divisor;
    // The first mantissa that reaches 128 is the only candidate, so nothing here exceeds 32 bits.
    const std::uint32_t mantissa =
        exponent >= 0 ? (reduced >= (256 * percent >> exponent) ? 256 : (reduced << exponent) / percent)
                      : reduced / (percent << -exponent);
    if (mantissa >= 256) return {255, divisor};
    if (mantissa >= 128) return {static_cast<std::int32_t>(mantissa), divisor};
  }
  return {128, maximum_divider};
}

}  // namespace opentmcl::tmc429
