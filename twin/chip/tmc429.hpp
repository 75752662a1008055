// The TMC429 motion controller at register level: SPI on one side, switches, STEP and DIR on the other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/step_signal.hpp"
#include "twin/chip/tmc429_axis.hpp"
#include "twin/chip/tmc429_step_output.hpp"

namespace opentmcl::twin {

/// Starts in the state after power-on. What the datasheet leaves open is decided in tmc429_choices.hpp.
///
/// Registers that only SPI drivers use are stored and read back. Writes to bits and addresses that this model gives no
/// meaning are counted by unmodelled_writes().
class Tmc429 {
 public:
  /// `listener` hears the steps of all motors in Step/Dir mode, those of one motor in the order of time, at the latest
  /// when the call that lets time pass returns. It must outlive this. When told of every edge, it may set switches from
  /// within a step, which then act from that step on; it may do nothing else.
  explicit Tmc429(StepListener& listener);

  /// Runs at the start. Both tell of the same steps.
  void set_detail(StepDetail detail);

  // ---- Bus door

  /// One datagram of 32 bits and its answer: the status byte, and for a read the 24 data bits of the register.
  std::uint32_t transfer(std::uint32_t datagram);

  // ---- World door

  /// Lets `clocks` periods of CLK pass. What happens does not depend on how a time is cut into calls.
  void advance(std::uint64_t clocks);
  /// The same, but where the velocity of `motor`, fraction included, is not changing at the start, only to the tick
  /// that begins to change it: a start, the begin of an acceleration or braking, a stop. A step that reaches the target
  /// counts. True when that came before all of the time had passed.
  bool advance_until_change(std::uint64_t clocks, unsigned motor = 0);
  /// As advance(), and appends the clock of every step that `motor` gives out to `step_clocks`.
  void advance_listing(std::uint64_t clocks, std::vector<std::uint64_t>& step_clocks, unsigned motor = 0);
  /// Periods of CLK since power-on.
  std::uint64_t clock() const { return clock_; }

  /// Levels of the pins REFn and REFRn, `motor` 0…2. Which level means "active" is up to IF_CONFIGURATION.
  void set_left_switch(bool level, unsigned motor = 0);
  void set_right_switch(bool level, unsigned motor = 0);

  /// Level of the nINT pin: low when an interrupt is pending.
  bool interrupt_pin() const { return !interrupt(); }
  /// POSCMP: the selected motor stands at POS_COMP.
  bool position_compare_output() const;
  bool step_pin(unsigned motor = 0) const;
  bool direction_pin(unsigned motor = 0) const;

  // ---- For those who watch

  /// The 24 data bits that a read datagram would be answered with; changes nothing.
  std::uint32_t read(std::uint32_t datagram) const;

  /// As last written.
  tmc429::Word<tmc429::InterfaceConfiguration> interface_configuration() const {
    return output_settings_.interface_configuration;
  }

  /// Where a motor is within and between its steps. The next step comes when 2048 is reached in the accumulator, to
  /// which every 32 * 2^pulse_divider clocks the integer part of |velocity| is added.
  struct Motion {
    std::int32_t position;                ///< X_ACTUAL
    std::uint32_t accumulator;            ///< 0…2047
    std::int32_t velocity_with_fraction;  ///< 1/256 of the unit of V_ACTUAL
    unsigned pulse_divider;               ///< 0…13

    friend bool operator==(const Motion&, const Motion&) = default;
  };
  Motion motion(unsigned motor = 0) const {
    const Tmc429RampState& state = axes_[motor].ramp().state();
    return {.position = state.position,
            .accumulator = state.accumulator,
            .velocity_with_fraction = state.velocity,
            .pulse_divider = state.settings.pulse_divider};
  }
  /// X_ACTUAL is X_TARGET.
  bool at_target(unsigned motor = 0) const { return axes_[motor].at_target(); }
  /// The velocity has changed lately, so that advance_until_change() does not wait for its change.
  bool changes_velocity(unsigned motor = 0) const { return axes_[motor].ramp().changing(); }
  /// By no more than this the ramp changes the velocity in so many clocks, in 1/256 of the unit of V_ACTUAL.
  std::int32_t greatest_change(std::uint64_t clocks, unsigned motor = 0) const;
  /// Clocks in which `motor` gives fewer than `steps` steps for sure, whatever its ramp does, if nothing is written and
  /// no switch changes; the largest number when it gives none at all. @param steps 1 or more
  std::uint64_t clocks_for_steps(std::uint64_t steps, unsigned motor = 0) const;

  std::uint64_t unmodelled_writes() const { return unmodelled_writes_; }
  std::uint32_t latest_unmodelled_write() const { return latest_unmodelled_write_; }

 private:
  std::uint32_t status_byte() const;
  std::uint32_t read_common(unsigned index) const;
  void write(std::uint32_t datagram);
  /// Returns the bits to which it gave a meaning.
  std::uint32_t write_common(unsigned index, std::uint32_t data);
  void update_switches();
  void after_position_change();
  void advance_all(std::uint64_t clocks, unsigned motor, Tmc429Ramp::Until until,
                   std::vector<std::uint64_t>* step_clocks);
  std::uint64_t advance_motor(unsigned motor, std::uint64_t end, Tmc429Ramp::Until until,
                              std::vector<std::uint64_t>* step_clocks);
  void give_out(unsigned motor, const Tmc429Ramp::Steps& steps, std::vector<std::uint64_t>* step_clocks);
  /// Lets time pass until `end_tick` for a motor to which nothing happens before. False where something may.
  bool rests(unsigned motor, std::uint64_t end_tick) {
    return !outputs_[motor].delayed_edge() && axes_[motor].rest(end_tick);
  }
  bool coasts(unsigned motor, std::uint64_t end_tick);
  bool watches_position(unsigned motor) const;
  Tmc429Reach reach_to_consequences(unsigned motor) const;
  std::uint64_t tick_at(std::uint64_t clock) const;
  std::uint64_t clock_of(std::uint64_t tick) const;
  bool interrupt() const;
  std::uint32_t& common(tmc429::CommonRegister index) { return common_[static_cast<unsigned>(index)]; }
  std::uint32_t common(tmc429::CommonRegister index) const { return common_[static_cast<unsigned>(index)]; }

  std::uint64_t clock_ = 0;
  StepDetail detail_ = StepDetail::runs;
  std::uint64_t stopped_clocks_ = 0;  ///< those that passed in power-down
  bool powered_down_ = false;
  std::array<Tmc429Axis, tmc429::motor_count> axes_;
  std::array<Tmc429StepOutput, tmc429::motor_count> outputs_;
  Tmc429StepOutput::Settings output_settings_;
  std::array<bool, tmc429::motor_count> left_pins_{};
  std::array<bool, tmc429::motor_count> right_pins_{};
  std::array<std::uint32_t, 16> common_{};  ///< the common registers that are stored as written
  std::array<std::uint32_t, 64> ram_{};     ///< driver chain configuration and microstep table
  bool compare_matched_ = true;
  std::uint64_t unmodelled_writes_ = 0;
  std::uint32_t latest_unmodelled_write_ = 0;
};

}  // namespace opentmcl::twin
