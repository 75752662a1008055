// The sum of a straight line rounded down at every point.
#pragma once

#include <cstdint>

namespace opentmcl::twin {

/// Σ ⌊(first + slope i) / divisor⌋ for i = 0…count-1, without adding up the terms: in as many rounds as Euclid's
/// algorithm needs for slope and divisor. The sum, count², and first + slope count must stay below 2^64.
std::uint64_t floor_sum(std::uint64_t count, std::uint64_t first, std::uint64_t slope, std::uint64_t divisor);

}  // namespace opentmcl::twin
