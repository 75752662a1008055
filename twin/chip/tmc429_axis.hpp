// One axis of the TMC429: its sixteen registers, its two stop switches and its interrupts around a ramp generator.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/tmc429_ramp.hpp"

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

  /// See Tmc429Ramp::advance_to_step().
  bool advance_to_step(std::uint64_t end);
  std::uint64_t now() const { return ramp_.now(); }

  /// The direction of the latest step or of the present motion.
  bool decreasing() const { return decreasing_; }
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

  Conditions conditions() const;
  void after_change();
  void raise(tmc429::Word<tmc429::Interrupts> flag);
  void write_interrupts(tmc429::Word<tmc429::Interrupts> word);
  bool reference_switch() const;
  Tmc429Ramp::Blocked blocked_directions() const;

  Tmc429Ramp ramp_;
  bool decreasing_ = false;
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
