// Many ramp ticks at once: along straight stretches of the velocity, or in a tight loop where it follows the target.
#include <algorithm>
#include <cstdlib>

#include "twin/chip/tmc429_ramp.hpp"
#include "twin/chip/tmc429_velocity_line.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::RampMode;

constexpr std::int32_t fraction = 1 << tmc429::velocity_fraction_bits;
constexpr std::int64_t half_circle = std::int64_t{1} << (tmc429::position_bits - 1);

/// Periods from which on a line is cheaper than the loop: with constant velocity it has one increment, otherwise its
/// first and last step must be searched.
constexpr std::uint64_t worthwhile_periods(std::int32_t change) {
  return change == 0 ? 8 : 256;
}

/// The largest number that fits, when `fitting` does, `too_many` does not, and all up to the wanted one do.
template <class Fits>
std::uint64_t last_that_fits(std::uint64_t fitting, std::uint64_t too_many, Fits fits) {
  while (fitting + 1 < too_many) {
    const std::uint64_t middle = fitting + (too_many - fitting) / 2;
    (fits(middle) ? fitting : too_many) = middle;
  }
  return fitting;
}

/// The goal of a velocity on the way to the target, which falls as the distance does. Calculated anew only where it
/// does.
class GoalOnTheWay {
 public:
  /// With a distance of 0 the goal is the same everywhere.
  GoalOnTheWay(const Tmc429RampState& state, std::uint64_t distance, std::int32_t goal)
      : state_(state), distance_(distance), goal_(goal) {
    if (distance != 0) {
      find_where_it_falls();
    }
  }

  std::int32_t after(std::uint64_t steps) {
    if (steps > last_step_with_goal_) {
      goal_ = state_.velocity_limit(distance_ - steps) * fraction;
      find_where_it_falls();
    }
    return goal_;
  }

 private:
  void find_where_it_falls() { last_step_with_goal_ = distance_ - state_.shortest_distance(goal_ / fraction); }

  const Tmc429RampState& state_;
  std::uint64_t distance_;
  std::int32_t goal_;
  std::uint64_t last_step_with_goal_ = std::numeric_limits<std::uint64_t>::max();
};

/// Notices that the velocity has changed by the same amount so often that a line may be worthwhile.
class LineDetector {
 public:
  /// On the way to a target no line falls: there the velocity follows the distance.
  void note(std::int32_t change, bool follows_target) {
    const bool again = change == change_ && (change >= 0 || !follows_target);
    more_until_found_ = again ? more_until_found_ - 1 : worthwhile_periods(change);
    change_ = change;
  }
  bool found() const { return more_until_found_ == 0; }

 private:
  std::int32_t change_ = 0;
  std::uint64_t more_until_found_ = worthwhile_periods(0);
};

}  // namespace

/// Nothing where a motion may stop at, or turn round to, its target in the next period: that is left to the laws.
std::optional<Tmc429Ramp::Heading> Tmc429Ramp::heading(const Passage& passage) const {
  const Tmc429RampSettings& settings = state_.settings;
  const std::int32_t acceleration = settings.mode == RampMode::hold ? 0 : settings.maximum_acceleration;
  const std::int32_t velocity = std::abs(state_.velocity);
  if (!state_.positioning()) {
    const std::int32_t goal = state_.goal();
    const bool decreasing = state_.velocity < 0 || (state_.velocity == 0 && goal < 0);
    return Heading{.decreasing = decreasing,
                   .velocity = velocity,
                   .acceleration = acceleration,
                   .goal = std::max(decreasing ? -goal : goal, 0) * fraction,
                   .distance = 0,
                   .reach = passage.left(decreasing)};
  }
  const std::int32_t way = state_.distance_to_target();
  if (way == 0) {
    return std::nullopt;
  }
  const bool target_is_below = way < 0;
  const bool decreasing = state_.velocity < 0 || (state_.velocity == 0 && target_is_below);
  const auto distance = static_cast<std::uint64_t>(std::abs(std::int64_t{way}));
  Heading heading{.decreasing = decreasing,
                  .velocity = velocity,
                  .acceleration = acceleration,
                  .goal = 0,
                  .distance = 0,
                  .reach = passage.left(decreasing)};
  if (decreasing != target_is_below) {
    // On the other side of the circle the target lies in the other direction.
    heading.reach = std::min<std::uint64_t>(heading.reach, static_cast<std::uint64_t>(half_circle) - distance);
    return heading;
  }
  heading.reach = std::min(heading.reach, distance);
  if (!(decreasing ? state_.blocked.decreasing : state_.blocked.increasing)) {
    heading.goal = state_.velocity_limit(distance) * fraction;
    heading.distance = distance;
  }
  return heading;
}

/// Lets up to so many ramp periods pass that begin on the next tick; false when the first of them needs the law.
bool Tmc429Ramp::leap(Passage& passage, std::uint64_t periods) {
  if (periods == 0) {
    return false;
  }
  const std::optional<Heading> now = heading(passage);
  const bool settles = now && now->acceleration != 0 && now->goal == now->velocity;
  if (!now || settles || (passage.steps.count != 0 && now->decreasing != passage.steps.decreasing)) {
    return false;
  }
  return leap_along_line(passage, *now, periods) || leap_period_by_period(passage, *now, periods);
}

