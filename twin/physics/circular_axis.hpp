// A table that turns without end behind a gear, with a home mark.
#pragma once

#include <cstdint>

#include "twin/physics/contact.hpp"

namespace opentmcl::twin {

/// Angles of the table are in 1/1000 degree. The mark opens and closes the contact of the home switch; the inputs for
/// both limit switches are wired to ground.
struct CircularAxisDimensions {
  std::int32_t gear_numerator = 10;   ///< the motor makes numerator turns …
  std::int32_t gear_denominator = 1;  ///< … while the table makes this many, positive
  std::int32_t start = 0;             ///< 1/1000 degree, where the table stands at shaft angle 0
  bool mirrored = false;              ///< the gear turns the direction round

  std::int32_t home_mark_center = 90'000;      ///< 1/1000 degree
  std::int32_t home_mark_width = 5'000;        ///< 1/1000 degree, even
  Contact contact = Contact::normally_closed;  ///< of the switch that the mark holds
  std::int32_t switch_hysteresis = 0;          ///< 1/1000 degree further out at which the mark lets go
  std::int32_t switch_bounce = 0;              ///< µs for which the contact chatters after each change

  /// 1/1000 degree that the table does not move when the shaft turns back. At the start the teeth touch as after a turn
  /// to falling angles.
  std::int32_t backlash = 0;

  double table_inertia = 1e-3;  ///< kg m², of the table itself: 5 kg, 40 mm across
  double gear_inertia = 5e-6;   ///< kg m² at the motor's shaft
  double friction = 0.05;       ///< N m at the table, the same at every speed
};

}  // namespace opentmcl::twin
