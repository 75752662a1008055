// Everything around the microcontroller of one module: chips, wiring, pins, supply and the shaft, in one common time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "twin/chip/eeprom.hpp"
#include "twin/physics/machine.hpp"
#include "twin/physics/shaft_encoder.hpp"
#include "twin/world/drive_train.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl::twin {

/// STEP and DIR of motor 1 go to the TMC262; both chips run on the same clock of one tick. Time moves only by
/// advance_to(), and how it is cut changes nothing: the same changes at the same ticks give the same trace.
class World final : private ShaftSurroundings {
 public:
  static constexpr unsigned analog_channel_count = 4;

  /// What is mounted on the shaft.
  struct Mounted {
    MachineDimensions machine = RotaryAxisDimensions{};
    ShaftEncoder encoder{ShaftEncoder::Kind::incremental};
    /// Nothing: an ideal motor, whose rotor is always where the field is.
    std::optional<MotorData> motor = {};
    /// What pulls at the machine. N on a linear stage, N m elsewhere.
    double load = 0;
    /// May be shared by many worlds; own ones if empty.
    std::shared_ptr<TorqueTables> tables = {};
  };

  /// `observer`, if any, must outlive this and must not call back into it.
  explicit World(TraceObserver* observer = nullptr) : World(observer, Mounted{}) {}
  World(TraceObserver* observer, const Mounted& mounted);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// From now on `observer` hears every signal, or nobody if nullptr; it must outlive this and must not call back into
  /// it. Nothing else depends on whether somebody does.
  void observe(TraceObserver* observer);

  /// Ticks since power-on.
  Tick now() const { return drive_train_.now(); }
  /// Lets time pass until `tick`; a tick that is not in the future changes nothing.
  void advance_to(Tick tick);
  /// The same, but stops when motion_changes() has risen.
  void advance_to_motion_change(Tick tick);
  /// Rises whenever the ramp generator has arrived at its target or left it, and when a switch has changed its level.
  std::uint64_t motion_changes() const { return drive_train_.arrivals() + switch_changes_; }

  /// Takes the supply away and gives it back: the chips lose their registers; EEPROM, shaft and bench stay as they are.
  void power_cycle();

  // ---- What the microcontroller reaches over its buses

  /// A datagram of 32 bits and its answer.
  std::uint32_t transfer_tmc429(std::uint32_t datagram);
  /// A word of 20 bits and its reply.
  std::uint32_t transfer_tmc262(std::uint32_t word);

  bool eeprom_busy() const { return eeprom_.busy(now()); }
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
  bool stall_guard_output() const { return tmc262().stall_guard_output(); }
  /// Pull-up resistors of the inputs for both limit switches and the home switch; on at power-on. Without them such an
  /// input is low whatever its switch does.
  void set_pull_ups(bool on);
  bool pull_ups() const { return pull_ups_; }
  /// Level at the input for the home switch.
  bool home_switch() const { return levels_.home; }
  /// Levels at the inputs for the limit switches, which are wired to the TMC429.
  bool left_switch() const { return levels_.left; }
  bool right_switch() const { return levels_.right; }
  /// As the microcontroller reads it now.
  ShaftEncoder& encoder();
  /// As it was at the end of the last span.
  const ShaftEncoder& encoder() const { return encoder_; }
  /// What the microcontroller would read now.
  std::int64_t encoder_count() const { return encoder_.count_at(encoder_angle()); }
  bool encoder_near_null() const { return encoder_.near_null_at(encoder_angle()); }

  // ---- What a person at the bench can change

  /// The wire of a switch is cut: true makes its input high; false leaves it to the machine.
  void set_left_switch(bool open);
  void set_right_switch(bool open);
  void set_home_switch(bool open);
  /// A finger holds a switch, as the slider would, or leaves it again. A machine that lacks it has none to press.
  void press_switch(MachineSwitch name, bool held);
  /// The wire of a channel is cut, or mended. Incremental encoders only.
  void break_encoder_wire(EncoderChannel channel, bool broken);
  /// Converter value, `channel` 0…3; the board says what each channel is. 0 at the start.
  std::int32_t analog_input(unsigned channel) const { return analog_inputs_.at(channel); }
  void set_analog_input(unsigned channel, std::int32_t value);
  /// What stallGuard2 measures of an ideal motor's load: 0 (a stall) to 1023 (no load, at the start).
  void set_load_measurement(std::int32_t value);
  std::int32_t load_measurement() const { return tmc262().load_measurement(); }
  /// A pulse on the STEP input of the step/direction connector, which goes to the driver like those of the TMC429.
  void pulse_step_input(bool direction);
  /// A pulse generator there. @param rate as for StepInput::set_rate()
  void set_step_input_rate(double rate) { drive_train_.set_step_input_rate(rate); }
  double step_input_rate() const { return drive_train_.step_input_rate(); }
  /// Motor supply in mV, 24 V at the start. The chips' logic has a supply of its own; below 7 V the TMC262 loses its
  /// registers.
  std::int32_t supply_voltage() const { return supply_voltage_; }
  void set_supply_voltage(std::int32_t millivolts);
  /// Temperature of the board and of the driver in °C, 25 at the start.
  std::int32_t temperature() const { return temperature_; }
  void set_temperature(std::int32_t celsius);
  /// Temperature around the motor in °C, to which its winding cools; 25 at the start. An ideal motor has none.
  void set_ambient_temperature(double celsius) { drive_train_.set_ambient_temperature(celsius); }

