// A TMC429 on the bench for its tests: registers by name, steps counted.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/tmc429.hpp"

namespace opentmcl::twin {

struct StepRecorder : StepListener {
  std::vector<StepRun> events;
  void steps(const StepRun& run) override { events.push_back(run); }
};

/// Every step is an event of its own.
struct Tmc429Bench {
  StepRecorder steps;
  Tmc429 chip{steps};

  /// The state in which a module's firmware uses the chip: Step/Dir drivers, right switches in use.
  Tmc429Bench() {
    using tmc429::InterfaceConfiguration;
    chip.set_detail(StepDetail::edges);
    write(InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::EnableRightSwitches::set |
          InterfaceConfiguration::InterruptOutput::set);
    write(tmc429::GlobalParameters::StepPulseLength::of(0));
  }

  template <class Register>
  void write(tmc429::Word<Register> word, unsigned motor = 0) {
    chip.transfer(tmc429::write_datagram(word, motor));
  }

  template <class Register>
  tmc429::Word<Register> read(unsigned motor = 0) {
    return tmc429::word_in<Register>(chip.transfer(tmc429::read_datagram<Register>(motor)));
  }

  /// For registers that hold one number.
  template <class Register>
  void set(std::int32_t value, unsigned motor = 0) {
    write(Register::Value::of(value), motor);
  }

  template <class Register>
  std::int32_t get(unsigned motor = 0) {
    return Register::Value::in(read<Register>(motor));
  }

  void set_dividers(int pulse, int ramp, unsigned motor = 0) {
    write(tmc429::Dividers::Pulse::of(pulse) | tmc429::Dividers::Ramp::of(ramp), motor);
  }

  void set_mode(tmc429::RampMode mode, unsigned motor = 0) { write(tmc429::Mode::of(mode), motor); }

  /// Turns with a constant velocity at once.
  void hold_velocity(std::int32_t velocity) {
    set_mode(tmc429::RampMode::hold);
    set<tmc429::ActualVelocity>(velocity);
  }

  tmc429::Word<tmc429::Status> status() {
    return tmc429::status_of(chip.transfer(tmc429::read_datagram<tmc429::TypeVersion>()));
  }

  tmc429::Word<tmc429::Interrupts> flags() {
    return {static_cast<std::uint32_t>(tmc429::Interrupts::Flags::in(read<tmc429::Interrupts>()))};
  }
};

}  // namespace opentmcl::twin
