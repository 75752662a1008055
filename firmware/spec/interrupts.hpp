// Every interrupt of both modules, with what can be configured in global parameter bank 3 (same numbers).
// Sources: PD-1161 manual table 12 and table 20, TMCM-1110 manual table 12.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/modules.hpp"

namespace opentmcl {

enum class Interrupt : std::uint8_t {
  timer_0 = 0,
  timer_1 = 1,
  timer_2 = 2,
  position_reached = 3,
  stall_guard = 15,
  deviation = 21,
  stop_left = 27,
  stop_right = 28,
  input_0 = 39,
  input_1 = 40,
  input_2 = 41,
  input_3 = 42,
  input_4 = 43,
  input_5 = 44,
  global = 255,  ///< EI 255 and DI 255: all of them at once
};

/// What the parameter of the same number in bank 3 sets.
enum class InterruptSetting : std::uint8_t {
  none,
  period,  ///< milliseconds between two interrupts, 32 bit unsigned; 0 off
  edge,    ///< 0 off, 1 rising, 2 falling, 3 both
};

struct InterruptSpec {
  Interrupt number;
  const char* symbol;  ///< constant in Interrupts.inc
  const char* name;
  InterruptSetting setting;
  Modules modules;
};

inline constexpr InterruptSpec interrupts[] = {
    {Interrupt::timer_0, "TI_TIMER0", "timer 0", InterruptSetting::period, Modules::both},
    {Interrupt::timer_1, "TI_TIMER1", "timer 1", InterruptSetting::period, Modules::both},
    {Interrupt::timer_2, "TI_TIMER2", "timer 2", InterruptSetting::period, Modules::both},
    {Interrupt::position_reached, "TI_POSITION_REACHED0", "target position reached 0", InterruptSetting::none,
     Modules::both},
    {Interrupt::stall_guard, "TI_STALLGUARD0", "stallGuard axis 0", InterruptSetting::none, Modules::both},
    {Interrupt::deviation, "TI_DEVIATION0", "deviation axis 0", InterruptSetting::none, Modules::both},
    {Interrupt::stop_left, "TI_STOP_LEFT0", "left stop switch 0", InterruptSetting::edge, Modules::both},
    {Interrupt::stop_right, "TI_STOP_RIGHT0", "right stop switch 0", InterruptSetting::edge, Modules::both},
    {Interrupt::input_0, "TI_INPUT0", "input change 0", InterruptSetting::edge, Modules::both},
    {Interrupt::input_1, "TI_INPUT1", "input change 1", InterruptSetting::edge, Modules::both},
    {Interrupt::input_2, "TI_INPUT2", "input change 2", InterruptSetting::edge, Modules::both},
    {Interrupt::input_3, "TI_INPUT3", "input change 3", InterruptSetting::edge, Modules::both},
    {Interrupt::input_4, "TI_INPUT4", "input change 4", InterruptSetting::edge, Modules::tmcm1110},
    {Interrupt::input_5, "TI_INPUT5", "input change 5", InterruptSetting::edge, Modules::tmcm1110},
    {Interrupt::global, "TI_GLOBAL", "global interrupts", InterruptSetting::none, Modules::both},
};

inline constexpr std::size_t interrupt_count = sizeof interrupts / sizeof interrupts[0];

consteval bool interrupts_are_consistent() {
  int previous = -1;
  for (const InterruptSpec& row : interrupts) {
    if (static_cast<int>(row.number) <= previous) return false;
    previous = static_cast<int>(row.number);
  }
  return true;
}
static_assert(interrupts_are_consistent(), "rows sorted and unique");

}  // namespace opentmcl
