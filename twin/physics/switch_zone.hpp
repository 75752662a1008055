// Where on its way a machine holds a switch.
#pragma once

#include <cstdint>

#include "twin/physics/place_scale.hpp"
#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {

/// In units of place. A switch is pressed at `from` and `to`, and let go `hysteresis` outside of them: once pressed, it
/// needs more way back.
struct SwitchPlaces {
  std::int64_t from = 0;
  std::int64_t to = 0;
  std::int64_t hysteresis = 0;
  std::int64_t period = 0;  ///< there again after each such distance; 0: only once. More than the width with hysteresis
};

/// The same in angles of the driven side: the first and last microstep in which the switch is held.
class SwitchZone {
 public:
  SwitchZone(const SwitchPlaces& places, const PlaceScale& scale)
      : places_(places), scale_(scale), hysteresis_(scale.angle_of(places.hysteresis)) {}

  /// Whether the switch is held at `angle`, when nothing is known of how the machine came there.
  bool presses_at(std::int64_t angle) const;

  /// Whether it is held after a way from `before` to `after` without turning back. A zone that lies wholly between
  /// leaves no trace.
  bool holds_after(bool held, std::int64_t before, std::int64_t after) const;

  /// How far from `angle` the switch changes.
  EventDistance next_change(bool held, std::int64_t angle) const;

 private:
  AngleRange range(std::int64_t period) const;
  std::int64_t last_period_from(std::int64_t angle) const;
  AngleRange range_around(std::int64_t angle) const;

  SwitchPlaces places_;
  PlaceScale scale_;
  std::int64_t hysteresis_;
};

}  // namespace opentmcl::twin
