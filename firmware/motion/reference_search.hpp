#pragma once

#include <cstdint>

#include "firmware/hal/pins.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/motion/axis.hpp"

namespace opentmcl {

/// The built-in reference search (RFS): eight modes as one state machine over the axis. It measures two switching
/// points at the switch speed (parameter 195) and puts the origin in their middle. Source: PD-1161 manual 7.1;
/// docs/decisions/0013-reference-search.md draws the states.
class ReferenceSearch {
 public:
  /// Numbers as RFS STATUS shows them.
  enum class State : std::uint8_t {
    idle = 0,
    seek_other_end = 1,  ///< modes 2 and 3: fast towards the opposite limit switch
    seek = 2,            ///< fast towards the switch
    turn_back = 3,       ///< modes 5 and 6: a limit switch was there first; fast back past the home switch
    leave_home = 4,      ///< still on the way back, on the home switch
    retreat = 5,         ///< slowly off the switch, on the side it was approached from
    enter = 6,           ///< slowly onto the switch
    cross = 7,           ///< slowly through the switch
    stop = 8,            ///< until the motor stands
    go_to_origin = 9,
    aborted = 15,
  };

  ReferenceSearch(Axis& axis, hal::Pins& pins) : axis_(axis), pins_(pins) {}

  /// Starts in the mode of parameter 193; a search under way starts again.
  void start();
  /// Stops the motor and the search; nothing happens when none is under way.
  void abort();
  /// A motion command takes the motor over: the search ends, the motor is left alone.
  void yield_motor();

  State state() const { return state_; }
  bool is_active() const { return state_ != State::idle && state_ != State::aborted; }

  /// @return when to call again, or never
  Microseconds poll(Microseconds now) { return is_active() ? advance(now) : never; }

  /// How often the switches are looked at. It bounds the error of a switching point: 1 ms of the switch speed.
  static constexpr Microseconds poll_period = one_millisecond;

 private:
  Microseconds advance(Microseconds now);
  void drive(int direction, AxisParameter speed);
  void begin_seek();
  void note_edge();
  void finish();
  bool is_on_switch();
  bool is_at_limit(int direction);
  void step();

  Axis& axis_;
  hal::Pins& pins_;
  State state_ = State::idle;
  std::int8_t mode_ = 1;        ///< 1…8
  std::int8_t direction_ = -1;  ///< towards the switch
  bool inverts_home_ = false;
  std::int32_t first_edge_ = 0;  ///< microsteps, positions of before the search
  std::int32_t other_end_ = 0;
};

}  // namespace opentmcl
