// A board whose peripherals are plain registers. They are volatile, so the compiler can leave out no access and thus
// nothing of the firmware that leads to one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/hal.hpp"

namespace opentmcl::size_check {

/// The registers as the linker script places them.
struct Registers {
  std::uint32_t time_low;  ///< microseconds since reset; reading it latches time_high
  std::uint32_t time_high;
  std::uint32_t wake_low;  ///< when to leave the next sleep
  std::uint32_t wake_high;
  std::uint32_t restart;      ///< a write is a reset
  std::uint32_t spi_data[2];  ///< a write transfers, a read gives what came back
  std::uint32_t serial_status[2];
  std::uint32_t serial_data[2];
  std::uint32_t eeprom_busy;
  std::uint32_t eeprom_address;
  std::uint32_t eeprom_data;
  std::uint32_t inputs;
  std::uint32_t outputs;
  std::uint32_t analog[4];
};

extern "C" volatile Registers board_registers;

class Spi final : public hal::SpiDevice {
 public:
  explicit Spi(std::size_t unit) : unit_(unit) {}

  std::uint32_t transfer(std::uint32_t word) override {
    board_registers.spi_data[unit_] = word;
    return board_registers.spi_data[unit_];
  }

 private:
  std::size_t unit_;
};

class Serial final : public hal::BytePort {
 public:
  explicit Serial(std::size_t unit) : unit_(unit) {}

  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
    std::size_t count = 0;
    while (count < capacity && board_registers.serial_status[unit_] != 0) {
      buffer[count] = static_cast<std::uint8_t>(board_registers.serial_data[unit_]);
      ++count;
    }
    return count;
  }

  void write(const std::uint8_t* data, std::size_t length) override {
    for (std::size_t i = 0; i < length; ++i) {
      board_registers.serial_data[unit_] = data[i];
    }
  }

 private:
  std::size_t unit_;
};

class Eeprom final : public hal::Eeprom {
 public:
  bool busy() override { return board_registers.eeprom_busy != 0; }

  void read(std::uint16_t address, std::uint8_t* data, std::size_t length) override {
    board_registers.eeprom_address = address;
    for (std::size_t i = 0; i < length; ++i) {
      data[i] = static_cast<std::uint8_t>(board_registers.eeprom_data);
    }
  }

  void write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length) override {
    board_registers.eeprom_address = address;
    for (std::size_t i = 0; i < length; ++i) {
      board_registers.eeprom_data = data[i];
    }
  }
};

class Pins final : public hal::Pins {
 public:
  std::uint32_t inputs() override { return board_registers.inputs; }
  void set_outputs(std::uint32_t levels) override { board_registers.outputs = levels; }
};

class Analog final : public hal::Analog {
 public:
  std::int32_t read(hal::AnalogInput input) override {
    return static_cast<std::int32_t>(board_registers.analog[static_cast<std::size_t>(input)]);
  }
};

/// The whole main program; the reset handler ends here.
[[noreturn]] void run_forever();

}  // namespace opentmcl::size_check
