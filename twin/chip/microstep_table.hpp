// The sine table of the TMC262 (datasheet chapter 8.2).
#pragma once

#include <cstdint>

namespace opentmcl::twin {

/// Coil current of a microstep position (0…1023, four full steps) in table units, -248…248: coil A carries the sine of
/// the position, coil B its cosine, which is sine_current(position + 256).
/// Entry i of the first quadrant is 248 sin(π (2i + 1) / 1024), rounded; the others follow by symmetry.
std::int32_t sine_current(std::uint32_t position);

}  // namespace opentmcl::twin
