#pragma once

#include <cstdint>

#include "firmware/hal/pins.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/motion/axis.hpp"

namespace opentmcl {

/// The built-in reference search (RFS): eight modes as one state machine over the axis. It measures two switching
/// points at the switch speed (parameter 195) and puts the origin in their middle. Source: PD-1161 manual 7.1;
/// docs/reference_search.md draws the states.
class ReferenceSearch {
 public:
  /// Numbers as RFS STATUS shows them. "Fast" is parameter 194, "slowly" 195; "forth" is towards the switch, from the
  /// side on which the search approaches it, "back" the other way.
  enum class State : std::uint8_t {
    idle = 0,
    seek_other_end = 1,    ///< modes 2 and 3: fast back, until the opposite limit switch is active
    seek = 2,              ///< fast forth, until the switch is active
    return_to_switch = 3,  ///< back onto the switch: fast from a limit switch, slowly when the motor overshot
    brake = 4,             ///< until the motor stands
    retreat = 5,           ///< slowly back off the switch
    enter = 6,             ///< slowly forth onto the switch
    cross = 7,             ///< modes 3 to 8: slowly forth until it is off the switch
    stop = 8,              ///< until the motor stands; then the origin is set
    go_to_origin = 9,      ///< a move to position 0
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

  /// A contact bounces for some milliseconds when it changes: a switch counts as left when it was found inactive so
  /// often in a row.
  static constexpr int polls_of_bounce = 10;

 private:
  Microseconds advance(Microseconds now);
  void step();
  void drive(int direction, AxisParameter speed, State state);
  void halt(State state);
  void set_origin();
  bool is_on_switch();
  bool is_at_limit(int direction);
  bool has_reached(bool switch_active, int direction);
  bool has_calmed_down();
  bool has_left_switch(std::int32_t& point);

  Axis& axis_;
  hal::Pins& pins_;
  State state_ = State::idle;
  std::int8_t mode_ = 1;    ///< 1…8
  std::int8_t forth_ = -1;  ///< direction in which the switch is approached; back is -forth_
  bool inverts_home_ = false;
  std::uint8_t calm_polls_ = 0;    ///< in a row: switch inactive, or motor standing
  std::int32_t first_point_ = 0;   ///< microsteps, as counted before the search
  std::int32_t second_point_ = 0;  ///< likewise
  std::int32_t other_end_ = 0;     ///< likewise
};

}  // namespace opentmcl
