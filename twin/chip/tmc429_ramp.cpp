#include "twin/chip/tmc429_ramp.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "twin/chip/tmc429_choices.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::RampMode;

constexpr std::int32_t fraction = 1 << tmc429::velocity_fraction_bits;
constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

constexpr std::uint64_t next_multiple(std::uint64_t tick, unsigned exponent) {
  return ((tick >> exponent) + 1) << exponent;
}

constexpr bool is_multiple(std::uint64_t tick, unsigned exponent) {
  return (tick & ((std::uint64_t{1} << exponent) - 1)) == 0;
}

}  // namespace

void Tmc429Ramp::configure(const Settings& settings) {
  settings_ = settings;
  settled_ = false;
  obey_switches();
}

void Tmc429Ramp::set_position(std::int32_t position) {
  position_ = position;
  settled_ = false;
}

std::int32_t Tmc429Ramp::velocity() const {
  return tmc429_choices::integer_velocity(velocity_);
}

void Tmc429Ramp::set_velocity(std::int32_t velocity) {
  constexpr std::int32_t limit = tmc429::MaximumVelocity::Value::maximum;
  velocity_ = std::clamp(velocity, -limit, limit) * fraction;
  settled_ = false;
  stop_event_ |= runs_into(blocked_);
  obey_switches();
}

void Tmc429Ramp::block(Blocked blocked) {
  if (blocked == blocked_) {
    return;
  }
  stop_event_ |= runs_into(blocked) && !runs_into(blocked_);
  blocked_ = blocked;
  settled_ = false;
  obey_switches();
}

bool Tmc429Ramp::take_stop_event() {
  return std::exchange(stop_event_, false);
}

bool Tmc429Ramp::runs_into(const Blocked& blocked) const {
  return (blocked.decreasing && velocity_ < 0) || (blocked.increasing && velocity_ > 0);
}

void Tmc429Ramp::obey_switches() {
  const bool at_once = !blocked_.soft_stop || settings_.mode == RampMode::hold;
  if (at_once && runs_into(blocked_)) {
    velocity_ = 0;
  }
}

bool Tmc429Ramp::advance_to_step(std::uint64_t end) {
  while (now_ < end) {
    const std::uint64_t ramp = settled_ ? never : next_multiple(now_, settings_.ramp_divider);
    const std::uint64_t step = next_step_tick();
    if (ramp <= std::min(step, end)) {
      accumulate_until(ramp - 1);
      ramp_tick();
      now_ = ramp;
      if (is_multiple(ramp, settings_.pulse_divider) && pulse_tick()) {
        return true;
      }
    } else if (step <= end) {
      accumulate_until(step - 1);
      now_ = step;
      return pulse_tick();
    } else {
      accumulate_until(end);
    }
  }
  return false;
}

std::uint32_t Tmc429Ramp::pulse_increment() const {
  return static_cast<std::uint32_t>(std::abs(velocity()));
}

std::uint64_t Tmc429Ramp::next_step_tick() const {
  const std::uint32_t increment = pulse_increment();
  if (increment == 0) {
    return never;
  }
  const std::uint32_t missing = tmc429::pulse_accumulator_size - accumulator_;
  const std::uint64_t pulse_ticks = (missing + increment - 1) / increment;
  return ((now_ >> settings_.pulse_divider) + pulse_ticks) << settings_.pulse_divider;
}

/// Lets pulse ticks pass that are known to give no step.
void Tmc429Ramp::accumulate_until(std::uint64_t tick) {
  const std::uint64_t pulse_ticks = (tick >> settings_.pulse_divider) - (now_ >> settings_.pulse_divider);
  accumulator_ += static_cast<std::uint32_t>(pulse_ticks * pulse_increment());
  now_ = tick;
}

void Tmc429Ramp::ramp_tick() {
  const std::int32_t velocity_before = velocity_;
  const std::int32_t target_before = settings_.target_velocity;
  const std::int32_t limit = settings_.maximum_velocity;
  acceleration_ = 0;
  if (positioning()) {
    const std::int32_t distance = tmc429_choices::distance(position_, settings_.target_position);
    const std::int32_t magnitude = limited_velocity_to_target(distance);
    settings_.target_velocity = distance < 0 ? -magnitude : magnitude;
    if (distance == 0 && std::abs(velocity()) <= settings_.minimum_velocity) {
      velocity_ = 0;
    } else {
      approach(settings_.target_velocity);
    }
  } else if (settings_.mode == RampMode::velocity) {
    approach(std::clamp(settings_.target_velocity, -limit, limit));
  }
  settled_ = velocity_ == velocity_before && settings_.target_velocity == target_before;
}

std::int32_t Tmc429Ramp::limited_velocity_to_target(std::int32_t distance) const {
  if (distance == 0) {
    return 0;
  }
  const auto law = settings_.mode == RampMode::ramp ? tmc429_choices::braking_velocity : tmc429_choices::soft_velocity;
  const std::int32_t velocity = law(tmc429_choices::braking_distance(distance), settings_.multiplier, settings_.divisor,
                                    settings_.maximum_velocity);
  return std::min(std::max(velocity, settings_.minimum_velocity), settings_.maximum_velocity);
}

void Tmc429Ramp::approach(std::int32_t goal) {
  if (blocked_.decreasing) {
    goal = std::max(goal, 0);
  }
  if (blocked_.increasing) {
    goal = std::min(goal, 0);
  }
  acceleration_ =
      std::clamp(goal * fraction - velocity_, -settings_.maximum_acceleration, settings_.maximum_acceleration);
  velocity_ += acceleration_;
}

bool Tmc429Ramp::pulse_tick() {
  const std::uint32_t increment = pulse_increment();
  accumulator_ += increment;
  if (accumulator_ < tmc429::pulse_accumulator_size) {
    return false;
  }
  accumulator_ -= tmc429::pulse_accumulator_size;
  settled_ = false;
  position_ = tmc429_choices::distance(0, position_ + (velocity_ < 0 ? -1 : 1));
  if (positioning() && at_target() && increment <= static_cast<std::uint32_t>(settings_.minimum_velocity)) {
    velocity_ = 0;
  }
  return true;
}

}  // namespace opentmcl::twin
