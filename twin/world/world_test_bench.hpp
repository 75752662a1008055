// How the tests of World reach the chips in it.
#pragma once

#include <cstdint>

#include "twin/world/world.hpp"

namespace opentmcl::twin {

inline constexpr Tick millisecond = 1000 * ticks_per_microsecond;

template <class Register>
void write(World& world, tmc429::Word<Register> word) {
  world.transfer_tmc429(tmc429::write_datagram(word));
}

template <class Register>
void set(World& world, std::int32_t value) {
  write(world, Register::Value::of(value));
}

template <class Register>
std::int32_t get(World& world) {
  return Register::Value::in(tmc429::word_in<Register>(world.transfer_tmc429(tmc429::read_datagram<Register>())));
}

/// As a module's firmware leaves the chips: Step/Dir, bridges on, 2^(8 - resolution) microsteps.
inline void start(World& world, int resolution = 0) {
  using tmc429::InterfaceConfiguration;
  write(world, InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::EnableRightSwitches::set);
  write(world, tmc429::GlobalParameters::StepPulseLength::of(0));
  set<tmc429::MinimumVelocity>(world, 1);
  set<tmc429::MaximumVelocity>(world, 1000);
  set<tmc429::MaximumAcceleration>(world, 500);
  write(world, tmc429::BrakingFactor::Multiplier::of(237) | tmc429::BrakingFactor::Divisor::of(4));
  write(world, tmc429::Dividers::Pulse::of(2) | tmc429::Dividers::Ramp::of(3));
  world.transfer_tmc262(tmc262::datagram(tmc262::ChopperConfiguration::OffTime::of(4)));
  world.transfer_tmc262(tmc262::datagram(tmc262::DriverControl::Resolution::of(resolution)));
}

/// As start(), with two thirds of the full-scale current.
inline void start_with_current(World& world) {
  start(world);
  world.transfer_tmc262(tmc262::datagram(tmc262::StallGuardAndCurrent::CurrentScale::of(20)));
  world.transfer_tmc262(tmc262::datagram(tmc262::DriverConfiguration::LowSenseVoltage::set));
  world.advance_to(20 * millisecond);
}

}  // namespace opentmcl::twin
