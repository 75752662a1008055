#include "twin/chip/tmc262_cool_step.hpp"

#include <algorithm>

#include "twin/chip/tmc262_choices.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::CoolStepControl;

constexpr std::int32_t threshold_unit = 32;
constexpr std::int64_t step_up[] = {1, 2, 4, 8};                 // SEUP
constexpr std::uint64_t values_per_step_down[] = {32, 8, 2, 1};  // SEDN

}  // namespace

void Tmc262CoolStep::apply(const Tmc262RegisterFile& registers) {
  const std::int32_t highest = registers.current_scale();
  if (CoolStepControl::HysteresisStart::in(registers.cool_step_control) == 0) {
    *this = {};
    scale_ = highest;
    return;
  }
  scale_ = std::clamp(scale_, tmc262_choices::lowest_scale(highest, registers.cool_step_control), highest);
}

void Tmc262CoolStep::regulate(std::int32_t value, std::uint64_t count, const Tmc262RegisterFile& registers) {
  const auto control = registers.cool_step_control;
  const std::int32_t start = CoolStepControl::HysteresisStart::in(control);
  if (start == 0 || count == 0) return;
  const std::int32_t upper_threshold = threshold_unit * (start + CoolStepControl::HysteresisWidth::in(control) + 1);
  // More than all 31 steps lead nowhere.
  constexpr std::uint64_t enough = tmc262::maximum_current_scale;
  if (value >= upper_threshold) {
    const std::uint64_t per_step = values_per_step_down[CoolStepControl::CurrentDownStep::in(control)];
    const std::uint64_t values = values_above_ + count;
    const auto steps = static_cast<std::int32_t>(std::min(values / per_step, enough));
    values_above_ = values % per_step;
    scale_ = std::max(scale_ - steps, tmc262_choices::lowest_scale(registers.current_scale(), control));
    return;
  }
  values_above_ = 0;
  if (value < threshold_unit * start) {
    const auto up =
        static_cast<std::int64_t>(std::min(count, enough)) * step_up[CoolStepControl::CurrentUpStep::in(control)];
    scale_ = static_cast<std::int32_t>(std::min<std::int64_t>(scale_ + up, registers.current_scale()));
  }
}

}  // namespace opentmcl::twin
