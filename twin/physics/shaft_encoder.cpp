#include "twin/physics/shaft_encoder.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace opentmcl::twin {
namespace {

/// Of the four counts of a line, A and B are both high in the first; then, upwards, A low, both low, B low.
constexpr std::int64_t counts_per_line = 4;

constexpr bool channel_a(std::int64_t place) {
  const std::int64_t quarter = floor_remainder(place, counts_per_line);
  return quarter == 0 || quarter == 3;
}
constexpr bool channel_b(std::int64_t place) {
  const std::int64_t quarter = floor_remainder(place, counts_per_line);
  return quarter == 0 || quarter == 1;
}

/// Which of the four counts of a line two levels mean to a decoder.
constexpr std::int64_t quarter_of(bool a, bool b) {
  if (a) return b ? 0 : 3;
  return b ? 1 : 2;
}

/// Parts of a microstep in which the errors of a magnet are added up.
constexpr std::int64_t fraction = 256;

/// amplitude × sin of an angle in microsteps, in 1/256 of the unit of the amplitude, rounded down. In whole numbers, so
/// that it is the same everywhere: sin(π x) ≈ 16 x (1 − x) / (5 − 4 x (1 − x)) for x from 0 to 1 (Bhaskara I), off by
/// at most 0.0017 of the amplitude.
constexpr std::int64_t sine_product(std::int64_t amplitude, std::int64_t angle) {
  constexpr std::int64_t half = microsteps_per_turn / 2;
  const std::int64_t within = floor_remainder(angle, microsteps_per_turn);
  const std::int64_t x = within % half;
  const std::int64_t bow = x * (half - x);
  const std::int64_t product = 16 * bow * amplitude * fraction;
  return floor_quotient(within < half ? product : -product, 5 * half * half - 4 * bow);
}

/// The last place of `period` times a whole number plus `phase` that is not above `place`.
constexpr std::int64_t at_or_below(std::int64_t place, std::int64_t period, std::int64_t phase) {
  return floor_quotient(place - phase, period) * period + phase;
}
/// The first whole number of periods that is not below `place`.
constexpr std::int64_t at_or_above(std::int64_t place, std::int64_t period) {
  return ceiling_quotient(place, period) * period;
}

}  // namespace

ShaftEncoder::ShaftEncoder(const EncoderProperties& properties)
    : properties_(properties),
      counts_per_turn_(properties.kind == Kind::absolute ? absolute_counts_per_turn
                                                         : counts_per_line * properties.lines),
      state_{.place = place_at(0)} {
  if (properties_.kind == Kind::absolute) {
    // What sensOstep calls its zero is the first of its counts.
    properties_.null_position = 0;
    properties_.null_width = 1;
  }
  power_up();
}

void ShaftEncoder::power_up() {
  state_.zero =
      properties_.kind == Kind::absolute ? at_or_below(state_.place, counts_per_turn_, 0) : decoded(state_.place);
  for (auto& event : state_.events) event.reset();
}

std::int64_t ShaftEncoder::place_of(std::int64_t turned) const {
  if (properties_.kind == Kind::absolute) {
    const std::int64_t magnet_angle = turned + properties_.magnet_offset;
    turned = magnet_angle + harmonic_error(magnet_angle);
  }
  return floor_quotient(turned * counts_per_turn_, microsteps_per_turn);
}

std::int64_t ShaftEncoder::harmonic_error(std::int64_t magnet_angle) const {
  const auto& first = properties_.first_harmonic;
  const auto& second = properties_.second_harmonic;
  if (first.amplitude == 0 && second.amplitude == 0) return 0;
  const std::int64_t error = sine_product(first.amplitude, magnet_angle + first.phase) +
                             sine_product(second.amplitude, 2 * magnet_angle + second.phase);
  return floor_quotient(error, fraction);
}

/// The angle, in the direction in which this encoder counts, where `place` begins.
std::int64_t ShaftEncoder::first_turned_at(std::int64_t place) const {
  const std::int64_t ideal = ceiling_quotient(place * microsteps_per_turn, counts_per_turn_);
  if (properties_.kind == Kind::incremental) return ideal;
  // place_of() only rises, and strays from the ideal by less than the largest error there may be.
  constexpr std::int64_t largest_error = 7'900;
  std::int64_t below = ideal - properties_.magnet_offset - largest_error;
  std::int64_t above = below + 2 * largest_error;
  while (above - below > 1) {
    const std::int64_t middle = below + (above - below) / 2;
    (place_of(middle) < place ? below : above) = middle;
  }
  return above;
}

void ShaftEncoder::move_to(std::int64_t place) {
  const std::int64_t before = std::exchange(state_.place, place);
  if (properties_.kind == Kind::absolute) {
    // It has no N whose level could be chosen.
    if (const auto event = last_event(before, place, true)) state_.events[0] = state_.events[1] = count_in(*event);
    return;
  }
  for (const bool level : {false, true}) {
    if (const auto event = last_event(before, place, level)) state_.events[level ? 1 : 0] = count_in(*event);
  }
}

// ---- Counting

/// Which quarter of a line a decoder sees: a broken wire reads high.
std::int64_t ShaftEncoder::seen_quarter(std::int64_t place) const {
  return quarter_of(channel_a(place) || state_.a_broken, channel_b(place) || state_.b_broken);
}

