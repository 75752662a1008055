#include "twin/physics/shaft_encoder.hpp"

#include <utility>

#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {
namespace {

constexpr std::int64_t microsteps_per_count = microsteps_per_turn / ShaftEncoder::counts_per_turn;
static_assert(microsteps_per_count * ShaftEncoder::counts_per_turn == microsteps_per_turn);

/// Of the four counts of a line, A and B are both high in the first.
constexpr std::int64_t counts_per_line = 4;

/// The last multiple of `period` that a way from `before` to `after` arrives at; nothing if it arrives at none.
std::optional<std::int64_t> last_arrival(std::int64_t before, std::int64_t after, std::int64_t period) {
  const bool up = after > before;
  const std::int64_t multiple = (up ? floor_quotient(after, period) : ceiling_quotient(after, period)) * period;
  const bool on_the_way = up ? multiple > before : multiple < before;
  return on_the_way ? std::optional(multiple) : std::nullopt;
}

}  // namespace

void ShaftEncoder::power_up() {
  zero_ = kind_ == Kind::absolute ? floor_quotient(place_, counts_per_turn) * counts_per_turn : place_;
  null_passed_.reset();
  other_line_passed_.reset();
}

void ShaftEncoder::move_to(std::int64_t angle) {
  const std::int64_t before = std::exchange(place_, floor_quotient(angle, microsteps_per_count));
  count_begins_ = place_ * microsteps_per_count;
  count_ends_ = count_begins_ + microsteps_per_count;
  if (place_ != before) note_null_events(before);
}

void ShaftEncoder::note_null_events(std::int64_t before) {
  if (const auto null = last_arrival(before, place_, counts_per_turn)) null_passed_ = null;
  auto line = last_arrival(before, place_, counts_per_line);
  if (line && *line % counts_per_turn == 0) {
    // The line of the null position does not count: the one before it, if that was on the way too.
    const std::int64_t previous = place_ > before ? *line - counts_per_line : *line + counts_per_line;
    const bool on_the_way = place_ > before ? previous > before : previous < before;
    line = on_the_way ? std::optional(previous) : std::nullopt;
  }
  if (line) other_line_passed_ = line;
}

bool ShaftEncoder::near_null() const {
  const std::int64_t turns = floor_quotient(place_ + counts_per_turn / 2, counts_per_turn);
  const std::int64_t distance = place_ - turns * counts_per_turn;
  return distance >= -near_counts && distance <= near_counts;
}

std::optional<std::int64_t> ShaftEncoder::take_null_event(bool level) {
  const bool sees_null = kind_ == Kind::absolute || level == null_level_;
  const auto event = std::exchange(sees_null ? null_passed_ : other_line_passed_, std::nullopt);
  return event ? std::optional(*event - zero_) : std::nullopt;
}

}  // namespace opentmcl::twin
