#include "twin/physics/elementary.hpp"

namespace opentmcl::twin {

double exponential(double exponent) {
  if (exponent < -700) return 0;
  // e^x = 2^k e^r with |r| <= ln(2) / 2. ln(2) in two parts, of which the first times k is exact.
  constexpr double ln2_high = 0x1.62e42feep-1;
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  const double power = nearest_integer(exponent * std::numbers::log2e);
  const double rest = (exponent - power * ln2_high) - power * ln2_low;
  // Series of e^r; the first term left out, r^13 / 13!, is below 2e-16.
  double sum = 1;
  for (int n = 12; n >= 1; --n) sum = 1 + sum * rest * (1.0 / n);
  constexpr std::int64_t exponent_bias = 1023;
  constexpr int fraction_bits = 52;
  return sum * std::bit_cast<double>((static_cast<std::int64_t>(power) + exponent_bias) << fraction_bits);
}

double angle_in_turns(Phasor vector) {
  const double x = std::fabs(vector.along);
  const double y = std::fabs(vector.across);
  double tangent = x >= y ? y / x : x / y;
  // arctan t = 2 arctan(t / (1 + sqrt(1 + t^2))), twice: then t is at most tan(pi/16) = 0.199.
  tangent = tangent / (1 + std::sqrt(1 + tangent * tangent));
  tangent = tangent / (1 + std::sqrt(1 + tangent * tangent));
  const double square = tangent * tangent;
  // Series of arctan t / t; the first term left out, t^19 / 19, is below 3e-15.
  constexpr double coefficients[] = {1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0};
  double sum = 0;
  for (const double coefficient : coefficients) sum = coefficient - square * sum;
  double angle = 4 * tangent * sum / radians_per_turn;
  if (x < y) angle = 0.25 - angle;
  if (vector.along < 0) angle = 0.5 - angle;
  return vector.across < 0 ? -angle : angle;
}

}  // namespace opentmcl::twin
