#pragma once

#include "firmware/chip/tmc262_registers.hpp"
#include "firmware/hal/spi_device.hpp"

namespace opentmcl {

/// Shadow of the TMC262's registers, which cannot be read, and access to its three replies.
class Tmc262Driver {
 public:
  explicit Tmc262Driver(hal::SpiDevice& spi) : spi_(spi) {}

  tmc262::Word<tmc262::DriverControl> driver_control;
  tmc262::Word<tmc262::ChopperConfiguration> chopper_configuration;
  tmc262::Word<tmc262::CoolStepControl> cool_step_control;
  tmc262::Word<tmc262::StallGuardAndCurrent> stall_guard_and_current;
  tmc262::Word<tmc262::DriverConfiguration> driver_configuration;

  /// Writes one register from its shadow.
  template <class Register>
  void send(tmc262::Word<Register> word) {
    spi_.transfer(tmc262::datagram(word));
  }

  /// Writes all five registers: after power-on, and after an under-voltage of the driver cleared them.
  void send_all();

  /// A reply in the wanted format. The format of a reply is the one in force before the transfer, so a change of
  /// format costs a second transfer.
  tmc262::Word<tmc262::Reply> reply(tmc262::ReplyFormat format);
  /// Writes the next of the five registers in turn, for the chip loses them at an under-voltage too short to be seen.
  /// @return a reply in the format that happens to be in force: its low eight bits are the same in all
  tmc262::Word<tmc262::Reply> refresh();

 private:
  hal::SpiDevice& spi_;
  std::uint8_t next_refresh_ = 0;  ///< 0…4, in the order of send_all()
};

}  // namespace opentmcl
