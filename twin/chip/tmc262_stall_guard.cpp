#include "twin/chip/tmc262_stall_guard.hpp"

#include "twin/chip/tmc262_choices.hpp"

namespace opentmcl::twin {

using tmc262::StallGuardAndCurrent;

Tmc262StallGuard::Values Tmc262StallGuard::full_steps(std::uint64_t count,
                                                      tmc262::Word<StallGuardAndCurrent> settings) {
  const std::uint64_t per_value =
      StallGuardAndCurrent::Filter::is_set(settings) ? tmc262_choices::filtered_full_steps : 1;
  const std::uint64_t measured = measured_full_steps_ + count;
  const std::uint64_t value_count = measured / per_value;
  if (value_count == 0) {
    measured_full_steps_ = measured;
    measured_sum_ += static_cast<std::int64_t>(count) * measurement_;
    return {};
  }
  const std::int32_t threshold = StallGuardAndCurrent::Threshold::in(settings);
  const auto until_first = static_cast<std::int64_t>(per_value - measured_full_steps_);
  const std::int64_t first_mean = (measured_sum_ + until_first * measurement_) / static_cast<std::int64_t>(per_value);
  const Values values{value_count, tmc262_choices::stall_guard_value(first_mean, threshold),
                      tmc262_choices::stall_guard_value(measurement_, threshold)};
  measured_full_steps_ = measured % per_value;
  measured_sum_ = static_cast<std::int64_t>(measured_full_steps_) * measurement_;
  value_ = value_count == 1 ? values.first : values.others;
  return values;
}

void Tmc262StallGuard::begin_again() {
  measured_sum_ = 0;
  measured_full_steps_ = 0;
}

void Tmc262StallGuard::reset() {
  begin_again();
  value_.reset();
}

}  // namespace opentmcl::twin
