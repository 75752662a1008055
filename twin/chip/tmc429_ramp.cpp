#include "twin/chip/tmc429_ramp.hpp"

#include <algorithm>
#include <cstdlib>
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

void Tmc429Ramp::configure(const Tmc429RampSettings& settings) {
  state_.settings = settings;
  settled_ = false;
  obey_switches();
}

void Tmc429Ramp::set_position(std::int32_t position) {
  state_.position = position;
  settled_ = false;
}

std::int32_t Tmc429Ramp::velocity() const {
  return tmc429_choices::integer_velocity(state_.velocity);
}

void Tmc429Ramp::set_velocity(std::int32_t velocity) {
  constexpr std::int32_t limit = tmc429::MaximumVelocity::Value::maximum;
  state_.velocity = std::clamp(velocity, -limit, limit) * fraction;
  settled_ = false;
  stop_event_ |= state_.runs_into(state_.blocked);
  obey_switches();
}

void Tmc429Ramp::block(Tmc429Blocked blocked) {
  if (blocked == state_.blocked) {
    return;
  }
  stop_event_ |= state_.runs_into(blocked) && !state_.runs_into(state_.blocked);
  state_.blocked = blocked;
  settled_ = false;
  obey_switches();
}

bool Tmc429Ramp::take_stop_event() {
  return std::exchange(stop_event_, false);
}

void Tmc429Ramp::obey_switches() {
  const bool at_once = !state_.blocked.soft_stop || state_.settings.mode == RampMode::hold;
  if (at_once && state_.runs_into(state_.blocked)) {
    state_.velocity = 0;
  }
}

std::uint64_t Tmc429Ramp::Passage::left(bool decreasing) const {
  const std::uint64_t allowed = decreasing ? reach.decreasing : reach.increasing;
  return allowed - steps.count;  // of that direction: one passage has but one
}

bool Tmc429Ramp::Passage::complete() const {
  return steps.count != 0 && left(steps.decreasing) == 0;
}

void Tmc429Ramp::Passage::begin(std::uint64_t first_tick, bool decreasing) {
  steps.first_tick = first_tick;
  steps.decreasing = decreasing;
}

void Tmc429Ramp::Passage::extend(std::uint64_t count, std::uint64_t last_tick) {
  steps.count += count;
  steps.last_tick = last_tick;
}

void Tmc429Ramp::Passage::add(const Tmc429PulseTrain& train, bool decreasing) {
  if (train.steps() == 0) {
    return;
  }
  if (steps.count == 0) {
    begin(train.tick_of_first_step(), decreasing);
  }
  extend(train.steps(), train.tick_of_last_step());
  if (step_ticks != nullptr) {
    train.list_steps(*step_ticks);
  }
}

Tmc429Ramp::Steps Tmc429Ramp::advance(std::uint64_t end, const Tmc429Reach& reach, Until until,
                                      std::vector<std::uint64_t>* step_ticks) {
  Passage passage{.end = end, .reach = reach, .step_ticks = step_ticks, .kept_velocity = {}, .steps = {}};
  if (until == Until::velocity_changes) {
    passage.kept_velocity = state_.velocity;
  }
  const auto over = [&] {
    return state_.now >= end || passage.complete() ||
           state_.velocity != passage.kept_velocity.value_or(state_.velocity);
  };
  while (!over()) {
    const std::uint64_t ramp_tick = next_ramp_tick(end);
    const std::uint64_t before_ramp_tick = std::min(ramp_tick - 1, end);
    coast(passage, before_ramp_tick);
    if (over()) {
      break;
    }
    settled_ = false;
    // The last ramp tick is left to its law, which also sets the registers that tell of it.
    const unsigned divider = state_.settings.ramp_divider;
    if (state_.now < before_ramp_tick || leap(passage, (end >> divider) - (ramp_tick >> divider))) {
      continue;
    }
    if (turns_round(passage)) {
      break;
    }
    take_ramp_tick(passage);
  }
  return passage.steps;
}

std::optional<Tmc429Ramp::Steps> Tmc429Ramp::coast_to(std::uint64_t end) {
  const Tmc429PulseTrain train = pulses_until(end);
  if (!settled_ || train.increment == 0) {
    return std::nullopt;
  }
  const std::uint64_t count = train.steps();
  if (state_.positioning() && count + settled_distance_ >= distance_to_target()) {
    return std::nullopt;
  }
  const bool decreasing = state_.velocity < 0;
  state_.accumulator = train.accumulator_at_end();
  state_.move(decreasing, count);
  state_.now = end;
  if (count == 0) {
    return Steps{};
  }
  return Steps{count, train.tick_of_first_step(), train.tick_of_last_step(), decreasing};
}

/// Steps of the shorter way round the 24-bit circle.
std::uint64_t Tmc429Ramp::distance_to_target() const {
  return static_cast<std::uint64_t>(std::abs(state_.distance_to_target()));
}

/// The next ramp tick that may change something; some tick after `end` if there is none before.
std::uint64_t Tmc429Ramp::next_ramp_tick(std::uint64_t end) const {
  if (!settled_) {
    return next_multiple(state_.now, state_.settings.ramp_divider);
  }
  if (!state_.positioning() || state_.pulse_increment() == 0) {
    return never;
  }
  const std::uint64_t distance = distance_to_target();
  if (distance < settled_distance_) {
    return next_multiple(state_.now, state_.settings.ramp_divider);
  }
  const Tmc429PulseTrain train = pulses_until(end);
  const std::uint64_t steps = distance - settled_distance_;
  return train.steps() <= steps ? never : next_multiple(train.tick_of_step(steps + 1), state_.settings.ramp_divider);
}

