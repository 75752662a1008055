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

}  // namespace

void ReferenceSearch::start() {
  const std::int32_t setting = axis_.settings()[AxisParameter::reference_search_mode];
  mode_ = static_cast<std::int8_t>(setting & mode_mask);
  inverts_home_ = (setting & invert_home_option) != 0;
  const bool positive = starts_positive(mode_) || (setting & right_switch_option) != 0;
  direction_ = positive ? 1 : -1;
  axis_.enable_limit_stops(false);
  if (uses_other_end(mode_)) {
    drive(-direction_, AxisParameter::reference_search_speed);
    state_ = State::seek_other_end;
  } else {
    begin_seek();
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

void ReferenceSearch::drive(int direction, AxisParameter speed) {
  axis_.rotate(direction * axis_.settings()[speed]);
}

void ReferenceSearch::begin_seek() {
  drive(direction_, AxisParameter::reference_search_speed);
  state_ = State::seek;
}

bool ReferenceSearch::is_at_limit(int direction) {
  return direction == left ? axis_.left_switch_active() : axis_.right_switch_active();
}

bool ReferenceSearch::is_on_switch() {
  if (!uses_home_switch(mode_)) return is_at_limit(direction_);
  const bool level = (pins_.inputs() >> static_cast<unsigned>(hal::InputPin::home_switch) & 1) != 0;
  return level != inverts_home_;
}

Microseconds ReferenceSearch::advance(Microseconds now) {
  step();
  return is_active() ? now + poll_period : never;
}

void ReferenceSearch::step() {
  switch (state_) {
    case State::seek_other_end:
      if (!is_at_limit(-direction_)) break;
      other_end_ = axis_.position();
      begin_seek();
      break;
    case State::seek:
      if (is_on_switch()) {
        drive(-direction_, AxisParameter::reference_switch_speed);
        state_ = State::retreat;
      } else if (turns_back_at_a_limit(mode_) && is_at_limit(direction_)) {
        drive(-direction_, AxisParameter::reference_search_speed);
        state_ = State::turn_back;
      }
      break;
    case State::turn_back:
      if (is_on_switch()) state_ = State::leave_home;
      break;
    case State::leave_home:
      if (!is_on_switch()) begin_seek();
      break;
    case State::retreat:
      if (is_on_switch()) break;
      first_edge_ = axis_.position();
      drive(direction_, AxisParameter::reference_switch_speed);
      state_ = State::enter;
      break;
    case State::enter:
      if (!is_on_switch()) break;
      if (crosses_the_switch(mode_)) {
        first_edge_ = axis_.position();
        state_ = State::cross;
      } else {
        note_edge();
      }
      break;
    case State::cross:
      if (!is_on_switch()) note_edge();
      break;
    case State::stop:
      if (axis_.actual_velocity() == 0) finish();
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

/// The second switching point: the origin is in the middle of the two.
void ReferenceSearch::note_edge() {
  // Half the difference, so that positions near the ends of the range do not overflow.
  first_edge_ = wrapping_sum(first_edge_, wrapping_difference(axis_.position(), first_edge_) / 2);
  axis_.stop();
  state_ = State::stop;
}

void ReferenceSearch::finish() {
  const std::int32_t origin = first_edge_;
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
