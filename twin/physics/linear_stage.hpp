// A slider on a screw between two hard ends, with two limit switches and a home switch.
#pragma once

#include <cstdint>

#include "twin/physics/contact.hpp"

namespace opentmcl::twin {

/// Places are measured from the middle of the travel, to the right; "left" is the side of negative places. The default
/// is the machine of the virtual modules (docs/machine.md).
struct LinearStageDimensions {
  using Contact = twin::Contact;

  std::int32_t pitch = 2'000;     ///< µm a turn of the shaft, positive
  std::int32_t travel = 100'000;  ///< µm from one hard end to the other, even
  std::int32_t start = 0;         ///< µm, where the slider stands at shaft angle 0
  bool mirrored = false;          ///< the motor sits at the other end: positive angles move the slider to the left

  std::int32_t limit_switch_distance = 2'000;  ///< µm from a hard end to where the switch closest to it begins
  std::int32_t limit_switch_width = 1'000;     ///< µm for which the slider holds it, towards the end
  std::int32_t home_switch_center = -10'000;   ///< µm
  std::int32_t home_switch_width = 1'000;      ///< µm for which the slider holds it, even
  Contact contact = Contact::normally_closed;  ///< of all three
  std::int32_t switch_hysteresis = 0;          ///< µm further out at which a switch that is held lets go
  std::int32_t switch_bounce = 0;              ///< µs for which a contact chatters after each change

  /// µm that the slider does not move when the shaft turns back. At the start the screw touches the slider as after a
  /// move to the left.
  std::int32_t backlash = 0;

  double moved_mass = 1.0;       ///< kg, slider and what is on it
  double screw_inertia = 1e-6;   ///< kg m², screw and coupling: 10 mm of steel, 120 mm long
  double friction = 5.0;         ///< N, of the slider, the same at every speed
  double end_stiffness = 100e6;  ///< N/m, of an end and of the screw's bearing together
};

}  // namespace opentmcl::twin