/// All pulse ticks from now to `end`, if the velocity stays as it is.
Tmc429PulseTrain Tmc429Ramp::pulses_until(std::uint64_t end) const {
  const unsigned divider = state_.settings.pulse_divider;
  return {.begin = state_.now,
          .pulse_ticks = (end >> divider) - (state_.now >> divider),
          .divider = divider,
          .accumulator = state_.accumulator,
          .increment = state_.pulse_increment()};
}

/// Steps to the target if the motion goes on in its direction, be it around the 24-bit circle; never 0.
std::uint64_t Tmc429Ramp::steps_to_target() const {
  constexpr std::uint32_t circle = 1u << tmc429::position_bits;
  const auto distance = static_cast<std::uint32_t>(state_.distance_to_target());
  const std::uint32_t steps = (state_.velocity < 0 ? 0u - distance : distance) & (circle - 1);
  return steps == 0 ? circle : steps;
}

/// Keeps the present velocity until a tick up to which no ramp tick changes it, or to a step that must be the last one
/// or may stop the motion.
void Tmc429Ramp::coast(Passage& passage, std::uint64_t until) {
  Tmc429PulseTrain train = pulses_until(until);
  if (train.pulse_ticks == 0 || train.increment == 0) {
    state_.now = until;
    return;
  }
  const bool decreasing = state_.velocity < 0;
  const std::uint64_t left = passage.left(decreasing);
  const std::uint64_t reach = state_.positioning() ? std::min(left, steps_to_target()) : left;
  if (train.steps() < reach) {
    passage.add(train, decreasing);
    state_.accumulator = train.accumulator_at_end();
    state_.move(decreasing, train.steps());
    state_.now = until;
    return;
  }
  const std::uint64_t last_tick = train.tick_of_step(reach);
  train.pulse_ticks = (last_tick >> train.divider) - (state_.now >> train.divider);
  passage.add(train, decreasing);
  // The last pulse tick is left to its law.
  --train.pulse_ticks;
  state_.accumulator = train.accumulator_at_end();
  state_.move(decreasing, train.steps());
  pulse_tick();
  state_.now = last_tick;
}

bool Tmc429Ramp::pulse_tick() {
  const bool step = state_.pulse_tick();
  if (step && state_.positioning() && at_target()) {
    settled_ = false;
  }
  return step;
}

void Tmc429Ramp::take_ramp_tick(Passage& passage) {
  const std::int32_t velocity_before = state_.velocity;
  const std::int32_t target_before = state_.settings.target_velocity;
  state_.ramp_tick();
  settle(velocity_before, target_before);
  ++state_.now;
  if (!is_multiple(state_.now, state_.settings.pulse_divider)) {
    return;
  }
  const bool decreasing = state_.velocity < 0;
  if (pulse_tick()) {
    if (passage.steps.count == 0) {
      passage.begin(state_.now, decreasing);
    }
    passage.extend(1, state_.now);
    if (passage.step_ticks != nullptr) {
      passage.step_ticks->push_back(state_.now);
    }
  }
}

/// After a ramp tick: finds out whether further ones will change anything, and from where on.
void Tmc429Ramp::settle(std::int32_t velocity_before, std::int32_t target_velocity_before) {
  const std::int32_t target_velocity = state_.settings.target_velocity;
  settled_ = state_.velocity == velocity_before && target_velocity == target_velocity_before;
  if (!settled_ || !state_.positioning() || state_.pulse_increment() == 0) {
    return;
  }
  // On the way to its target it stays at its velocity as long as V_TARGET does. In the other direction and at the
  // target itself every step counts.
  const std::int32_t distance = state_.distance_to_target();
  settled_ = distance != 0 && (distance < 0) == (state_.velocity < 0);
  settled_distance_ = settled_ ? state_.shortest_distance(std::abs(target_velocity)) : 0;
}

/// Steps have been given, and the next ramp tick gives the velocity the other sign.
bool Tmc429Ramp::turns_round(const Passage& passage) const {
  if (passage.steps.count == 0 || std::abs(state_.velocity) >= state_.settings.maximum_acceleration) {
    return false;
  }
  Tmc429RampState next = state_;
  next.ramp_tick();
  return next.velocity != 0 && (next.velocity < 0) != passage.steps.decreasing;
}

std::uint64_t Tmc429Ramp::ticks_for_steps(std::uint64_t steps) const {
  if (state_.velocity == 0 && settled_) {
    return never;
  }
  std::int32_t fastest = (std::abs(state_.velocity) + fraction - 1) / fraction;
  if (state_.positioning()) {
    fastest = std::max(fastest, state_.settings.maximum_velocity);
  } else if (state_.settings.mode == RampMode::velocity) {
    fastest = std::max(fastest, std::min(std::abs(state_.settings.target_velocity), state_.settings.maximum_velocity));
  }
  if (fastest == 0) {
    return never;
  }
  constexpr std::uint64_t most_steps = std::uint64_t{1} << 32;  // hours at any speed
  const std::uint64_t phase = std::min(steps, most_steps) * tmc429::pulse_accumulator_size - state_.accumulator;
  const std::uint64_t pulse_ticks = (phase - 1) / static_cast<std::uint64_t>(fastest);
  return pulse_ticks << state_.settings.pulse_divider;
}

}  // namespace opentmcl::twin
