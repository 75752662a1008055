// What the TMC429 datasheet leaves open, and what this model does there: every such choice is in this file.
//
// Choices that are a computation are the functions below. The others:
//
//  * Both dividers count one free-running clock of 1/32 of CLK, so ticks fall on multiples of their period since
//    power-on, whenever the divider was set. (The block diagram shows one common prescaler.)
//  * A ramp tick comes before a pulse tick of the same instant.
//  * The pulse accumulator has 11 bits, starts at 0 and is never cleared: a step per tick would need a velocity of
//    2048, and a change of PULSE_DIV is documented to act on a phase that is kept. The extra step which that change
//    may give out in velocity_mode and hold_mode is not modelled.
//  * The last increment of a ramp is cut to end exactly on the target velocity; nothing else could hold a velocity.
//  * A step onto X_TARGET with |V_ACTUAL| <= V_MIN stops at once, as V_MIN is described; with a higher velocity the
//    motor runs past and returns, as the figure for a too large p shows.
//  * V_MAX is stronger than V_MIN: the advice to set V_MAX = 0 before a change of X_ACTUAL works in no other way.
//  * V_ACTUAL can be written in every mode: the datasheet's own recipe for a start velocity does so in ramp_mode.
//  * A_ACTUAL is the change of velocity on the last ramp tick; the smoothing of the chip is not published.
//  * A stop switch changes neither V_TARGET nor X_TARGET, and no velocity builds up against an active switch: "runs on
//    when the switch becomes inactive" needs both targets. In hold_mode, which has no ramp, every stop is immediate.
//  * The latch takes either edge of the reference switch; X_LATCHED keeps its old value while it is armed.
//  * Interrupt flags are set by the beginning of their condition, so that one cleared flag stays clear.
//    "Target reached" is the xEQt bit of the status byte; it compares positions in every mode.
//  * POS_COMP_INT behaves as the other interrupts: set by the beginning of the match, cleared by writing 1, part of
//    INT.
//  * The status byte shows the state before a write takes effect, because it leaves the chip first.
//  * Unassigned registers read 0 and ignore writes, as on the TMC428.
//  * A step that is due while the previous STEP pulse is still high gets its own edge all the same: no step is lost.
//    For the same reason a step that waits after a reversal goes out with the next one if that is due first.
//  * STEP with step_half begins low and DIR as for increasing positions, so that the first step down is a reversal.
//  * A target exactly half the circle away, 2^23, is taken to lie in the decreasing direction: the sign bit of the
//    difference says so.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "firmware/chip/tmc429_registers.hpp"

namespace opentmcl::twin::tmc429_choices {

/// The difference of two positions on the 24-bit circle, -2^23…2^23-1.
constexpr std::int32_t distance(std::int32_t from, std::int32_t to) {
  return tmc429::TargetPosition::Value::in({static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from)});
}

/// The braking calculation sees at most this many steps ("internally limited to 2^19", page 26).
constexpr std::uint64_t braking_distance(std::uint64_t distance_to_target) {
  return std::min<std::uint64_t>(distance_to_target, tmc429::braking_distance_limit - 1);
}

/// ramp_mode: v² = 2048 p d, because p = 2048 / S makes v = 2048 exactly at the braking distance d = S, and only a
/// square root gives the straight braking lines of figure 8.3. Largest v <= limit with v² <= 2048 p d (rounded down).
inline std::int32_t braking_velocity(std::uint64_t steps, std::uint32_t multiplier, std::uint32_t divisor,
                                     std::int32_t limit) {
  const std::uint64_t square = (2048u * multiplier * steps) >> (3 + divisor);
  if (square >= static_cast<std::uint64_t>(limit) * static_cast<std::uint64_t>(limit)) {
    return limit;
  }
  // Below 2^22: there the square root of a double, which IEEE 754 rounds correctly, has the right integer part.
  return static_cast<std::int32_t>(std::sqrt(static_cast<double>(square)));
}

/// The shortest d for which braking_velocity() allows `velocity`: v² <= 2048 p d, rounded up.
constexpr std::uint64_t shortest_braking_distance(std::int32_t velocity, std::uint32_t multiplier,
                                                  std::uint32_t divisor) {
  const auto v = static_cast<std::uint64_t>(velocity);
  const auto over_2048 = static_cast<std::uint32_t>((((v * v) << (3 + divisor)) + 2047) / 2048);  // below 2^29
  return (over_2048 + multiplier - 1) / multiplier;
}

/// soft_mode: v = p d, "exponentially reduced velocity", rounded down.
inline std::int32_t soft_velocity(std::uint64_t steps, std::uint32_t multiplier, std::uint32_t divisor,
                                  std::int32_t limit) {
  const std::uint64_t velocity = (multiplier * steps) >> (3 + divisor);
  return static_cast<std::int32_t>(std::min<std::uint64_t>(velocity, static_cast<std::uint64_t>(limit)));
}

/// The shortest d for which soft_velocity() allows `velocity`.
constexpr std::uint64_t shortest_soft_distance(std::int32_t velocity, std::uint32_t multiplier, std::uint32_t divisor) {
  return ((static_cast<std::uint64_t>(velocity) << (3 + divisor)) + multiplier - 1) / multiplier;
}

/// The hidden fraction is cut off from the magnitude, which is stored apart from the sign: -0.5 reads as 0.
constexpr std::int32_t integer_velocity(std::int32_t velocity_with_fraction) {
  constexpr std::int32_t one = 1 << tmc429::velocity_fraction_bits;
  return velocity_with_fraction / one;
}

/// RAMP_DIV and PULSE_DIV 14 and 15 act as 13, the last tap of the divider.
constexpr unsigned divider_exponent(std::int32_t code) {
  return static_cast<unsigned>(std::min(code, tmc429::maximum_divider));
}

/// DX_REF_TOLERANCE reaches from -tolerance to +tolerance, ends included. With 0 no stop is excluded, also not at 0.
constexpr bool within_tolerance(std::int32_t position, std::int32_t tolerance) {
  return -tolerance <= position && position <= tolerance;
}

/// The DIR pin is low for increasing positions, as the direction code for SPI drivers and the TMC262 have it.
constexpr bool direction_pin(bool decreasing, bool inverted) {
  return decreasing != inverted;
}

}  // namespace opentmcl::twin::tmc429_choices
