// The ramp and pulse generator of one TMC429 axis, tick after tick as its laws read: what Tmc429Ramp must agree with.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "twin/chip/tmc429_ramp_state.hpp"

namespace opentmcl::twin {

struct Tmc429RampReference {
  struct Step {
    std::uint64_t tick;
    bool decreasing;

    friend bool operator==(const Step&, const Step&) = default;
  };

  Tmc429RampState state;

  /// Lets time pass until `end`. Appends each step to `steps`.
  void advance(std::uint64_t end, std::vector<Step>& steps) {
    // Nothing happens between the ticks of the faster divider.
    const std::uint64_t ramp_mask = (std::uint64_t{1} << state.settings.ramp_divider) - 1;
    const std::uint64_t pulse_mask = (std::uint64_t{1} << state.settings.pulse_divider) - 1;
    const std::uint64_t stride = std::min(ramp_mask, pulse_mask) + 1;
    for (std::uint64_t tick = (state.now / stride + 1) * stride; tick <= end; tick += stride) {
      if ((tick & ramp_mask) == 0) {
        state.ramp_tick();
      }
      const bool decreasing = state.velocity < 0;
      if ((tick & pulse_mask) == 0 && state.pulse_tick()) {
        steps.push_back({tick, decreasing});
      }
    }
    state.now = end;
  }
};

}  // namespace opentmcl::twin
