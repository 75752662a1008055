#include "twin/chip/microstep_table.hpp"

#include <array>

#include "firmware/chip/tmc262_registers.hpp"

namespace opentmcl::twin {
namespace {

constexpr std::size_t quadrant = tmc262::microsteps_per_fullstep;
constexpr double pi = 3.14159265358979323846;

/// The Taylor series to x¹⁵ for 0 <= x <= π/2: its error is below 10⁻¹¹, and no entry of the table is nearer than 10⁻²
/// to a rounding border. Computed by the compiler, so that every machine has the same table.
constexpr double sine(double x) {
  double term = x;
  double sum = x;
  for (int n = 2; n <= 14; n += 2) {
    term *= -x * x / (n * (n + 1));
    sum += term;
  }
  return sum;
}

constexpr std::uint8_t rounded(double positive) {
  const auto halves = static_cast<unsigned>(2 * positive);
  return static_cast<std::uint8_t>((halves + 1) / 2);
}

constexpr std::array<std::uint8_t, quadrant> first_quadrant = [] {
  std::array<std::uint8_t, quadrant> table{};
  for (std::size_t i = 0; i < quadrant; ++i) {
    const double angle = pi * static_cast<double>(2 * i + 1) / 1024.0;
    table[i] = rounded(tmc262::coil_current_amplitude * sine(angle));
  }
  return table;
}();

}  // namespace

std::int32_t sine_current(std::uint32_t position) {
  const std::uint32_t index = position % quadrant;
  switch (position / quadrant % 4) {
    case 0:
      return first_quadrant[index];
    case 1:
      return first_quadrant[quadrant - 1 - index];
    case 2:
      return -first_quadrant[index];
    default:
      return -first_quadrant[quadrant - 1 - index];
  }
}

}  // namespace opentmcl::twin
