#include "twin/chip/floor_sum.hpp"

#include <utility>

namespace opentmcl::twin {

std::uint64_t floor_sum(std::uint64_t count, std::uint64_t first, std::uint64_t slope, std::uint64_t divisor) {
  std::uint64_t sum = 0;
  while (count != 0) {
    // The whole parts of both coefficients add up as an arithmetic series; fractions of the line remain.
    sum += (count - 1) * count / 2 * (slope / divisor) + count * (first / divisor);
    slope %= divisor;
    first %= divisor;
    // What is left counts the lattice points under the line. Counted by rows instead of columns they lie under its
    // mirror image, which has the inverse slope and one point for each whole number that the line reaches.
    const std::uint64_t end = first + slope * count;
    count = end / divisor;
    first = end % divisor;
    std::swap(slope, divisor);
  }
  return sum;
}

}  // namespace opentmcl::twin
