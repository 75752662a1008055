// stallGuard2 of the TMC262: how much of the motor's torque is left (datasheet chapter 5).
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/chip/tmc262_registers.hpp"

namespace opentmcl::twin {

class Tmc262StallGuard {
 public:
  /// What is measured from now on, as if SGT were 0: 0 at a stall, more with less load. Not limited to 0…1023.
  void set_measurement(std::int32_t measurement) { measurement_ = measurement; }
  std::int32_t measurement() const { return measurement_; }

  /// Values that follow each other: all but the first are the same.
  struct Values {
    std::uint64_t count;
    std::int32_t first;
    std::int32_t others;
  };

  /// `count` full steps with current have ended: one value for each, or with SFILT for every four.
  Values full_steps(std::uint64_t count, tmc262::Word<tmc262::StallGuardAndCurrent> settings);
  /// Forgets the full steps since the last value.
  void begin_again();
  void reset();

  /// SG: the latest value, 0…1023; 0 before the first.
  std::int32_t value() const { return value_.value_or(0); }
  /// SG_TST: the latest value is 0.
  bool output() const { return value_ == 0; }

  friend bool operator==(const Tmc262StallGuard&, const Tmc262StallGuard&) = default;

 private:
  std::int32_t measurement_ = tmc262::maximum_stall_guard_value;  ///< what an unloaded motor shows
  std::int64_t measured_sum_ = 0;                                 ///< over the full steps since the last value
  std::uint64_t measured_full_steps_ = 0;
  std::optional<std::int32_t> value_;  ///< empty until the first measurement; then replies carry it
};

}  // namespace opentmcl::twin
