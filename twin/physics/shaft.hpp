// Units of the motor's shaft.
#pragma once

#include <cstdint>
#include <limits>

namespace opentmcl::twin {

/// Shaft angles are counted in microsteps of 1/256 full step; the motor has 200 full steps a turn.
inline constexpr std::int64_t microsteps_per_turn = 200 * 256;

/// A turn of the field in the motor is four full steps.
inline constexpr std::int64_t microsteps_per_electrical_turn = 4 * 256;

/// Quotient rounded down, also of negative numbers. @param divisor positive
constexpr std::int64_t floor_quotient(std::int64_t dividend, std::int64_t divisor) {
  return dividend / divisor - (dividend % divisor < 0 ? 1 : 0);
}

/// Quotient rounded up. @param divisor positive
constexpr std::int64_t ceiling_quotient(std::int64_t dividend, std::int64_t divisor) {
  return -floor_quotient(-dividend, divisor);
}

/// What floor_quotient() leaves, 0 to divisor - 1. @param divisor positive
constexpr std::int64_t floor_remainder(std::int64_t dividend, std::int64_t divisor) {
  return dividend - floor_quotient(dividend, divisor) * divisor;
}

/// The microstep that a rotor stands in. Exact: a product with a power of two and rounding down; so the border between
/// two microsteps is a number that a double has. @param electrical_turns less than 2^53 microsteps
constexpr std::int64_t microstep_at(double electrical_turns) {
  const double microsteps = electrical_turns * static_cast<double>(microsteps_per_electrical_turn);
  const auto toward_zero = static_cast<std::int64_t>(microsteps);
  return static_cast<double>(toward_zero) > microsteps ? toward_zero - 1 : toward_zero;
}

/// The electrical turns at which a microstep begins. Exact.
constexpr double electrical_turns_at(std::int64_t microstep) {
  return static_cast<double>(microstep) / static_cast<double>(microsteps_per_electrical_turn);
}

/// Shaft angles from `lowest` to `highest`, both included.
struct AngleRange {
  static constexpr std::int64_t below_all = std::numeric_limits<std::int64_t>::min();
  static constexpr std::int64_t above_all = std::numeric_limits<std::int64_t>::max();

  std::int64_t lowest = below_all;
  std::int64_t highest = above_all;

  constexpr bool contains(std::int64_t angle) const { return lowest <= angle && angle <= highest; }
  friend constexpr bool operator==(const AngleRange&, const AngleRange&) = default;
};

/// How far the shaft has to turn either way until something happens, in microsteps; less, and nothing does.
struct EventDistance {
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

  std::int64_t down = never;  ///< towards falling angles
  std::int64_t up = never;

  friend constexpr bool operator==(const EventDistance&, const EventDistance&) = default;
};

constexpr EventDistance nearer_of(const EventDistance& a, const EventDistance& b) {
  return {a.down < b.down ? a.down : b.down, a.up < b.up ? a.up : b.up};
}

}  // namespace opentmcl::twin
