// How far a motor may go before somebody must look.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "firmware/chip/tmc429_registers.hpp"

namespace opentmcl::twin {

/// Steps that may be given in each direction, 1 or more.
struct Tmc429Reach {
  std::uint64_t decreasing = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t increasing = std::numeric_limits<std::uint64_t>::max();

  /// To the first step that enters or leaves the positions lowest…highest, both included, on the 24-bit circle.
  static constexpr Tmc429Reach to_border(std::int32_t position, std::int32_t lowest, std::int32_t highest) {
    constexpr auto steps_up = [](std::int32_t from, std::int32_t to) {
      constexpr std::uint32_t circle = 1u << tmc429::position_bits;
      return (static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from)) & (circle - 1);
    };
    if (steps_up(lowest, position) <= steps_up(lowest, highest)) {
      return {.decreasing = steps_up(lowest, position) + 1u, .increasing = steps_up(position, highest) + 1u};
    }
    return {.decreasing = steps_up(highest, position), .increasing = steps_up(position, lowest)};
  }

  constexpr void limit_to(const Tmc429Reach& other) {
    decreasing = std::min(decreasing, other.decreasing);
    increasing = std::min(increasing, other.increasing);
  }
};

}  // namespace opentmcl::twin