  /// Rises with every change of an input or the supply from outside: the firmware has to look at them.
  std::uint64_t input_changes() const { return input_changes_; }

  /// All that acts on the shaft: what the machine is to it, and what was set on top of that.
  const Load& load() const { return drive_train_.load(); }
  void set_load(const Load& load) { drive_train_.set_load(load); }
  /// A wire to a coil breaks, or is mended.
  void set_coil_connected(Tmc262::Coil coil, bool connected) { drive_train_.set_coil_connected(coil, connected); }
  /// One end of a coil touches ground, or no longer.
  void set_short_to_ground(Tmc262::Coil coil, bool shorted) { drive_train_.set_short_to_ground(coil, shorted); }

  // ---- What can be measured there

  /// Angle of the shaft since power-on in microsteps of 1/256 full step, rounded down.
  std::int64_t rotor_angle() const { return drive_train_.shaft_angle(); }
  /// The motor and its currents; an ideal one has nothing to tell.
  const std::optional<MotorShaft>& motor() const { return drive_train_.motor(); }
  /// What the driver makes the motor's coils carry.
  Field field() const { return drive_train_.field(); }
  /// motor() is as it was at the end of the last span, field() begins there. These two are those of the present.
  std::optional<MotorShaft> present_motor() const { return drive_train_.present_motor(); }
  Field present_field() const { return drive_train_.present_field(); }
  /// Where the slider or table stands now.
  std::int64_t place() const { return machine_.place_at(rotor_angle()); }
  const Machine& machine() const { return machine_; }
  const Tmc429& tmc429() const { return drive_train_.tmc429(); }
  const Tmc262& tmc262() const { return drive_train_.tmc262(); }
  const Eeprom& eeprom() const { return eeprom_; }
  /// To load an image, or to cut the power within a write.
  Eeprom& eeprom() { return eeprom_; }

 private:
  void shaft_turned(Tick tick) override;
  void shaft_passes(Tick tick) override { report_shaft(tick); }
  std::int64_t distance_to_event() const override;
  Tick next_event(Tick tick) const override { return machine_.next_chatter(tick); }
  Tick shortest_event() const override { return machine_.shortest_chatter(); }
  void report(Tick tick, std::string_view signal, std::int64_t value) override {
    if (observer_ != nullptr) observer_->changed(tick, signal, value);
  }
  void update_switches(Tick tick);
  void report_shaft(Tick tick);
  void report_encoder(Tick tick);
  std::int64_t encoder_angle() const {
    return encoder_.properties().on_load_side ? machine_.load_side_angle_at(rotor_angle()) : rotor_angle();
  }

  TraceObserver* observer_;
  Machine machine_;
  DriveTrain drive_train_;
  Eeprom eeprom_;
  ShaftEncoder encoder_;
  /// One value for each switch input.
  struct SwitchInputs {
    bool left = false;
    bool right = false;
    bool home = false;

    friend bool operator==(const SwitchInputs&, const SwitchInputs&) = default;
  };
  SwitchInputs levels_;  ///< true is high
  bool pull_ups_ = true;
  std::int64_t traced_place_ = 0;
  std::int64_t traced_count_ = 0;
  std::uint32_t outputs_ = 0;
  std::uint32_t inputs_ = 0;
  std::array<std::int32_t, analog_channel_count> analog_inputs_{};
  std::int32_t supply_voltage_ = 24'000;
  std::uint64_t input_changes_ = 0;
  std::uint64_t switch_changes_ = 0;
  std::int32_t temperature_ = 25;
};

}  // namespace opentmcl::twin
