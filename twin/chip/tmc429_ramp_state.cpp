#include "twin/chip/tmc429_ramp_state.hpp"

#include <algorithm>
#include <cstdlib>

namespace opentmcl::twin {
namespace {

using tmc429::RampMode;

constexpr std::int32_t fraction = 1 << tmc429::velocity_fraction_bits;

}  // namespace

void Tmc429RampState::ramp_tick() {
  acceleration = 0;
  if (settings.mode == RampMode::hold) {
    return;
  }
  if (positioning()) {
    const std::int32_t distance = distance_to_target();
    const std::int32_t limit = distance == 0 ? 0 : velocity_limit(static_cast<std::uint64_t>(std::abs(distance)));
    settings.target_velocity = distance < 0 ? -limit : limit;
    if (distance == 0 && pulse_increment() <= static_cast<std::uint32_t>(settings.minimum_velocity)) {
      velocity = 0;
      return;
    }
  }
  acceleration =
      std::clamp(goal() * fraction - velocity, -settings.maximum_acceleration, settings.maximum_acceleration);
  velocity += acceleration;
}

bool Tmc429RampState::pulse_tick() {
  const std::uint32_t increment = pulse_increment();
  accumulator += increment;
  if (accumulator < tmc429::pulse_accumulator_size) {
    return false;
  }
  accumulator -= tmc429::pulse_accumulator_size;
  move(velocity < 0, 1);
  if (positioning() && position == settings.target_position &&
      increment <= static_cast<std::uint32_t>(settings.minimum_velocity)) {
    velocity = 0;
  }
  return true;
}

std::int32_t Tmc429RampState::velocity_limit(std::uint64_t distance) const {
  using namespace tmc429_choices;
  const std::uint64_t steps = braking_distance(distance);
  const std::int32_t velocity_to_stop =
      settings.mode == RampMode::ramp
          ? braking_velocity(steps, settings.multiplier, settings.divisor, settings.maximum_velocity)
          : soft_velocity(steps, settings.multiplier, settings.divisor, settings.maximum_velocity);
  return std::min(std::max(velocity_to_stop, settings.minimum_velocity), settings.maximum_velocity);
}

std::uint64_t Tmc429RampState::shortest_distance(std::int32_t limit) const {
  if (limit <= settings.minimum_velocity) {
    return 1;
  }
  using namespace tmc429_choices;
  const std::uint64_t distance = settings.mode == RampMode::ramp
                                     ? shortest_braking_distance(limit, settings.multiplier, settings.divisor)
                                     : shortest_soft_distance(limit, settings.multiplier, settings.divisor);
  return std::max<std::uint64_t>(distance, 1);
}

std::int32_t Tmc429RampState::goal() const {
  const std::int32_t limit = settings.maximum_velocity;
  const std::int32_t wanted =
      positioning() ? settings.target_velocity : std::clamp(settings.target_velocity, -limit, limit);
  return std::clamp(wanted, blocked.decreasing ? 0 : -tmc429::pulse_accumulator_size,
                    blocked.increasing ? 0 : tmc429::pulse_accumulator_size);
}

}  // namespace opentmcl::twin
