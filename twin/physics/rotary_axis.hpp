// A shaft that turns freely and without end.
#pragma once

namespace opentmcl::twin {

/// There is no switch: all switch inputs are wired to ground, so that none reads as held.
struct RotaryAxisDimensions {
  double inertia = 0.0;   ///< kg m², of what is mounted on the shaft
  double friction = 0.0;  ///< N m, the same at every speed
};

}  // namespace opentmcl::twin
