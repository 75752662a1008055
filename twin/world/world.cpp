#include "twin/world/world.hpp"

namespace opentmcl::twin {
namespace {

constexpr unsigned driven_motor = 0;  // motor 1: the only one with a driver on these modules

}  // namespace

World::World(TraceObserver* observer) : observer_(observer) {
  tmc429_.emplace(static_cast<StepListener&>(*this));
  tmc262_.set_temperature(temperature_);
}

void World::power_cycle() {
  report(now_, "power", 0);
  powered_at_ = now_;
  tmc429_.emplace(static_cast<StepListener&>(*this));
  tmc429_->set_left_switch(left_switch_);
  tmc429_->set_right_switch(right_switch_);
  tmc262_ = Tmc262{};
  tmc262_.set_temperature(temperature_);
  tmc262_.set_load_measurement(load_measurement_);
  tmc262_.set_supply_voltage(supply_voltage_);
  eeprom_.power_up();
  set_outputs(0);
  direction_ = false;
  report(now_, "power", 1);
}

void World::advance_to(Tick tick) {
  if (tick <= now_) {
    return;
  }
  tmc429_->advance(tick - now_);
  now_ = tick;
}

std::uint32_t World::transfer_tmc429(std::uint32_t datagram) {
  report(now_, "tmc429.datagram", datagram);
  return tmc429_->transfer(datagram);
}

std::uint32_t World::transfer_tmc262(std::uint32_t word) {
  report(now_, "tmc262.word", word);
  const std::uint32_t reply = tmc262_.transfer(word, now_ - powered_at_);
  turn_rotor();
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
  turn_rotor();
}

void World::set_left_switch(bool level) {
  report(now_, "left_switch", level);
  left_switch_ = level;
  tmc429_->set_left_switch(level);
}

void World::set_right_switch(bool level) {
  report(now_, "right_switch", level);
  right_switch_ = level;
  tmc429_->set_right_switch(level);
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
  step({driven_motor, now_ - powered_at_, StepSignal::pulse, direction});
}

void World::set_temperature(std::int32_t celsius) {
  temperature_ = celsius;
  report(now_, "temperature", celsius);
  tmc262_.set_temperature(celsius);
  turn_rotor();
}

void World::step(const StepEvent& event) {
  if (event.motor != driven_motor) {
    return;
  }
  if (event.direction != direction_) {
    direction_ = event.direction;
    report(powered_at_ + event.clock, "direction", direction_);
  }
  if (event.signal != StepSignal::falling) {
    step_edge(true, event);
  }
  if (event.signal != StepSignal::rising) {
    step_edge(false, event);
  }
}

void World::step_edge(bool rising, const StepEvent& event) {
  report(powered_at_ + event.clock, "step", rising);
  tmc262_.step_edge(rising, event.direction, event.clock);
  turn_rotor();
}

void World::turn_rotor() {
  const bool spi_sets_currents = tmc262::DriverConfiguration::StepDirOff::is_set(tmc262_.driver_configuration());
  if (tmc262_.bridges_on() && !spi_sets_currents) {
    rotor_.follow(tmc262_.microstep_position());
  }
}

void World::report(Tick tick, std::string_view signal, std::int64_t value) {
  if (observer_ != nullptr) {
    observer_->changed(tick, signal, value);
  }
}

}  // namespace opentmcl::twin
