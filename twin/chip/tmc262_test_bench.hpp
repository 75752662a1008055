// A TMC262 on the bench for its tests: registers by name, steps by the run.
#pragma once

#include <cstdint>

#include "firmware/chip/tmc262_registers.hpp"
#include "twin/chip/tmc262.hpp"

namespace opentmcl::twin {

struct Tmc262Bench {
  static constexpr bool up = false;  // DIR low counts up
  static constexpr bool down = true;

  Tmc262 chip;

  template <class Register>
  tmc262::Word<tmc262::Reply> send(tmc262::Word<Register> word) {
    return {chip.transfer(tmc262::datagram(word), chip.clock())};
  }
  /// The reply to a word that changes nothing, now.
  tmc262::Word<tmc262::Reply> reply() { return send(chip.stall_guard_and_current()); }
  tmc262::Word<tmc262::Reply> reply(tmc262::ReplyFormat format) {
    send(tmc262::DriverConfiguration::Format::replaced(chip.driver_configuration(), static_cast<std::int32_t>(format)));
    return reply();
  }

  static constexpr std::int32_t off_time = 4;
  void switch_bridges_on() { send(tmc262::ChopperConfiguration::OffTime::of(off_time)); }
  void switch_bridges_off() { send(tmc262::ChopperConfiguration::OffTime::of(0)); }
  void set_current_scale(std::int32_t scale) {
    send(tmc262::StallGuardAndCurrent::CurrentScale::replaced(chip.stall_guard_and_current(), scale));
  }

  void wait(std::uint64_t clocks) { chip.advance(chip.clock() + clocks); }
  /// STEP pulses, all at this moment.
  void pulse(bool direction, std::uint64_t count) {
    chip.steps(count, StepSignal::pulse, direction, chip.clock(), chip.clock());
  }
  /// A STEP pulse every `interval` clocks, the first one after the first interval.
  void pulse_every(std::uint64_t interval, bool direction, std::uint64_t count) {
    const std::uint64_t begin = chip.clock();
    chip.steps(count, StepSignal::pulse, direction, begin + interval, begin + interval * count);
  }
  /// With full steps, each of which ends in a polarity change.
  void take_full_steps(std::uint64_t count) {
    send(tmc262::DriverControl::Resolution::of(tmc262::maximum_resolution));
    pulse(up, count);
  }
};

}  // namespace opentmcl::twin
