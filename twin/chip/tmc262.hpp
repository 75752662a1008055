// The TMC262 stepper driver at register level: SPI, STEP, DIR and ENN in, coil currents out. Non-C silicon.
#pragma once

#include <cstdint>
#include <optional>

#include "twin/chip/step_signal.hpp"
#include "twin/chip/tmc262_bridge.hpp"
#include "twin/chip/tmc262_cool_step.hpp"
#include "twin/chip/tmc262_register_file.hpp"
#include "twin/chip/tmc262_sequencer.hpp"
#include "twin/chip/tmc262_stall_guard.hpp"

namespace opentmcl::twin {

/// Starts in the state after power-on: all registers 0, so Step/Dir mode, 256 microsteps, bridges off. What the
/// datasheet leaves open is decided in tmc262_choices.hpp.
///
/// The chip does not know its motor: what stallGuard2 would measure, broken wires and shorts are told to it.
///
/// Clocks count from power-on. What has no clock of its own happens, or is looked at, at clock(). Looking changes
/// nothing, and neither does how time is cut: advance(1), advance(2) leaves the same chip as advance(2).
class Tmc262 {
 public:
  /// The board around the chip.
  struct Board {
    /// In mΩ. This one makes 2.8 A RMS of the full scale with VSENSE = 1, as both modules have it
    /// (docs/decisions/0036-coil-current.md).
    std::int32_t sense_resistor = 42;

    friend bool operator==(const Board&, const Board&) = default;
  };

  enum class Coil : std::uint8_t { a, b };

  /// Currents of the coils in units of the microstep table before the current scale: -248…248, up to 255 with an
  /// offset or by SPI; 0 in a coil whose bridge is off or whose wire is broken.
  struct CoilPair {
    std::int32_t a;
    std::int32_t b;

    friend bool operator==(const CoilPair&, const CoilPair&) = default;
  };

  Tmc262() = default;
  explicit Tmc262(const Board& board) : board_(board) {}

  // ---- Bus door

  /// One word of 20 bits (upper ones are ignored) at `clock`; returns the 20 bits of the reply in the format that RDSEL
  /// asked for before this word.
  std::uint32_t transfer(std::uint32_t word, std::uint64_t clock);

  // ---- World door

  /// Time has come to `clock`; a past one changes nothing.
  void advance(std::uint64_t clock) {
    if (clock > clock_) clock_ = clock;
  }
  std::uint64_t clock() const { return clock_; }

  /// Power-on: the clock is 0, registers and ENN too. Board, motor, wires, supply and temperature stay.
  void power_up();

  /// Steps in one direction, as a StepRun has them: `count` of them from `first_clock` to `last_clock`, taken as evenly
  /// spaced. Give each step on its own while interpolates(), for microPlyer measures their spacing; and let no run
  /// lead over next_shut_off() if it must be exact which of its steps still find the bridge on.
  /// @param direction level of DIR: low counts up
  /// @return how far the sequencer moved, in 1/256 of a full step and without its wrap; 0 when it takes no steps
  std::int64_t steps(std::uint64_t count, StepSignal first, bool direction, std::uint64_t first_clock,
                     std::uint64_t last_clock);
  /// How far a pulse on STEP moves the sequencer now, in 1/256 of a full step: 0…512.
  std::int32_t microsteps_per_pulse() const;
  /// microPlyer fills the time after each step with microsteps.
  bool interpolates() const { return Tmc262Sequencer::interpolates(registers_); }

  /// ENN: high switches all bridges off.
  void set_enable_not(bool level);
  /// Chip temperature in °C: warning from 100, bridges off from 150, no hysteresis.
  void set_temperature(std::int32_t celsius);
  /// Motor supply in mV. Below 7.0 V the chip is in reset: registers and sequencer are 0, words change nothing and are
  /// answered by 0. (Typical value of the C silicon; none is known for the other.)
  void set_supply_voltage(std::int32_t millivolts);
  /// What stallGuard2 would measure from now on with SGT = 0: 0 at a stall, more with less load. It may lie outside of
  /// 0…1023, the range of the value after SGT is added. 1023 at the start.
  void set_load_measurement(std::int32_t value) { stall_guard_.set_measurement(value); }
  /// False: a wire to the coil is broken.
  void set_coil_connected(Coil coil, bool connected);
  /// True: one end of the coil touches ground.
  void set_short_to_ground(Coil coil, bool shorted);

