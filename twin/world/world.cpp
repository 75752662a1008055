#include "twin/world/world.hpp"

#include <algorithm>

namespace opentmcl::twin {
namespace {

/// What a machine is to the motor, with something pulling at it.
Load load_of(const Machine& machine, double pull) {
  Load load;
  load.inertia = machine.inertia();
  load.coulomb_friction = machine.friction();
  load.torque = machine.torque_of(pull);
  if (machine.end_stiffness() > 0) {
    load.lowest_angle = electrical_turns_at(machine.travel().lowest);
    load.highest_angle = electrical_turns_at(machine.travel().highest);
    load.end_stiffness = machine.end_stiffness();
  }
  return load;
}

}  // namespace

World::World(TraceObserver* observer, const Mounted& mounted)
    : observer_(observer),
      machine_(mounted.machine),
      drive_train_(*this, {.motor = mounted.motor,
                           .load = load_of(machine_, mounted.load),
                           .tables = mounted.tables,
                           .ideal_rotor = {machine_.travel().lowest, machine_.travel().highest},
                           .reports_steps = observer != nullptr}),
      encoder_(mounted.encoder) {
  update_switches(now());
  drive_train_.start();
}

void World::observe(TraceObserver* observer) {
  observer_ = observer;
  traced_place_ = machine_.place();
  traced_count_ = encoder_.count();
  drive_train_.report_steps(observer != nullptr);
}

void World::power_cycle() {
  report(now(), "power", 0);
  drive_train_.power_cycle();
  eeprom_.lose_power(now());
  eeprom_.power_up();
  set_outputs(0);
  encoder_.power_up();
  pull_ups_ = true;
  update_switches(now());
  report(now(), "power", 1);
}

void World::advance_to(Tick tick) {
  while (now() < tick) drive_train_.run(tick);
}

void World::advance_to_motion_change(Tick tick) {
  const std::uint64_t before = motion_changes();
  while (now() < tick && motion_changes() == before) drive_train_.run(tick);
}

std::uint32_t World::transfer_tmc429(std::uint32_t datagram) {
  report(now(), "tmc429.datagram", datagram);
  return drive_train_.transfer_tmc429(datagram);
}

std::uint32_t World::transfer_tmc262(std::uint32_t word) {
  report(now(), "tmc262.word", word);
  return drive_train_.transfer_tmc262(word);
}

void World::read_eeprom(std::uint16_t address, std::uint8_t* data, std::size_t length) const {
  eeprom_.read(address, data, length, now());
}

void World::write_eeprom_page(std::uint16_t address, const std::uint8_t* data, std::size_t length) {
  report(now(), "eeprom.write", address);
  eeprom_.write_page(address, data, length, now());
}

void World::set_outputs(std::uint32_t levels) {
  if (levels != outputs_) {
    outputs_ = levels;
    report(now(), "outputs", levels);
  }
}

void World::set_inputs(std::uint32_t levels) {
  if (levels != inputs_) {
    inputs_ = levels;
    ++input_changes_;
    report(now(), "inputs", levels);
  }
}

void World::set_driver_disable(bool level) {
  report(now(), "driver_disable", level);
  drive_train_.set_driver_disable(level);
}

void World::set_pull_ups(bool on) {
  pull_ups_ = on;
  update_switches(now());
}

void World::set_left_switch(bool open) {
  machine_.break_wire(MachineSwitch::left, open);
  update_switches(now());
}

void World::set_right_switch(bool open) {
  machine_.break_wire(MachineSwitch::right, open);
  update_switches(now());
}

void World::set_home_switch(bool open) {
  machine_.break_wire(MachineSwitch::home, open);
  update_switches(now());
}

void World::press_switch(MachineSwitch name, bool held) {
  machine_.press(name, held, now());
  update_switches(now());
  drive_train_.expect_other_events();
}

void World::break_encoder_wire(EncoderChannel channel, bool broken) {
  encoder().break_wire(channel, broken);
  report_encoder(now());
}

void World::set_analog_input(unsigned channel, std::int32_t value) {
  analog_inputs_.at(channel) = value;
}

void World::set_supply_voltage(std::int32_t millivolts) {
  if (millivolts == supply_voltage_) {
    return;
  }
  supply_voltage_ = millivolts;
  ++input_changes_;
  report(now(), "supply_voltage", millivolts);
  drive_train_.set_supply_voltage(millivolts);
}

void World::set_load_measurement(std::int32_t value) {
  drive_train_.set_load_measurement(value);
}

void World::pulse_step_input(bool direction) {
  drive_train_.pulse_step(direction);
}

void World::set_temperature(std::int32_t celsius) {
  temperature_ = celsius;
  report(now(), "temperature", celsius);
  drive_train_.set_temperature(celsius);
}

/// What the shaft moves: the encoder, the slider and its switches.
void World::shaft_turned(Tick tick) {
  const std::int64_t angle = drive_train_.committed_shaft_angle();
  const bool chatters = machine_.next_chatter(tick - 1) == tick;
  if (machine_.follow(angle, tick) || chatters) update_switches(tick);
  encoder_.follow(encoder_.properties().on_load_side ? machine_.load_side_angle() : angle);
  if (observer_ != nullptr) report_shaft(tick);
}

/// What turns with it, as it is now.
void World::report_shaft(Tick tick) {
  report_encoder(tick);
  if (machine_.place_unit() == PlaceUnit::micrometre && place() != traced_place_)
    report(tick, "stage", traced_place_ = place());
}

std::int64_t World::distance_to_event() const {
  const EventDistance distance = machine_.next_event_distance(drive_train_.committed_shaft_angle());
  return std::min(distance.down, distance.up);
}

ShaftEncoder& World::encoder() {
  encoder_.follow(encoder_angle());
  return encoder_;
}

void World::report_encoder(Tick tick) {
  if (encoder_count() != traced_count_) report(tick, "encoder", traced_count_ = encoder_count());
}

/// A closed contact pulls its input to ground, a pull-up resistor lifts that of an open one.
void World::update_switches(Tick tick) {
  const auto level = [this, tick](std::string_view name, MachineSwitch source, bool before) {
    const bool high = machine_.is_open(source, tick) && pull_ups_;
    if (high != before) report(tick, name, high);
    return high;
  };
  const SwitchInputs before = levels_;
  levels_ = {.left = level("left_switch", MachineSwitch::left, levels_.left),
             .right = level("right_switch", MachineSwitch::right, levels_.right),
             .home = level("home_switch", MachineSwitch::home, levels_.home)};
  if (levels_ == before) return;
  ++switch_changes_;
  drive_train_.set_switches(levels_.left, levels_.right);
}

}  // namespace opentmcl::twin
