#include "twin/chip/tmc429_pulse_train.hpp"

#include <cstddef>

namespace opentmcl::twin {

void Tmc429PulseTrain::list_steps(std::vector<std::uint64_t>& ticks) const {
  const std::uint64_t count = steps();
  if (count == 0) {
    return;
  }
  // Two steps are `whole` pulse ticks apart, or one more where what is left in the accumulator after the first falls
  // short of `rest`.
  const std::uint32_t whole = step / increment;
  const std::uint32_t rest = step % increment;
  std::uint64_t tick = tick_of_first_step();
  std::uint32_t left =
      static_cast<std::uint32_t>(accumulator + ((tick >> divider) - (begin >> divider)) * increment) - step;
  const std::size_t listed = ticks.size();
  ticks.resize(listed + count);
  for (auto place = ticks.begin() + static_cast<std::ptrdiff_t>(listed); place != ticks.end(); ++place) {
    *place = tick;
    const bool one_more = left < rest;
    left += (one_more ? increment : 0) - rest;
    tick += std::uint64_t{whole + (one_more ? 1u : 0u)} << divider;
  }
}

}  // namespace opentmcl::twin
