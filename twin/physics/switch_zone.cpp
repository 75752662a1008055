#include "twin/physics/switch_zone.hpp"

#include <algorithm>

namespace opentmcl::twin {

AngleRange SwitchZone::range(std::int64_t period) const {
  const std::int64_t shift = period * places_.period;
  return {scale_.first_angle_at(places_.from + shift), scale_.last_angle_at(places_.to + shift)};
}

/// Number of the last range that begins at `angle` or below. Without periods there is only number 0.
std::int64_t SwitchZone::last_period_from(std::int64_t angle) const {
  return places_.period == 0 ? 0 : scale_.periods_between(places_.from, angle, places_.period);
}

/// The range that a held switch at `angle` is held by: the one whose hysteresis reaches there.
AngleRange SwitchZone::range_around(std::int64_t angle) const {
  return range(last_period_from(angle + hysteresis_));
}

bool SwitchZone::presses_at(std::int64_t angle) const {
  return range(last_period_from(angle)).contains(angle);
}

bool SwitchZone::holds_after(bool held, std::int64_t before, std::int64_t after) const {
  const AngleRange zone = range_around(after);
  if (zone.lowest > zone.highest) return false;  // narrower than a microstep: never met
  if (zone.contains(after)) return true;
  // Within the hysteresis: held if it comes out of the zone, or was held there before.
  if (after > zone.highest && after <= zone.highest + hysteresis_) {
    return before <= zone.highest || (held && before <= zone.highest + hysteresis_);
  }
  if (after < zone.lowest && after >= zone.lowest - hysteresis_) {
    return before >= zone.lowest || (held && before >= zone.lowest - hysteresis_);
  }
  return false;
}

EventDistance SwitchZone::next_change(bool held, std::int64_t angle) const {
  if (held) {
    const AngleRange zone = range_around(angle);
    return {angle - (zone.lowest - hysteresis_) + 1, zone.highest + hysteresis_ + 1 - angle};
  }
  EventDistance distance;
  // Not held, it stands between two ranges: the last that begins below, and the next.
  const std::int64_t period = last_period_from(angle);
  for (const std::int64_t number : {period, period + 1}) {
    if (places_.period == 0 && number != 0) continue;
    const AngleRange zone = range(number);
    if (zone.lowest > zone.highest) continue;
    if (zone.lowest > angle) distance.up = std::min(distance.up, zone.lowest - angle);
    if (zone.highest < angle) distance.down = std::min(distance.down, angle - zone.highest);
  }
  return distance;
}

}  // namespace opentmcl::twin
