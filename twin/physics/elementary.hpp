// Sine, cosine, exponential and angle of a vector, the same to the last bit on every machine.
//
// The standard library's differ between libraries and processors; a run of the twin must not. Only +, -, *, / and
// std::sqrt are used here, which IEEE 754 fixes, and the twin is compiled without contraction to fused operations.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace opentmcl::twin {

inline constexpr double radians_per_turn = 2 * std::numbers::pi;

/// The nearest integer, half to even. @param value of at most 2^51
inline double nearest_integer(double value) {
  constexpr double last_bit_is_one = 6755399441055744.0;  // 1.5 * 2^52
  return (value + last_bit_is_one) - last_bit_is_one;
}

/// A vector of the plane, or a complex number: `along` the axis and at right angles ahead, `across`.
struct Phasor {
  double along = 0;
  double across = 0;

  friend Phasor operator+(Phasor a, Phasor b) { return {a.along + b.along, a.across + b.across}; }
  friend Phasor operator-(Phasor a, Phasor b) { return {a.along - b.along, a.across - b.across}; }
  friend Phasor operator*(double factor, Phasor a) { return {factor * a.along, factor * a.across}; }
  friend Phasor operator*(Phasor a, Phasor b) {
    return {a.along * b.along - a.across * b.across, a.along * b.across + a.across * b.along};
  }
  friend Phasor operator/(Phasor a, Phasor b) {
    const double square = b.along * b.along + b.across * b.across;
    return {(a.along * b.along + a.across * b.across) / square, (a.across * b.along - a.along * b.across) / square};
  }
  double magnitude() const { return std::sqrt(along * along + across * across); }
};

/// Cosine (along) and sine (across) of an angle. Error at most 4e-9: the first term left out of each series is 1.8e-9
/// at an eighth of a turn.
/// @param turns at most 2^49 either way
inline Phasor unit_phasor(double turns) {
  const double quarters = nearest_integer(turns * 4);
  const double angle = (turns - quarters * 0.25) * radians_per_turn;
  const double square = angle * angle;
  const double sine =
      angle * (1 + square * (-1.0 / 6 + square * (1.0 / 120 + square * (-1.0 / 5040 + square * (1.0 / 362880)))));
  const double cosine =
      1 + square * (-1.0 / 2 + square * (1.0 / 24 + square * (-1.0 / 720 + square * (1.0 / 40320 - square / 3628800))));
  const auto quadrant = static_cast<std::int64_t>(quarters);
  const bool swapped = (quadrant & 1) != 0;
  const double along = swapped ? sine : cosine;
  const double across = swapped ? cosine : sine;
  return {((quadrant + 1) & 2) != 0 ? -along : along, (quadrant & 2) != 0 ? -across : across};
}

/// e to the power of `exponent`. Relative error at most 1e-14. @param exponent at most 700; 0 results below -700
double exponential(double exponent);

/// Angle of a vector in turns, -0.5 to 0.5. Error at most 1e-14 turns. The vector may have any length but 0.
double angle_in_turns(Phasor vector);

}  // namespace opentmcl::twin
