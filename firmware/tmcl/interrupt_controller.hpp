#pragma once

#include <cstdint>

#include "firmware/hal/time.hpp"
#include "firmware/param/global_parameter_access.hpp"
#include "firmware/spec/lookup.hpp"

namespace opentmcl {

/// TMCL interrupts: which are enabled, where their routines are, which have happened. Priority is the number: the
/// lower first. Sources: PD-1161 manual 3.6.6 and 5.4.
class InterruptController {
 public:
  /// State of everything that can interrupt, as bits by row of the interrupt table.
  using Lines = std::uint32_t;
  static_assert(interrupt_count <= 32);

  static constexpr Lines bit(std::size_t row) { return Lines{1} << row; }

  /// @param row of the interrupt table; that of Interrupt::global switches the processing as a whole
  void enable(std::size_t row);
  void disable(std::size_t row);
  void set_vector(std::size_t row, std::uint16_t address);

  bool is_enabled(std::size_t row) const { return (enabled_ & bit(row)) != 0; }
  /// Some interrupt can happen at all.
  bool is_active() const { return active_; }

  /// Forgets what has happened: a program that starts hears only of what happens from then on.
  void forget_events();

  /// Notes edges of `lines` and timers that ran out since the last look. What is not enabled when it happens is lost.
  void observe(Microseconds now, Lines lines, const GlobalParameterAccess& settings);

  /// Something happened that has no line. What is not enabled when it happens is lost.
  /// @param row of the interrupt table
  void raise(std::size_t row) {
    if (is_enabled(row)) pending_ |= bit(row);
  }

  /// The pending interrupt of the highest priority, which is then no longer pending.
  /// @return false when there is none
  bool take(std::uint16_t& vector);

 private:
  void update_active();
  void observe_timer(std::size_t row, Microseconds now, Microseconds period);

  static constexpr std::size_t timer_count = 3;
  static_assert(row_of(Interrupt::timer_0) == 0 && row_of(Interrupt::timer_2) == timer_count - 1);

  Lines enabled_ = 0;
  Lines defined_ = 0;  ///< has a vector
  Lines pending_ = 0;
  Lines last_lines_ = 0;
  bool active_ = false;
  bool has_looked_ = false;
  std::uint16_t vectors_[interrupt_count] = {};
  Microseconds timer_due_[timer_count] = {never, never, never};
  Microseconds timer_period_[timer_count] = {};
};

}  // namespace opentmcl
