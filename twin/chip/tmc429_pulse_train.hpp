// Pulse ticks that follow one another with the same velocity: how many steps they give, and when.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/chip/tmc429_registers.hpp"

namespace opentmcl::twin {

/// On each pulse tick the velocity is added to the accumulator, and every 2048 of the sum is a step; that is
/// Bresenham's line, of which each point can be had at once.
struct Tmc429PulseTrain {
  std::uint64_t begin;        ///< the ticks after this one
  std::uint64_t pulse_ticks;  ///< how many of them are pulse ticks
  unsigned divider;           ///< PULSE_DIV
  std::uint32_t accumulator;  ///< at `begin`, 0…2047
  std::uint32_t increment;    ///< |V_ACTUAL|, 0…2047

  static constexpr std::uint32_t step = tmc429::pulse_accumulator_size;

  std::uint64_t phase() const { return accumulator + pulse_ticks * increment; }
  std::uint64_t steps() const { return phase() / step; }
  std::uint32_t accumulator_at_end() const { return static_cast<std::uint32_t>(phase() % step); }

  /// The tick of step `number`, 1 being the first, also beyond the end of the train.
  std::uint64_t tick_of_step(std::uint64_t number) const {
    return tick_of_pulse((number * step - accumulator + increment - 1) / increment);
  }
  /// The same for the first and the last step of a train that has some, with short divisions.
  std::uint64_t tick_of_first_step() const { return tick_of_pulse((step - accumulator + increment - 1) / increment); }
  std::uint64_t tick_of_last_step() const { return tick_of_pulse(pulse_ticks - accumulator_at_end() / increment); }

  /// Appends the ticks of all steps.
  void list_steps(std::vector<std::uint64_t>& ticks) const;

 private:
  std::uint64_t tick_of_pulse(std::uint64_t number) const { return ((begin >> divider) + number) << divider; }
};

}  // namespace opentmcl::twin
