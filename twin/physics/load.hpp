// What acts on a motor's shaft from outside.
#pragma once

#include <limits>

namespace opentmcl::twin {

/// All at the shaft: whoever has gears or a screw in between converts.
struct Load {
  double inertia = 0;           ///< kg m², on top of the rotor's
  double torque = 0;            ///< N m, constant, against positive motion when positive
  double coulomb_friction = 0;  ///< N m
  double viscous_friction = 0;  ///< N m s
  double spring = 0;            ///< N m per rad of shaft, about spring_centre
  double spring_centre = 0;     ///< electrical turns

  /// Ends: beyond them a stiff spring with damping pushes back. Infinite: none.
  double lowest_angle = -std::numeric_limits<double>::infinity();  ///< electrical turns
  double highest_angle = std::numeric_limits<double>::infinity();  ///< electrical turns
  double end_stiffness = 300;  ///< N m per rad; a hard stop of steel gives a fraction of a degree

  bool jammed = false;  ///< the shaft is held where it is

  friend bool operator==(const Load&, const Load&) = default;
};

}  // namespace opentmcl::twin
