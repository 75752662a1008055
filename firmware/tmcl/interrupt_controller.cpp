#include "firmware/tmcl/interrupt_controller.hpp"

namespace opentmcl {

namespace {

constexpr std::int32_t rising = 1;
constexpr std::int32_t falling = 2;

}  // namespace

void InterruptController::enable(std::size_t row) {
  enabled_ |= bit(row);
  update_active();
}

void InterruptController::disable(std::size_t row) {
  enabled_ &= ~bit(row);
  update_active();
}

void InterruptController::set_vector(std::size_t row, std::uint16_t address) {
  vectors_[row] = address;
  defined_ |= bit(row);
  update_active();
}

void InterruptController::update_active() {
  active_ = is_enabled(row_of(Interrupt::global)) && (enabled_ & defined_) != 0;
}

void InterruptController::forget_events() {
  pending_ = 0;
  has_looked_ = false;
  for (Microseconds& due : timer_due_) due = never;
}

void InterruptController::observe_timer(std::size_t row, Microseconds now, Microseconds period) {
  if (period == 0 || !is_enabled(row)) {
    timer_due_[row] = never;
    timer_period_[row] = 0;
    return;
  }
  if (timer_due_[row] == never || timer_period_[row] != period) {
    timer_due_[row] = now + period;
    timer_period_[row] = period;
    return;
  }
  if (now < timer_due_[row]) return;
  pending_ |= bit(row);
  // A look that is a little late does not shift the interrupts to come; after a long break the count starts anew.
  const bool is_prompt = now - timer_due_[row] < period;
  timer_due_[row] = (is_prompt ? timer_due_[row] : now) + period;
}

void InterruptController::observe(Microseconds now, Lines lines, const GlobalParameterAccess& settings) {
  for (std::size_t row = 0; row < timer_count; ++row) {
    const auto period = static_cast<std::uint32_t>(settings.interrupt_setting(row));
    observe_timer(row, now, period * one_millisecond);
  }
  const Lines changed = has_looked_ ? lines ^ last_lines_ : 0;
  last_lines_ = lines;
  has_looked_ = true;
  for (std::size_t row = timer_count; changed != 0 && row < interrupt_count; ++row) {
    if ((changed & bit(row)) == 0 || !is_enabled(row)) continue;
    // Interrupts without a setting happen when their line rises.
    const bool has_edge = interrupt_columns[row].setting == InterruptSetting::edge;
    const std::int32_t wanted = has_edge ? settings.interrupt_setting(row) : rising;
    const std::int32_t happened = (lines & bit(row)) != 0 ? rising : falling;
    if ((wanted & happened) != 0) pending_ |= bit(row);
  }
}

bool InterruptController::take(std::uint16_t& vector) {
  if (!is_active()) return false;
  const Lines ready = pending_ & enabled_ & defined_;
  for (std::size_t row = 0; ready != 0 && row < interrupt_count; ++row) {
    if ((ready & bit(row)) == 0) continue;
    pending_ &= ~bit(row);
    vector = vectors_[row];
    return true;
  }
  return false;
}

}  // namespace opentmcl
