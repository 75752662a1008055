// Where direct mode is measured: a module whose chips cost next to nothing, and one with the models of the twin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "boards/twin/virtual_module.hpp"
#include "firmware/chip/tmc262_registers.hpp"
#include "firmware/chip/tmc429_registers.hpp"
#include "firmware/module/module.hpp"

namespace opentmcl::bench {

/// The host's end of a line that hands over whatever it was given, a datagram or a single byte, in one read().
class MemoryPort final : public hal::BytePort {
 public:
  void send(const Datagram& datagram) {
    request_ = datagram;
    available_ = datagram_size;
  }
  void send(std::uint8_t byte) {
    request_.bytes[0] = byte;
    available_ = 1;
  }

  /// The module is always between datagrams when a whole one is sent, so there is room for what there is.
  std::size_t read(std::uint8_t* buffer, std::size_t) override {
    const std::size_t count = available_;
    available_ = 0;
    if (count == datagram_size) {
      std::memcpy(buffer, request_.bytes, datagram_size);
    } else if (count == 1) {
      *buffer = request_.bytes[0];
    }
    return count;
  }

  void write(const std::uint8_t* data, std::size_t) override { std::memcpy(reply_.bytes, data, datagram_size); }

  const Datagram& reply() const { return reply_; }

 private:
  Datagram request_;
  std::size_t available_ = 0;
  Datagram reply_;
};

/// A board with nothing behind the firmware: reads of a chip's register return what was last written to it.
class RegisterFileBoard {
 public:
  RegisterFileBoard() : module_(pd1161, {tmc429_, tmc262_, eeprom_, pins_, analog_, encoder_, &port_, 1}) {}

  MemoryPort& port() { return bytes_; }
  Module& module() { return module_; }
  static Microseconds now() { return 0; }

 private:
  struct MotionController final : hal::SpiDevice {
    std::uint32_t transfer(std::uint32_t word) override {
      using tmc429::Datagram;
      std::uint32_t& content = registers[(word & Datagram::Address::mask) >> Datagram::Address::shift];
      if (!Datagram::Read::is_set({word})) content = word & Datagram::Data::mask;
      return content;
    }
    std::array<std::uint32_t, 64> registers{};
  };

  struct Driver final : hal::SpiDevice {
    std::uint32_t transfer(std::uint32_t word) override {
      // Bits 19 to 17 select the register; DRVCTRL has but the first of them.
      const std::uint32_t top = word >> 17 & 7;
      std::uint32_t& content = registers[top < 4 ? 0 : top - 3];
      content = word;
      return content;
    }
    std::array<std::uint32_t, 5> registers{};
  };

  struct Memory final : hal::Eeprom {
    bool busy() override { return false; }
    void read(std::uint16_t address, std::uint8_t* data, std::size_t length) override {
      std::memcpy(data, bytes.data() + address, length);
    }
    void write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length) override {
      std::memcpy(bytes.data() + address, data, length);
    }
    std::array<std::uint8_t, hal::Eeprom::size> bytes{};
  };

  struct NoPins final : hal::Pins {
    std::uint32_t inputs() override { return 0; }
    void set_outputs(std::uint32_t) override {}
  };

  struct Converter final : hal::Analog {
    std::int32_t read(hal::AnalogInput) override { return 240; }  // enough as a supply voltage
  };

  struct NoEncoder final : hal::Encoder {
    std::int32_t count() override { return 0; }
    bool take_null_event(bool, std::int32_t&) override { return false; }
  };

  MotionController tmc429_;
  Driver tmc262_;
  Memory eeprom_;
  NoPins pins_;
  Converter analog_;
  NoEncoder encoder_;
  MemoryPort bytes_;
  hal::Port port_{&bytes_, hal::PortKind::usb};
  Module module_;
};

/// The same port with nothing behind it but a reply: what loop and port of the benchmark cost themselves.
class EmptyBoard {
 public:
  MemoryPort& port() { return port_; }
  EmptyBoard& module() { return *this; }
  static Microseconds now() { return 0; }

  Microseconds poll(Microseconds now) {
    std::uint8_t* const room = datagram_.bytes + count_;
    hal::BytePort& port = port_;
    count_ += port.read(room, datagram_size - count_);
    if (count_ == datagram_size) {
      count_ = 0;
      port.write(datagram_.bytes, datagram_size);
    }
    return now;
  }

  void handle(const Datagram& request, hal::PortKind, Microseconds, Datagram& reply) { reply = request; }

 private:
  MemoryPort port_;
  Datagram datagram_;
  std::size_t count_ = 0;
};

/// The same module on the chip models, at an instant: no time passes in the world.
class ModelBoard {
 public:
  ModelBoard() : module_(pd1161, {{&bytes_, hal::PortKind::usb}}) {}

  MemoryPort& port() { return bytes_; }
  Module& module() { return module_.module(); }
  static Microseconds now() { return 0; }

 private:
  MemoryPort bytes_;
  VirtualModule module_;
};

}  // namespace opentmcl::bench
