#include "twin/world/world.hpp"

#include <algorithm>

namespace opentmcl::twin {
namespace {

constexpr unsigned driven_motor = 0;  // motor 1: the only one with a driver on these modules

}  // namespace

World::World(TraceObserver* observer, const Mounted& mounted)
    : observer_(observer),
      machine_(mounted.machine),
      rotor_(machine_.travel().lowest, machine_.travel().highest),
      encoder_(mounted.encoder) {
  tmc429_.emplace(static_cast<StepListener&>(*this)).set_detail(StepDetail::edges);
  tmc262_.set_temperature(temperature_);
  update_switches(now_);
  follow_shaft(now_);
}

void World::power_cycle() {
  report(now_, "power", 0);
  powered_at_ = now_;
  tmc429_.emplace(static_cast<StepListener&>(*this)).set_detail(StepDetail::edges);
  tmc262_.power_up();
  eeprom_.lose_power(now_);
  eeprom_.power_up();
  set_outputs(0);
  encoder_.power_up();
  pull_ups_ = true;
  update_switches(now_);
  direction_ = false;
  report(now_, "power", 1);
}

void World::advance_to(Tick tick) {
  while (now_ < tick) {
    // A step may start the chatter of a contact: its first change must not lie within the same piece.
    const Tick longest = machine_.shortest_chatter();
    const Tick chatter = machine_.next_chatter(now_);
    const Tick next = std::min({tick, chatter, longest < tick - now_ ? now_ + longest : tick});
    tmc429_->advance(next - now_);
    now_ = next;
    tmc262_.advance(now_ - powered_at_);
    if (now_ == chatter) update_switches(now_);
  }
}

std::uint32_t World::transfer_tmc429(std::uint32_t datagram) {
  report(now_, "tmc429.datagram", datagram);
  return tmc429_->transfer(datagram);
}

std::uint32_t World::transfer_tmc262(std::uint32_t word) {
  report(now_, "tmc262.word", word);
  const std::uint32_t reply = tmc262_.transfer(word, now_ - powered_at_);
  turn_rotor(now_);
  return reply;
}

void World::read_eeprom(std::uint16_t address, std::uint8_t* data, std::size_t length) const {
  eeprom_.read(address, data, length, now_);
}

void World::write_eeprom_page(std::uint16_t address, const std::uint8_t* data, std::size_t length) {
  report(now_, "eeprom.write", address);
  eeprom_.write_page(address, data, length, now_);
}

void World::set_outputs(std::uint32_t levels) {
  if (levels != outputs_) {
    outputs_ = levels;
    report(now_, "outputs", levels);
  }
}

void World::set_inputs(std::uint32_t levels) {
  if (levels != inputs_) {
    inputs_ = levels;
    ++input_changes_;
    report(now_, "inputs", levels);
  }
}

void World::set_driver_disable(bool level) {
  report(now_, "driver_disable", level);
  tmc262_.set_enable_not(level);
  turn_rotor(now_);
}

void World::set_pull_ups(bool on) {
  pull_ups_ = on;
  update_switches(now_);
}

void World::set_left_switch(bool open) {
  machine_.break_wire(MachineSwitch::left, open);
  update_switches(now_);
}

void World::set_right_switch(bool open) {
  machine_.break_wire(MachineSwitch::right, open);
  update_switches(now_);
}

void World::set_home_switch(bool open) {
  machine_.break_wire(MachineSwitch::home, open);
  update_switches(now_);
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
  report(now_, "supply_voltage", millivolts);
  tmc262_.set_supply_voltage(millivolts);
}

void World::set_load_measurement(std::int32_t value) {
  load_measurement_ = value;
  report(now_, "load_measurement", value);
  tmc262_.set_load_measurement(value);
}

void World::pulse_step_input(bool direction) {
  const std::uint64_t clock = now_ - powered_at_;
  steps({driven_motor, 1, clock, clock, StepSignal::pulse, direction});
}

void World::set_temperature(std::int32_t celsius) {
  temperature_ = celsius;
  report(now_, "temperature", celsius);
  tmc262_.set_temperature(celsius);
  turn_rotor(now_);
}

void World::steps(const StepRun& run) {
  if (run.motor != driven_motor) {
    return;
  }
  if (run.direction != direction_) {
    direction_ = run.direction;
    report(powered_at_ + run.first_clock, "direction", direction_);
  }
  if (run.signal != StepSignal::falling) {
    step_edge(true, run.direction, run.first_clock);
  }
  if (run.signal != StepSignal::rising) {
    step_edge(false, run.direction, run.first_clock);
  }
}

void World::step_edge(bool rising, bool direction, std::uint64_t clock) {
  const Tick tick = powered_at_ + clock;
  report(tick, "step", rising);
  tmc262_.steps(1, rising ? StepSignal::rising : StepSignal::falling, direction, clock, clock);
  turn_rotor(tick);
}

void World::turn_rotor(Tick tick) {
  const bool spi_sets_currents = tmc262::DriverConfiguration::StepDirOff::is_set(tmc262_.driver_configuration());
  if (tmc262_.bridges_on() && !spi_sets_currents) {
    const std::int64_t before = rotor_.angle();
    rotor_.follow(tmc262_.microstep_position());
    if (rotor_.angle() != before) follow_shaft(tick);
  }
}

/// What the shaft moves: the encoder, the slider and its switches.
void World::follow_shaft(Tick tick) {
  const std::int64_t angle = rotor_.angle();
  if (machine_.follow(angle, tick)) update_switches(tick);
  encoder_.follow(encoder_.properties().on_load_side ? machine_.load_side_angle() : angle);
  if (observer_ == nullptr) return;
  if (encoder_.count() != traced_count_) report(tick, "encoder", traced_count_ = encoder_.count());
  if (machine_.place_unit() == PlaceUnit::micrometre && machine_.place() != traced_place_)
    report(tick, "stage", traced_place_ = machine_.place());
}

/// A closed contact pulls its input to ground, a pull-up resistor lifts that of an open one.
void World::update_switches(Tick tick) {
  const auto level = [this, tick](std::string_view name, MachineSwitch source, bool before) {
    const bool high = machine_.is_open(source, tick) && pull_ups_;
    if (high != before) report(tick, name, high);
    return high;
  };
  levels_ = {.left = level("left_switch", MachineSwitch::left, levels_.left),
             .right = level("right_switch", MachineSwitch::right, levels_.right),
             .home = level("home_switch", MachineSwitch::home, levels_.home)};
  tmc429_->set_left_switch(levels_.left);
  tmc429_->set_right_switch(levels_.right);
}

void World::report(Tick tick, std::string_view signal, std::int64_t value) {
  if (observer_ != nullptr) {
    observer_->changed(tick, signal, value);
  }
}

}  // namespace opentmcl::twin
