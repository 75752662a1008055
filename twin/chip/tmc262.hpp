// The TMC262 stepper driver at register level: SPI, STEP, DIR and ENN in, coil currents out. Non-C silicon.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/chip/tmc262_registers.hpp"

namespace opentmcl::twin {

/// Starts in the state after power-on: all registers 0, so Step/Dir mode, 256 microsteps, bridges off.
///
/// The load is ideal: the rotor follows the field. What stallGuard2 measures of it is set from outside, its largest
/// value at the start; a measurement is made on every full step of the motor and none at standstill. SE is CS.
/// Not modelled: microPlyer's microsteps between two STEP edges, coolStep, the chopper's time course, open-load and
/// short-circuit detection. A write that asks for one of them that could be noticed, or that sets reserved bits, is
/// counted.
///
/// Choices the datasheet leaves open: MSTEP is 0 after reset; steps are ignored with SDOFF = 1; MRES 9…15 act as 8;
/// RDSEL = 3 replies as 0; a full step ends where bit 8 of MSTEP changes; the status is taken when the word begins.
class Tmc262 {
 public:
  /// Currents of the coils in units of the microstep table, -248…248, before the current scale; 0 with the bridges off.
  struct CoilPair {
    std::int32_t a;
    std::int32_t b;

    friend bool operator==(const CoilPair&, const CoilPair&) = default;
  };

  // ---- Bus door

  /// One word of 20 bits (upper ones are ignored) at `clock`, in clocks since power-on; returns the 20 bits of the
  /// reply in the format that RDSEL asked for before this word.
  std::uint32_t transfer(std::uint32_t word, std::uint64_t clock);

  // ---- World door

  /// One edge on STEP while DIR has the level `direction`: low counts up.
  void step_edge(bool rising, bool direction, std::uint64_t clock);
  /// ENN: high switches all bridges off.
  void set_enable_not(bool level) { enable_not_ = level; }
  /// Chip temperature in °C: warning from 100, bridges off from 150, no hysteresis.
  void set_temperature(std::int32_t celsius) { temperature_ = celsius; }
  /// Motor supply in mV. Below 7.0 V the chip is in reset: registers and sequencer are 0, words change nothing and are
  /// answered by 0. (Typical value of the C silicon; none is known for the other.)
  void set_supply_voltage(std::int32_t millivolts);
  /// What stallGuard2 will measure from now on: 0 (a stall) to 1023 (no load).
  void set_load_measurement(std::int32_t value) { load_measurement_ = value; }

  bool bridges_on() const;
  CoilPair coil_currents() const;
  /// SE: 0…31, the coils carry (n + 1) / 32 of the full-scale current.
  std::int32_t current_scale() const;
  /// Full-scale sense voltage in mV.
  std::int32_t sense_voltage() const;
  /// MSTEP, 0…1023.
  std::uint32_t microstep_position() const { return microstep_position_; }
  /// SG_TST: high while the last measurement was 0.
  bool stall_guard_output() const { return stall_guard_value_ == 0; }

  // ---- Registers as last written

  tmc262::Word<tmc262::DriverControl> driver_control() const { return driver_control_; }
  tmc262::Word<tmc262::CoilCurrents> spi_coil_currents() const { return spi_coil_currents_; }
  tmc262::Word<tmc262::ChopperConfiguration> chopper_configuration() const { return chopper_configuration_; }
  tmc262::Word<tmc262::CoolStepControl> cool_step_control() const { return cool_step_control_; }
  tmc262::Word<tmc262::StallGuardAndCurrent> stall_guard_and_current() const { return stall_guard_and_current_; }
  tmc262::Word<tmc262::DriverConfiguration> driver_configuration() const { return driver_configuration_; }

  std::uint64_t unmodelled_writes() const { return unmodelled_writes_; }
  std::uint32_t latest_unmodelled_write() const { return latest_unmodelled_write_; }

 private:
  tmc262::Word<tmc262::Reply> reply(std::uint64_t clock) const;
  void write(std::uint32_t word);
  bool step_dir_off() const;
  void count_full_step();
  void reset();

  tmc262::Word<tmc262::DriverControl> driver_control_;
  tmc262::Word<tmc262::CoilCurrents> spi_coil_currents_;
  tmc262::Word<tmc262::ChopperConfiguration> chopper_configuration_;
  tmc262::Word<tmc262::CoolStepControl> cool_step_control_;
  tmc262::Word<tmc262::StallGuardAndCurrent> stall_guard_and_current_;
  tmc262::Word<tmc262::DriverConfiguration> driver_configuration_;
  std::uint32_t microstep_position_ = 0;
  std::uint64_t latest_step_clock_ = 0;
  unsigned unmeasured_full_steps_ = 0;
  std::optional<std::int32_t> stall_guard_value_;  ///< empty until the first measurement; then replies carry it
  bool enable_not_ = false;
  std::int32_t temperature_ = 25;
  bool has_supply_ = true;
  std::int32_t load_measurement_ = tmc262::maximum_stall_guard_value;  ///< what an unloaded motor shows
  std::uint64_t unmodelled_writes_ = 0;
  std::uint32_t latest_unmodelled_write_ = 0;
};

}  // namespace opentmcl::twin
