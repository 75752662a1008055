// The STEP and DIR lines between a motion controller and a driver.
#pragma once

#include <cstdint>

namespace opentmcl::twin {

enum class StepSignal : std::uint8_t {
  rising,   ///< one edge, up
  falling,  ///< one edge, down
  pulse,    ///< both edges, one short after the other
};

/// One event on a STEP line.
struct StepEvent {
  unsigned motor;       ///< 0…2
  std::uint64_t clock;  ///< of the first edge, in clocks since power-on
  StepSignal signal;
  bool direction;  ///< level of the DIR line, stable at the edge

  friend bool operator==(const StepEvent&, const StepEvent&) = default;
};

/// Hears the steps as they are given out.
class StepListener {
 public:
  virtual void step(const StepEvent& event) = 0;

 protected:
  ~StepListener() = default;
};

}  // namespace opentmcl::twin
