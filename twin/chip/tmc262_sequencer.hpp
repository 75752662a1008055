// The microstep sequencer of the TMC262: STEP edges in, position in the sine table out (datasheet chapter 8).
#pragma once

#include <cstdint>

#include "twin/chip/step_signal.hpp"
#include "twin/chip/tmc262_register_file.hpp"

namespace opentmcl::twin {

/// Steps that follow each other evenly, as a StepRun has them.
struct Tmc262StepRun {
  std::uint64_t count;  ///< at least 1
  StepSignal first;     ///< single edges alternate
  std::uint64_t first_clock;
  std::uint64_t last_clock;

  std::uint64_t clock_of(std::uint64_t index) const;
  StepSignal signal_of(std::uint64_t index) const;
  /// How many of them come before `clock`.
  std::uint64_t count_before(std::uint64_t clock) const;
};

class Tmc262Sequencer {
 public:
  /// In reset until `clock`.
  explicit Tmc262Sequencer(std::uint64_t clock = 0) : latest_edge_(clock) {}

  /// What a run of steps did.
  struct Movement {
    std::int64_t microsteps = 0;           ///< of 1/256 full step, not wrapped; up is positive
    std::uint64_t polarity_changes_a = 0;  ///< each is the end of a full step
    std::uint64_t polarity_changes_b = 0;
  };

  /// Takes steps that do not come before any earlier one. @param down level of DIR
  Movement take(const Tmc262StepRun& run, bool down, const Tmc262RegisterFile& registers);

  /// Whether microPlyer is on (INTPOL).
  static bool interpolates(const Tmc262RegisterFile& registers);
  /// Gives out at once what microPlyer has kept for later.
  void end_interpolation() { microstep_interval_ = 0; }

  /// MSTEP, 0…1023, when all microsteps of the steps so far are given out.
  std::uint32_t position() const { return position_; }
  /// MSTEP at `clock`, which is not before the latest step.
  std::uint32_t position(std::uint64_t clock) const;
  /// No step came for 2^20 clocks.
  bool standstill(std::uint64_t clock) const;

  friend bool operator==(const Tmc262Sequencer&, const Tmc262Sequencer&) = default;

 private:
  std::uint32_t position_ = 0;
  std::uint64_t latest_edge_;
  std::uint64_t microstep_interval_ = 0;  ///< in clocks; 0: microPlyer has nothing to give out
  bool plays_down_ = false;
};

}  // namespace opentmcl::twin
