#pragma once

#include "firmware/hal/time.hpp"

namespace opentmcl {

/// Something with a time of its own that others move on: one module, or several with the wires between them. The same
/// bytes at the same times have the same effects, however the time in between is cut.
class Simulated {
 public:
  /// Simulated time since it was made.
  virtual Microseconds now() const = 0;

  /// Lets time pass up to and including `time`; a time in the past changes nothing.
  virtual void advance_to(Microseconds time) = 0;

  /// Something happened outside, such as bytes on a port: it is looked at, at now(), in the next advance_to().
  virtual void wake() = 0;

  /// When something will happen if nothing happens outside; `never` while it only waits. A time in the past means now.
  virtual Microseconds next_turn() const = 0;

 protected:
  ~Simulated() = default;
};

}  // namespace opentmcl