bool Tmc429Ramp::leap_along_line(Passage& passage, const Heading& heading, std::uint64_t periods) {
  const std::int32_t acceleration = heading.acceleration;
  const std::int32_t missing = heading.goal - heading.velocity;
  const bool follows_target = heading.distance != 0 && acceleration != 0;
  Tmc429VelocityLine line{.begin = state_.now,
                          .accumulator = state_.accumulator,
                          .velocity = heading.velocity,
                          .change = 0,
                          .pulse_divider = state_.settings.pulse_divider,
                          .ramp_divider = state_.settings.ramp_divider};
  if (acceleration != 0) {
    const std::int32_t highest = follows_target ? state_.settings.maximum_velocity * fraction : heading.goal;
    const bool rising = missing >= acceleration;
    if (!rising && (follows_target || missing > -acceleration)) {
      return false;
    }
    line.change = rising ? acceleration : -acceleration;
    // Falling, it stops a tick before the last whole change, so that a law turns the velocity round and the one before.
    const std::int32_t changes = rising ? (highest - heading.velocity) / acceleration : -missing / acceleration - 1;
    periods = std::min(periods, static_cast<std::uint64_t>(changes));
  }
  if (line.change != 0 && (passage.kept_velocity || passage.step_ticks != nullptr)) {
    return false;
  }

  // Whether so many periods are on the line and leave the step of the reach to come. If more are, fewer are.
  const auto fits = [&](std::uint64_t count) {
    if (line.steps_after(count) >= heading.reach) {
      return false;
    }
    return !follows_target || state_.velocity_limit(heading.distance - line.steps_after(count - 1)) * fraction >=
                                  line.velocity_after(count);
  };
  const std::uint64_t worthwhile = passage.kept_velocity ? 1 : worthwhile_periods(line.change);
  if (periods < worthwhile || !fits(worthwhile)) {
    return false;
  }
  const std::uint64_t fitting = fits(periods) ? periods : last_that_fits(worthwhile, periods, fits);
  if (line.change == 0) {
    coast(passage, line.end_of(fitting));
    return true;
  }
  const std::uint64_t phase = line.phase_after(fitting);
  const std::uint64_t steps = phase / Tmc429PulseTrain::step;
  if (steps != 0) {
    if (passage.steps.count == 0) {
      passage.begin(line.tick_of_step(1, fitting), heading.decreasing);
    }
    passage.extend(steps, line.tick_of_step(steps, fitting));
  }
  state_.move(heading.decreasing, steps);
  state_.accumulator = static_cast<std::uint32_t>(phase % Tmc429PulseTrain::step);
  const std::int32_t velocity = line.velocity_after(fitting);
  state_.velocity = heading.decreasing ? -velocity : velocity;
  state_.now = line.end_of(fitting);
  return true;
}

bool Tmc429Ramp::leap_period_by_period(Passage& passage, const Heading& heading, std::uint64_t periods) {
  if (passage.kept_velocity) {
    return false;
  }
  const std::int32_t acceleration = heading.acceleration;
  const std::uint64_t period = std::uint64_t{1} << state_.settings.ramp_divider;
  const std::uint64_t end = state_.now + periods * period;
  GoalOnTheWay goal{state_, heading.distance, heading.goal};
  LineDetector line;
  std::vector<std::uint64_t>* const listed = passage.step_ticks;
  bool no_step_yet = passage.steps.count == 0;
  std::int32_t velocity = heading.velocity;
  std::uint64_t steps_given = 0;
  Tmc429PulseTrain train = pulses_until(state_.now);
  Tmc429PulseTrain latest_with_steps = train;
  while (train.begin < end && !line.found()) {
    const std::int32_t wanted = goal.after(steps_given);
    const std::int32_t next_velocity =
        wanted > velocity ? std::min(velocity + acceleration, wanted) : std::max(velocity - acceleration, wanted);
    if (wanted == 0 && next_velocity < acceleration) {
      break;  // The law must turn the velocity round, and make the change before that.
    }
    train.pulse_ticks = ((train.begin + period) >> train.divider) - (train.begin >> train.divider);
    train.increment = static_cast<std::uint32_t>(next_velocity) >> tmc429::velocity_fraction_bits;
    const std::uint64_t steps = train.steps();
    if (steps_given + steps >= heading.reach) {
      break;
    }
    if (steps != 0) {
      if (no_step_yet) {
        passage.begin(train.tick_of_first_step(), heading.decreasing);
        no_step_yet = false;
      }
      if (listed != nullptr) {
        const Tmc429PulseTrain copy = train;  // so that `train` itself can stay in registers
        copy.list_steps(*listed);
      }
      latest_with_steps = train;
      steps_given += steps;
    }
    line.note(next_velocity - velocity, heading.distance != 0);
    velocity = next_velocity;
    train.accumulator = train.accumulator_at_end();
    train.begin += period;
  }
  if (train.begin == state_.now) {
    return false;
  }
  if (steps_given != 0) {
    passage.extend(steps_given, latest_with_steps.tick_of_last_step());
  }
  state_.move(heading.decreasing, steps_given);
  state_.accumulator = train.accumulator;
  state_.velocity = heading.decreasing ? -velocity : velocity;
  state_.now = train.begin;
  return true;
}

}  // namespace opentmcl::twin