  /// Both coils can be driven.
  bool bridges_on() const { return bridge_a_.on(clock_) && bridge_b_.on(clock_); }
  bool bridge_on(Coil coil) const { return bridge(coil).on(clock_); }
  bool coil_connected(Coil coil) const { return bridge(coil).connected(); }
  bool shorted_to_ground(Coil coil) const { return bridge(coil).shorted(); }
  /// When a bridge will be shut off by a short if nothing changes, later than clock().
  std::optional<std::uint64_t> next_shut_off() const { return shut_off_after(clock_); }

  /// What the next word will be answered.
  tmc262::Word<tmc262::Reply> reply() const;

  CoilPair coil_currents() const;
  /// Coil current in mA at the peak of the sine: scale in force, sense voltage and resistor. Also what it would be with
  /// the bridges off.
  std::int32_t current_amplitude() const;
  /// SE: 0…31, the coils carry (n + 1) / 32 of the full-scale current.
  std::int32_t current_scale() const { return cool_step_.scale(); }
  /// Full-scale sense voltage in mV.
  std::int32_t sense_voltage() const;
  /// MSTEP, 0…1023, when all microsteps of the steps so far are given out.
  std::uint32_t microstep_position() const { return sequencer_.position(); }
  /// MSTEP at a clock that is not before the latest step: behind the other one while microPlyer is at work.
  std::uint32_t microstep_position(std::uint64_t clock) const { return sequencer_.position(clock); }
  /// SG: the latest value of stallGuard2, 0…1023; 0 before the first.
  std::int32_t stall_guard_value() const { return stall_guard_.value(); }
  /// SG_TST: high while the latest value is 0.
  bool stall_guard_output() const { return stall_guard_.output(); }
  std::int32_t load_measurement() const { return stall_guard_.measurement(); }

  // ---- Registers as last written

  tmc262::Word<tmc262::DriverControl> driver_control() const { return registers_.driver_control; }
  tmc262::Word<tmc262::CoilCurrents> spi_coil_currents() const { return registers_.coil_currents; }
  tmc262::Word<tmc262::ChopperConfiguration> chopper_configuration() const { return registers_.chopper_configuration; }
  tmc262::Word<tmc262::CoolStepControl> cool_step_control() const { return registers_.cool_step_control; }
  tmc262::Word<tmc262::StallGuardAndCurrent> stall_guard_and_current() const {
    return registers_.stall_guard_and_current;
  }
  tmc262::Word<tmc262::DriverConfiguration> driver_configuration() const { return registers_.driver_configuration; }

  /// Words that set reserved bits, the test mode, undefined codes or no register at all.
  std::uint64_t unmodelled_writes() const { return unmodelled_writes_; }
  std::uint32_t latest_unmodelled_write() const { return latest_unmodelled_write_; }

  friend bool operator==(const Tmc262&, const Tmc262&) = default;

 private:
  void write(std::uint32_t word);
  void apply_changes(const Tmc262RegisterFile& before);
  void update_bridges();
  std::int64_t take(const Tmc262StepRun& run, bool direction);
  void end_full_steps(std::uint64_t polarity_changes_a, std::uint64_t polarity_changes_b);
  std::optional<std::uint64_t> shut_off_after(std::uint64_t clock) const;
  void reset();
  Tmc262Bridge& bridge(Coil coil) { return coil == Coil::a ? bridge_a_ : bridge_b_; }
  const Tmc262Bridge& bridge(Coil coil) const { return coil == Coil::a ? bridge_a_ : bridge_b_; }

  Board board_;
  std::uint64_t clock_ = 0;
  Tmc262RegisterFile registers_;
  Tmc262Sequencer sequencer_;
  Tmc262StallGuard stall_guard_;
  Tmc262CoolStep cool_step_;
  Tmc262Bridge bridge_a_;
  Tmc262Bridge bridge_b_;
  bool enable_not_ = false;
  bool has_supply_ = true;
  std::int32_t temperature_ = 25;
  std::uint64_t unmodelled_writes_ = 0;
  std::uint32_t latest_unmodelled_write_ = 0;
};

}  // namespace opentmcl::twin
