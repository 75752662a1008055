#pragma once

#include "firmware/chip/tmc429_registers.hpp"
#include "firmware/hal/spi_device.hpp"

namespace opentmcl {

/// Typed access to the TMC429, motor 1. A transfer has no side effect beyond the register it names.
class Tmc429Driver {
 public:
  explicit Tmc429Driver(hal::SpiDevice& spi) : spi_(spi) {}

  template <class Register>
  void write(chip::Word<Register> word) {
    spi_.transfer(tmc429::write_datagram(word));
  }

  template <class Register>
  chip::Word<Register> read() {
    return tmc429::word_in<Register>(spi_.transfer(tmc429::read_datagram<Register>()));
  }

  /// Reads the only field of a register that has one.
  template <class Register>
  std::int32_t value() {
    return Register::Value::in(read<Register>());
  }

 private:
  hal::SpiDevice& spi_;
};

}  // namespace opentmcl
