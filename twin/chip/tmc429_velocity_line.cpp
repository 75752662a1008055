#include "twin/chip/tmc429_velocity_line.hpp"

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/floor_sum.hpp"
#include "twin/chip/tmc429_pulse_train.hpp"

namespace opentmcl::twin {
namespace {

constexpr std::uint64_t fraction = 1u << tmc429::velocity_fraction_bits;

/// Σ ⌊(first + slope i) / 256⌋ for i = 0…count-1: what so many equally distant pulse ticks add to the phase.
std::uint64_t sum_of_increments(std::uint64_t count, std::int64_t first, std::int64_t slope) {
  if (count == 0) {
    return 0;
  }
  if (slope == 0) {
    return count * (static_cast<std::uint64_t>(first) / fraction);
  }
  // A falling line has the same sum from its low end.
  const std::int64_t lowest = slope < 0 ? first + slope * static_cast<std::int64_t>(count - 1) : first;
  return floor_sum(count, static_cast<std::uint64_t>(lowest), static_cast<std::uint64_t>(slope < 0 ? -slope : slope),
                   fraction);
}

}  // namespace

std::int32_t Tmc429VelocityLine::velocity_after(std::uint64_t periods) const {
  return velocity + static_cast<std::int32_t>(change * static_cast<std::int64_t>(periods));
}

std::uint64_t Tmc429VelocityLine::phase_after(std::uint64_t periods) const {
  if (ramp_divider >= pulse_divider) {
    const std::uint64_t pulse_ticks_per_period = std::uint64_t{1} << (ramp_divider - pulse_divider);
    return accumulator + pulse_ticks_per_period * sum_of_increments(periods, velocity_after(1), change);
  }
  // A pulse tick falls on every so-many-th ramp tick, with the velocity which that one gives.
  const std::uint64_t stride = std::uint64_t{1} << (pulse_divider - ramp_divider);
  const std::uint64_t first = stride - (begin >> ramp_divider) % stride;
  const std::uint64_t pulse_ticks = first <= periods ? (periods - first) / stride + 1 : 0;
  return accumulator +
         sum_of_increments(pulse_ticks, velocity_after(first), change * static_cast<std::int64_t>(stride));
}

std::uint64_t Tmc429VelocityLine::steps_after(std::uint64_t periods) const {
  return phase_after(periods) / Tmc429PulseTrain::step;
}

std::uint64_t Tmc429VelocityLine::tick_of_step(std::uint64_t number, std::uint64_t periods) const {
  std::uint64_t before = 0;  // periods after which the step is still to come
  if (change != 0) {
    for (std::uint64_t by = periods; before + 1 < by;) {
      const std::uint64_t middle = (before + by) / 2;
      (steps_after(middle) < number ? before : by) = middle;
    }
  }
  const std::uint64_t phase = phase_after(before);
  const Tmc429PulseTrain train{
      .begin = end_of(before),
      .pulse_ticks = 0,  // as many as it takes
      .divider = pulse_divider,
      .accumulator = static_cast<std::uint32_t>(phase % Tmc429PulseTrain::step),
      .increment = static_cast<std::uint32_t>(velocity_after(before + 1)) >> tmc429::velocity_fraction_bits,
  };
  return train.tick_of_step(number - phase / Tmc429PulseTrain::step);
}

}  // namespace opentmcl::twin
