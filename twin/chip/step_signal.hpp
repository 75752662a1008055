// The STEP and DIR lines between a motion controller and a driver.
#pragma once

#include <cstdint>

namespace opentmcl::twin {

enum class StepSignal : std::uint8_t {
  rising,   ///< one edge, up
  falling,  ///< one edge, down
  pulse,    ///< both edges, one short after the other
};

/// Steps of one motor in one direction, one after the other.
struct StepRun {
  unsigned motor;             ///< 0…2
  std::uint64_t count;        ///< at least 1
  std::uint64_t first_clock;  ///< of the first edge of the first step, in clocks since power-on
  std::uint64_t last_clock;   ///< the same of the last step; first_clock where there is only one
  StepSignal signal;          ///< of the first step; single edges alternate
  bool direction;             ///< level of the DIR line, stable at all edges

  friend bool operator==(const StepRun&, const StepRun&) = default;
};

/// How steps are told to a listener.
enum class StepDetail : std::uint8_t {
  runs,   ///< as few runs as possible
  edges,  ///< every step by itself, as soon as it is given out
};

/// Hears the steps as they are given out.
class StepListener {
 public:
  virtual void steps(const StepRun& run) = 0;

 protected:
  ~StepListener() = default;
};

}  // namespace opentmcl::twin
