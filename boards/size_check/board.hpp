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
  std::uint32_t input_change;  ///< an input or the supply changed; reading clears it
  std::uint32_t outputs;
  std::uint32_t analog[5];
  std::uint32_t encoder_count;
  std::uint32_t encoder_null_status[2];  ///< an event was seen: N low active, high active; reading clears it
  std::uint32_t encoder_null_count;
  std::uint32_t can_bit_rate;
  std::uint32_t can_status;  ///< a frame was received
  std::uint32_t can_id;      ///< bit 31: 29-bit identifier
  std::uint32_t can_length;
  std::uint32_t can_data[2];
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

class Encoder final : public hal::Encoder {
 public:
  std::int32_t count() override { return static_cast<std::int32_t>(board_registers.encoder_count); }

  bool take_null_event(bool high_active, std::int32_t& count) override {
    if (board_registers.encoder_null_status[high_active ? 1 : 0] == 0) return false;
    count = static_cast<std::int32_t>(board_registers.encoder_null_count);
    return true;
  }
};

class Can final : public hal::CanPort {
 public:
  void join(std::uint32_t bit_rate) override { board_registers.can_bit_rate = bit_rate; }

  bool read(hal::CanFrame& frame) override {
    if (board_registers.can_status == 0) return false;
    const std::uint32_t id = board_registers.can_id;
    frame.id = id & ~extended;
    frame.is_extended = (id & extended) != 0;
    frame.length = static_cast<std::uint8_t>(board_registers.can_length);
    for (std::size_t i = 0; i < 8; ++i) {
      frame.data[i] = static_cast<std::uint8_t>(board_registers.can_data[i / 4] >> 8 * (i % 4));
    }
    return true;
  }

  void write(const hal::CanFrame& frame) override {
    board_registers.can_length = frame.length;
    std::uint32_t words[2] = {};
    for (std::size_t i = 0; i < 8; ++i) words[i / 4] |= std::uint32_t{frame.data[i]} << 8 * (i % 4);
    board_registers.can_data[0] = words[0];
    board_registers.can_data[1] = words[1];
    board_registers.can_id = frame.id | (frame.is_extended ? extended : 0);
  }

 private:
  static constexpr std::uint32_t extended = 1U << 31;
};

/// The whole main program; the reset handler ends here.
[[noreturn]] void run_forever();

}  // namespace opentmcl::size_check
