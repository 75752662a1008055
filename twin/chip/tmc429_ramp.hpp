// The ramp and pulse generator of one TMC429 axis: parameters and time in, steps out. Time passes in leaps, not ticks.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "twin/chip/tmc429_pulse_train.hpp"
#include "twin/chip/tmc429_ramp_state.hpp"
#include "twin/chip/tmc429_reach.hpp"

namespace opentmcl::twin {

/// After any leap every register, the fraction of the velocity and the phase are those that tick after tick would give
/// (tmc429_ramp_reference.hpp, held equal by test).
class Tmc429Ramp {
 public:
  /// Steps in one direction, one after the other.
  struct Steps {
    std::uint64_t count = 0;
    std::uint64_t first_tick = 0;  ///< of the first step; nothing when there is none, as the others
    std::uint64_t last_tick = 0;
    bool decreasing = false;

    friend bool operator==(const Steps&, const Steps&) = default;
  };

  /// What ends an advance early, apart from its reach.
  enum class Until : std::uint8_t {
    end,
    velocity_changes,  ///< the velocity, its fraction included, is not what it was when the advance began
  };

  Tmc429Ramp() = default;
  explicit Tmc429Ramp(const Tmc429RampState& state) : state_(state) {}

  const Tmc429RampState& state() const { return state_; }
  const Tmc429RampSettings& settings() const { return state_.settings; }
  void configure(const Tmc429RampSettings& settings);

  std::int32_t position() const { return state_.position; }
  void set_position(std::int32_t position);

  /// V_ACTUAL: the integer part of the velocity.
  std::int32_t velocity() const;
  /// Takes effect at once and clears the fraction.
  void set_velocity(std::int32_t velocity);
  /// Also true for a velocity below 1, which V_ACTUAL shows as 0.
  bool moving() const { return state_.velocity != 0; }
  /// The last ramp tick changed the velocity, so that the next may too. A stop ends that.
  bool changing() const { return state_.acceleration != 0 && state_.velocity != 0; }

  /// A_ACTUAL: the change of velocity on the last ramp tick, in 1/256 velocity units.
  std::int32_t acceleration() const { return state_.acceleration; }

  void block(Tmc429Blocked blocked);
  /// True once after a switch has stopped, or begun to stop, a motion.
  bool take_stop_event();

  bool at_target() const { return state_.position == state_.settings.target_position; }

  std::uint64_t now() const { return state_.now; }
  /// Ticks in which fewer than `steps` steps are given for sure; the largest number when none will ever be.
  std::uint64_t ticks_for_steps(std::uint64_t steps) const;
  /// Lets time pass until `end` if that changes nothing else: nothing moves and nothing is about to. False if not so.
  bool rest(std::uint64_t end) {
    const bool resting = settled_ && state_.pulse_increment() == 0;
    state_.now = resting ? end : state_.now;
    return resting;
  }
  /// Lets time pass until `end` if all that happens is steps at one velocity, whatever their number. Nothing if not so.
  std::optional<Steps> coast_to(std::uint64_t end);
  /// Runs until `end`, or to the step that completes `reach`, or to where `until` says, or to where the next tick may
  /// turn the motion round after steps have been given: now() tells how far. Appends the tick of each step to
  /// `step_ticks`, if given.
  Steps advance(std::uint64_t end, const Tmc429Reach& reach = {}, Until until = Until::end,
                std::vector<std::uint64_t>* step_ticks = nullptr);

  friend bool operator==(const Tmc429Ramp& a, const Tmc429Ramp& b) {
    return a.state_ == b.state_ && a.stop_event_ == b.stop_event_;
  }

 private:
  /// One call of advance().
  struct Passage {
    std::uint64_t end;
    Tmc429Reach reach;
    std::vector<std::uint64_t>* step_ticks;
    /// The velocity that it must keep; nothing when that may change.
    std::optional<std::int32_t> kept_velocity;
    Steps steps;

    /// Steps in this direction that are still allowed.
    std::uint64_t left(bool decreasing) const;
    bool complete() const;
    /// To be called before extend() while there are no steps.
    void begin(std::uint64_t first_tick, bool decreasing);
    void extend(std::uint64_t count, std::uint64_t last_tick);
    void add(const Tmc429PulseTrain& train, bool decreasing);
  };

  /// The motion as seen in its own direction, in which nothing is negative, at the begin of a ramp tick.
  struct Heading {
    bool decreasing;
    std::int32_t velocity;
    std::int32_t acceleration;  ///< by which a ramp tick can change the velocity
    std::int32_t goal;          ///< of the velocity; 0 also where that has the other direction
    std::uint64_t distance;     ///< to the target, where the goal depends on it and falls on the way; otherwise 0
    std::uint64_t reach;        ///< as many steps may change more than the position
  };

  void obey_switches();
  std::uint64_t next_ramp_tick(std::uint64_t end) const;
  Tmc429PulseTrain pulses_until(std::uint64_t end) const;
  std::uint64_t distance_to_target() const;
  std::uint64_t steps_to_target() const;
  void coast(Passage& passage, std::uint64_t until);
  bool pulse_tick();
  void take_ramp_tick(Passage& passage);
  void settle(std::int32_t velocity_before, std::int32_t target_velocity_before);
  bool turns_round(const Passage& passage) const;
  std::optional<Heading> heading(const Passage& passage) const;
  bool leap(Passage& passage, std::uint64_t periods);
  bool leap_along_line(Passage& passage, const Heading& heading, std::uint64_t periods);
  bool leap_period_by_period(Passage& passage, const Heading& heading, std::uint64_t periods);

  Tmc429RampState state_;
  bool stop_event_ = false;
  /// The last ramp tick changed nothing and nothing was written since. Further ones will not change anything either,
  /// except that on the way to a target one may once the distance is less than `settled_distance_`.
  bool settled_ = false;
  std::uint64_t settled_distance_ = 0;
};

}  // namespace opentmcl::twin
