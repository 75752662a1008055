// The exact ratio between angles of the shaft and places of what it moves.
#pragma once

#include <cstdint>

#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {

/// Angles here are those of the driven side, counted in the direction of rising places. Nothing is rounded before the
/// end: the ratio is a fraction of whole numbers.
class PlaceScale {
 public:
  /// @param numerator,denominator units of place that one turn of the shaft moves, positive
  /// @param start place at angle 0
  PlaceScale(std::int64_t numerator, std::int64_t denominator, std::int64_t start);

  /// Rounded down.
  std::int64_t place_at(std::int64_t angle) const { return start_ + floor_quotient(angle * numerator_, denominator_); }

  /// The first angle whose exact place is not below `place`.
  std::int64_t first_angle_at(std::int64_t place) const {
    return ceiling_quotient((place - start_) * denominator_, numerator_);
  }
  /// The last angle whose exact place is not above `place`.
  std::int64_t last_angle_at(std::int64_t place) const {
    return floor_quotient((place - start_) * denominator_, numerator_);
  }
  /// Angle that moves by `distance`, rounded down.
  std::int64_t angle_of(std::int64_t distance) const { return floor_quotient(distance * denominator_, numerator_); }

  /// How many times `period` fits between `place` and the place at `angle`, rounded down; negative below it.
  std::int64_t periods_between(std::int64_t place, std::int64_t angle, std::int64_t period) const {
    return floor_quotient(angle * numerator_ - (place - start_) * denominator_, period * denominator_);
  }

 private:
  std::int64_t numerator_;  ///< units of place a microstep, as a fraction in lowest terms
  std::int64_t denominator_;
  std::int64_t start_;
};

}  // namespace opentmcl::twin