/// What a decoder has counted at a place, but for a constant. With one channel alone it goes back and forth by one.
std::int64_t ShaftEncoder::decoded(std::int64_t place) const {
  if (!state_.a_broken && !state_.b_broken) return place;
  const std::int64_t quarter = seen_quarter(place);
  return quarter == 3 ? -1 : quarter;  // 3 comes before 0
}

void ShaftEncoder::break_wire(EncoderChannel channel, bool broken) {
  if (properties_.kind == Kind::absolute) return;
  const std::int64_t count_before = count();
  const std::int64_t quarter_before = seen_quarter(state_.place);
  const bool showed[] = {shows_event(state_.place, false), shows_event(state_.place, true)};
  (channel == EncoderChannel::a   ? state_.a_broken
   : channel == EncoderChannel::b ? state_.b_broken
                                  : state_.n_broken) = broken;
  // One channel that changes its level is a step to a neighbouring quarter, up or down.
  const std::int64_t step = floor_remainder(seen_quarter(state_.place) - quarter_before + 1, counts_per_line) - 1;
  state_.zero = decoded(state_.place) - (count_before + step);
  for (const bool level : {false, true}) {
    if (!showed[level ? 1 : 0] && shows_event(state_.place, level)) state_.events[level ? 1 : 0] = count();
  }
}

bool ShaftEncoder::wire_broken(EncoderChannel channel) const {
  if (channel == EncoderChannel::a) return state_.a_broken;
  return channel == EncoderChannel::b ? state_.b_broken : state_.n_broken;
}

// ---- The null position

bool ShaftEncoder::is_near_null(std::int64_t place) const {
  const std::int64_t beyond = floor_remainder(place, counts_per_turn_);
  return std::min(beyond, counts_per_turn_ - beyond) <= near_counts;
}

std::int64_t ShaftEncoder::null_begin_at_or_below(std::int64_t place) const {
  return at_or_below(place, counts_per_turn_, properties_.null_position);
}

bool ShaftEncoder::is_in_null(std::int64_t place) const {
  return place - null_begin_at_or_below(place) < properties_.null_width;
}

bool ShaftEncoder::shows_event(std::int64_t place, bool level) const {
  const bool n = state_.n_broken || is_in_null(place) == properties_.null_level;
  return n == level && seen_quarter(place) == 0;
}

/// The last place on the way from `before` to `after` at which an event begins.
std::optional<std::int64_t> ShaftEncoder::last_event(std::int64_t before, std::int64_t after, bool level) const {
  const bool up = after > before;
  if (properties_.kind == Kind::absolute) {
    return up ? last_event_up(before, after, true) : last_event_down(before, after, true);
  }
  if (intact()) {
    const bool in_null = level == properties_.null_level;
    return up ? last_event_up(before, after, in_null) : last_event_down(before, after, in_null);
  }
  // Count by count; each turn is like the one before.
  const std::int64_t back = up ? -1 : 1;
  const std::int64_t limit = std::min(std::abs(after - before), counts_per_turn_);
  for (std::int64_t i = 0; i < limit; ++i) {
    const std::int64_t place = after + back * i;
    if (shows_event(place, level) && !shows_event(place + back, level)) return place;
  }
  return std::nullopt;
}

/// With all wires whole A and B are high together for a single count of each line, so every such place is an arrival.
std::optional<std::int64_t> ShaftEncoder::last_event_up(std::int64_t before, std::int64_t after, bool in_null) const {
  std::int64_t place = at_or_below(after, counts_per_line, 0);
  while (place > before && is_in_null(place) != in_null) {
    const std::int64_t begin = null_begin_at_or_below(place);
    place = at_or_below(in_null ? begin + properties_.null_width - 1 : begin - 1, counts_per_line, 0);
  }
  return place > before ? std::optional(place) : std::nullopt;
}

std::optional<std::int64_t> ShaftEncoder::last_event_down(std::int64_t before, std::int64_t after, bool in_null) const {
  std::int64_t place = at_or_above(after, counts_per_line);
  while (place < before && is_in_null(place) != in_null) {
    const std::int64_t begin = null_begin_at_or_below(place);
    place = at_or_above(in_null ? begin + counts_per_turn_ : begin + properties_.null_width, counts_per_line);
  }
  return place < before ? std::optional(place) : std::nullopt;
}

std::optional<std::int64_t> ShaftEncoder::take_null_event(bool level) {
  return std::exchange(state_.events[properties_.kind == Kind::absolute || level ? 1 : 0], std::nullopt);
}

EventDistance ShaftEncoder::null_distance(std::int64_t angle) const {
  const std::int64_t turned = properties_.reversed ? -angle : angle;
  const std::int64_t place = place_of(turned);
  const std::int64_t begin = null_begin_at_or_below(place);
  const bool inside = is_in_null(place);
  const std::int64_t next_up = inside ? begin + properties_.null_width : begin + counts_per_turn_;
  const std::int64_t next_down = inside ? begin : begin + properties_.null_width;
  const EventDistance distance{.down = turned - first_turned_at(next_down) + 1,
                               .up = first_turned_at(next_up) - turned};
  return properties_.reversed ? EventDistance{distance.up, distance.down} : distance;
}

}  // namespace opentmcl::twin
