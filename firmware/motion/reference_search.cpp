#include "firmware/motion/reference_search.hpp"

#include "firmware/motion/wrapping.hpp"

namespace opentmcl {

namespace {

// Parameter 193: mode, and options added to it (PD-1161 manual 7.1).
constexpr std::int32_t right_switch_option = 64;
constexpr std::int32_t invert_home_option = 128;
constexpr std::int32_t mode_mask = 15;

constexpr bool uses_other_end(int mode) {
  return mode == 2 || mode == 3;
}
constexpr bool uses_home_switch(int mode) {
  return mode >= 5;
}
constexpr bool turns_back_at_a_limit(int mode) {
  return mode == 5 || mode == 6;
}
/// Modes 1 and 2 measure one edge of the switch from both directions, the others both edges.
constexpr bool crosses_the_switch(int mode) {
  return mode >= 3;
}
/// Modes 6 and 8 search in positive direction (E-28 for 7 and 8).
constexpr bool starts_positive(int mode) {
  return mode == 6 || mode == 8;
}

constexpr int left = -1;
constexpr AxisParameter fast = AxisParameter::reference_search_speed;
constexpr AxisParameter slowly = AxisParameter::reference_switch_speed;

/// Half the difference, so that points near the ends of the range do not overflow.
constexpr std::int32_t middle_of(std::int32_t a, std::int32_t b) {
  return wrapping_sum(a, wrapping_difference(b, a) / 2);
}

}  // namespace

void ReferenceSearch::start() {
  const std::int32_t setting = axis_.settings()[AxisParameter::reference_search_mode];
  mode_ = static_cast<std::int8_t>(setting & mode_mask);
  inverts_home_ = (setting & invert_home_option) != 0;
  calm_polls_ = 0;
  const bool positive = starts_positive(mode_) || (setting & right_switch_option) != 0;
  forth_ = positive ? 1 : -1;
  axis_.enable_limit_stops(false);
  if (uses_other_end(mode_)) {
    drive(-forth_, fast, State::seek_other_end);
  } else {
    drive(forth_, fast, State::seek);
  }
}

void ReferenceSearch::abort() {
  if (!is_active()) return;
  yield_motor();
  axis_.stop();
}

void ReferenceSearch::yield_motor() {
  if (!is_active()) return;
  state_ = State::aborted;
  axis_.enable_limit_stops(true);
}

void ReferenceSearch::drive(int direction, AxisParameter speed, State state) {
  axis_.rotate(direction * axis_.settings()[speed]);
  state_ = state;
}

void ReferenceSearch::halt(State state) {
  axis_.stop();
  state_ = state;
}

bool ReferenceSearch::is_at_limit(int direction) {
  return direction == left ? axis_.left_switch_active() : axis_.right_switch_active();
}

bool ReferenceSearch::is_on_switch() {
  if (!uses_home_switch(mode_)) return is_at_limit(forth_);
  return is_high(pins_.inputs(), hal::InputPin::home_switch) != inverts_home_;
}

/// A switch that is passed while the motor still comes out of the opposite direction does not count.
bool ReferenceSearch::has_reached(bool switch_active, int direction) {
  return switch_active && axis_.actual_velocity() * direction >= 0;
}

/// The motor has stood for so long that no contact bounces any more.
bool ReferenceSearch::has_calmed_down() {
  if (axis_.actual_velocity() != 0) return false;
  if (++calm_polls_ < polls_of_bounce) return false;
  calm_polls_ = 0;
  return true;
}

/// @param point set to the position at which the switch became inactive
bool ReferenceSearch::has_left_switch(std::int32_t& point) {
  if (is_on_switch()) {
    calm_polls_ = 0;
    return false;
  }
  if (calm_polls_ == 0) point = axis_.position();
  if (++calm_polls_ < polls_of_bounce) return false;
  calm_polls_ = 0;
  return true;
}

Microseconds ReferenceSearch::advance(Microseconds now) {
  step();
  return is_active() ? now + poll_period : never;
}

void ReferenceSearch::step() {
  switch (state_) {
    case State::seek_other_end:
      if (!has_reached(is_at_limit(-forth_), -forth_)) break;
      other_end_ = axis_.position();
      drive(forth_, fast, State::seek);
      break;
    case State::seek:
      // Its edge is where it was last active on the way from it, however far into it the search began or overshot.
      if (uses_other_end(mode_) && is_at_limit(-forth_)) other_end_ = axis_.position();
      if (has_reached(is_on_switch(), forth_)) {
        halt(State::brake);
      } else if (turns_back_at_a_limit(mode_) && has_reached(is_at_limit(forth_), forth_)) {
        drive(-forth_, fast, State::return_to_switch);
      }
      break;
    case State::return_to_switch:
      if (has_reached(is_on_switch(), -forth_)) drive(-forth_, slowly, State::retreat);
      break;
    case State::brake:
      if (!has_calmed_down()) break;
      drive(-forth_, slowly, is_on_switch() ? State::retreat : State::return_to_switch);
      break;
    case State::retreat:
      if (!has_left_switch(first_point_)) break;
      drive(forth_, slowly, State::enter);
      break;
    case State::enter:
      if (!is_on_switch()) break;
      second_point_ = axis_.position();
      if (crosses_the_switch(mode_)) {
        first_point_ = second_point_;
        state_ = State::cross;
      } else {
        halt(State::stop);
      }
      break;
    case State::cross:
      if (!has_left_switch(second_point_)) break;
      halt(State::stop);
      break;
    case State::stop:
      if (axis_.actual_velocity() == 0) set_origin();
      break;
    case State::go_to_origin:
      if (!axis_.position_reached()) break;
      axis_.enable_limit_stops(true);
      state_ = State::idle;
      break;
    case State::idle:
    case State::aborted:
      break;
  }
}

/// The origin is in the middle of the two switching points.
void ReferenceSearch::set_origin() {
  const std::int32_t origin = middle_of(first_point_, second_point_);
  AxisSettings& settings = axis_.settings();
  settings.set(AxisParameter::last_reference_position, origin);
  if (uses_other_end(mode_)) {
    const std::int32_t distance = wrapping_difference(other_end_, origin);
    settings.set(AxisParameter::end_switch_distance, distance < 0 ? wrapping_difference(0, distance) : distance);
  }
  axis_.set_position(wrapping_difference(axis_.position(), origin));
  axis_.move_to(0);
  state_ = State::go_to_origin;
}

}  // namespace opentmcl
