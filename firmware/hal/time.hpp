// Time as the firmware sees it: an argument, never something it reads from a clock.
#pragma once

#include <cstdint>

namespace opentmcl {

/// Microseconds since the module was powered. 64 bits: it never wraps.
using Microseconds = std::uint64_t;

inline constexpr Microseconds one_millisecond = 1000;
/// "Nothing needs to run until something happens outside."
inline constexpr Microseconds never = ~Microseconds{0};

}  // namespace opentmcl
