// One axis of the TMC429: its sixteen registers, its two stop switches and its interrupts around a ramp generator.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/tmc429_choices.hpp"
#include "twin/chip/tmc429_ramp.hpp"
#include "twin/chip/tmc429_reach.hpp"

namespace opentmcl::twin {

class Tmc429Axis {
 public:
  /// The 24 bits that a read of the register gives.
  std::uint32_t read(tmc429::AxisRegister index) const;
  /// Bits outside writable_bits() are lost.
  void write(tmc429::AxisRegister index, std::uint32_t data);
  static std::uint32_t writable_bits(tmc429::AxisRegister index);

  /// The state of the switches, true = active.
  void set_switches(bool left, bool right);
  bool left_switch() const { return left_switch_; }
  bool right_switch() const { return right_switch_; }

  /// See Tmc429Ramp::advance(). Ends also with each step that may raise an interrupt, stop or release the motion.
  Tmc429Ramp::Steps advance(std::uint64_t end, Tmc429Reach reach, Tmc429Ramp::Until until,
                            std::vector<std::uint64_t>* step_ticks);
  /// See Tmc429Ramp::coast_to(). Nothing also where a step may raise an interrupt, stop or release the motion.
  std::optional<Tmc429Ramp::Steps> coast_to(std::uint64_t end) {
    const bool steps_have_consequences = mask_ != 0 || reference_tolerance_ != 0;
    if (steps_have_consequences) return std::nullopt;
    const std::optional<Tmc429Ramp::Steps> steps = ramp_.coast_to(end);
    if (steps) conditions_ = conditions();
    return steps;
  }
  /// See Tmc429Ramp::rest().
  bool rest(std::uint64_t end) { return ramp_.rest(end); }
  const Tmc429Ramp& ramp() const { return ramp_; }

  std::int32_t position() const { return ramp_.position(); }
  bool at_target() const { return ramp_.at_target(); }
  /// Some interrupt flag is set.
  bool interrupt() const { return flags_ != 0; }

  friend bool operator==(const Tmc429Axis&, const Tmc429Axis&) = default;

 private:
  /// Conditions that raise an interrupt when they begin.
  struct Conditions {
    bool at_target = true;
    bool reference_wrong = false;
    bool reference_missed = true;

    friend bool operator==(const Conditions&, const Conditions&) = default;
  };

  Conditions conditions() const {
    return {
        .at_target = ramp_.at_target(),
        .reference_wrong =
            reference_switch() && !tmc429_choices::within_tolerance(ramp_.position(), reference_tolerance_),
        .reference_missed = ramp_.position() == 0 && !reference_switch(),
    };
  }
  void after_change();
  void raise(tmc429::Word<tmc429::Interrupts> flag);
  void write_interrupts(tmc429::Word<tmc429::Interrupts> word);
  bool reference_switch() const { return tmc429::Mode::ReferenceIsRight::is_set(mode_) ? right_switch_ : left_switch_; }
  Tmc429Reach reach_to_consequences() const;
  Tmc429Blocked stop_switches() const;
  Tmc429Blocked blocked_directions() const;

  Tmc429Ramp ramp_;
  bool left_switch_ = false;
  bool right_switch_ = false;
  tmc429::Word<tmc429::Mode> mode_;  ///< with lp
  std::uint32_t mask_ = 0;
  std::uint32_t flags_ = 0;
  std::int32_t reference_tolerance_ = 0;
  std::uint32_t latched_position_ = 0;
  Conditions conditions_;
  /// What Step/Dir drivers do not use is stored and read back.
  std::uint32_t current_scaling_ = 0;
  std::uint32_t microstep_resolution_ = 0;
  std::uint32_t microstep_counter_ = 0;
  /// The written codes; the ramp holds the dividers they stand for.
  std::int32_t pulse_divider_code_ = 0;
  std::int32_t ramp_divider_code_ = 0;
};

}  // namespace opentmcl::twin
