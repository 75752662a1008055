// Everything around the microcontroller of one module: chips, wiring, pins, supply and the shaft, in one common time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "twin/chip/eeprom.hpp"
#include "twin/chip/step_signal.hpp"
#include "twin/chip/tmc262.hpp"
#include "twin/chip/tmc429.hpp"
#include "twin/physics/ideal_rotor.hpp"
#include "twin/physics/machine.hpp"
#include "twin/physics/shaft_encoder.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl::twin {

/// STEP and DIR of motor 1 go to the TMC262; both chips run on the same clock of one tick. Time moves only by
/// advance_to(), and the same calls at the same ticks give the same trace.
class World : private StepListener {
 public:
  static constexpr unsigned analog_channel_count = 4;

  /// What is mounted on the shaft.
  struct Mounted {
    MachineDimensions machine = RotaryAxisDimensions{};
    ShaftEncoder encoder{ShaftEncoder::Kind::incremental};
  };

  /// `observer`, if any, must outlive this and must not call back into it.
  explicit World(TraceObserver* observer = nullptr) : World(observer, Mounted{}) {}
  World(TraceObserver* observer, const Mounted& mounted);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Ticks since power-on.
  Tick now() const { return now_; }
  /// Lets time pass until `tick`; a tick that is not in the future changes nothing.
  void advance_to(Tick tick);

  /// Takes the supply away and gives it back: the chips lose their registers; EEPROM, shaft and bench stay as they are.
  void power_cycle();

  // ---- What the microcontroller reaches over its buses

  /// A datagram of 32 bits and its answer.
  std::uint32_t transfer_tmc429(std::uint32_t datagram);
  /// A word of 20 bits and its reply.
  std::uint32_t transfer_tmc262(std::uint32_t word);

  bool eeprom_busy() const { return eeprom_.busy(now_); }
  void read_eeprom(std::uint16_t address, std::uint8_t* data, std::size_t length) const;
  void write_eeprom_page(std::uint16_t address, const std::uint8_t* data, std::size_t length);

  // ---- Its pins; the board says what each bit means

  std::uint32_t outputs() const { return outputs_; }
  void set_outputs(std::uint32_t levels);
  std::uint32_t inputs() const { return inputs_; }
  void set_inputs(std::uint32_t levels);
  /// ENN of the TMC262: high takes the current off the motor.
  void set_driver_disable(bool level);
  /// SG_TST of the TMC262.
  bool stall_guard_output() const { return tmc262_.stall_guard_output(); }
  /// Pull-up resistors of the inputs for both limit switches and the home switch; on at power-on. Without them such an
  /// input is low whatever its switch does.
  void set_pull_ups(bool on);
  bool pull_ups() const { return pull_ups_; }
  /// Level at the input for the home switch.
  bool home_switch() const { return levels_.home; }
  /// Levels at the inputs for the limit switches, which are wired to the TMC429.
  bool left_switch() const { return levels_.left; }
  bool right_switch() const { return levels_.right; }
  /// Read it for its counts; followed by the world.
  ShaftEncoder& encoder() { return encoder_; }
  const ShaftEncoder& encoder() const { return encoder_; }

  // ---- What a person at the bench can change

  /// A finger on a switch, or a wire cut: true opens its contact, so that the input goes high; false leaves it to the
  /// machine.
  void set_left_switch(bool open);
  void set_right_switch(bool open);
  void set_home_switch(bool open);
  /// Converter value, `channel` 0…3; the board says what each channel is. 0 at the start.
  std::int32_t analog_input(unsigned channel) const { return analog_inputs_.at(channel); }
  void set_analog_input(unsigned channel, std::int32_t value);
  /// What stallGuard2 measures of the load: 0 (a stall) to 1023 (no load, at the start).
  void set_load_measurement(std::int32_t value);
  std::int32_t load_measurement() const { return load_measurement_; }
  /// A pulse on the STEP input of the step/direction connector, which goes to the driver like those of the TMC429.
  void pulse_step_input(bool direction);
  /// Motor supply in mV, 24 V at the start. The chips' logic has a supply of its own; below 7 V the TMC262 loses its
  /// registers.
  std::int32_t supply_voltage() const { return supply_voltage_; }
  void set_supply_voltage(std::int32_t millivolts);
  /// Temperature of the board and of the driver in °C, 25 at the start.
  std::int32_t temperature() const { return temperature_; }
  void set_temperature(std::int32_t celsius);

  /// Rises with every change of an input or the supply from outside: the firmware has to look at them.
  std::uint64_t input_changes() const { return input_changes_; }

  // ---- What can be measured there

  /// Angle of the shaft since power-on in microsteps of 1/256 full step.
  std::int64_t rotor_angle() const { return rotor_.angle(); }
  const Machine& machine() const { return machine_; }
  const Tmc429& tmc429() const { return *tmc429_; }
  const Tmc262& tmc262() const { return tmc262_; }
  const Eeprom& eeprom() const { return eeprom_; }
  /// To load an image, or to cut the power within a write.
  Eeprom& eeprom() { return eeprom_; }

 private:
  void steps(const StepRun& run) override;
  void step_edge(bool rising, bool direction, std::uint64_t clock);
  void turn_rotor(Tick tick);
  void follow_shaft(Tick tick);
  void update_switches(Tick tick);
  void report(Tick tick, std::string_view signal, std::int64_t value);

  TraceObserver* observer_;
  Tick now_ = 0;
  Tick powered_at_ = 0;  ///< the chips count their clocks from here
  std::optional<Tmc429> tmc429_;
  Tmc262 tmc262_;
  Eeprom eeprom_;
  Machine machine_;
  IdealRotor rotor_;
  ShaftEncoder encoder_;
  /// One value for each switch input.
  struct SwitchInputs {
    bool left = false;
    bool right = false;
    bool home = false;
  };
  SwitchInputs levels_;  ///< true is high
  bool pull_ups_ = true;
  std::int64_t traced_place_ = 0;
  std::int64_t traced_count_ = 0;
  bool direction_ = false;
  std::uint32_t outputs_ = 0;
  std::uint32_t inputs_ = 0;
  std::array<std::int32_t, analog_channel_count> analog_inputs_{};
  std::int32_t supply_voltage_ = 24'000;
  std::int32_t load_measurement_ = tmc262::maximum_stall_guard_value;
  std::uint64_t input_changes_ = 0;
  std::int32_t temperature_ = 25;
};

}  // namespace opentmcl::twin
