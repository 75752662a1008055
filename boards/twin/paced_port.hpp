#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "firmware/hal/byte_port.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl {

/// A serial line between a host's port and a module on which each byte takes its time: ten bits (start, eight, stop),
/// in simulated time. A byte is there when its stop bit is over, in both directions.
///
/// One exchange at a time is on the line, as TMCL has it: the host's port is asked for the next request when the module
/// asks for more and its answer has left. So the line behaves the same at full duplex (USB, RS232) and half duplex
/// (RS485) (docs/decisions/0049-wire-pacing.md).
class PacedPort final : public hal::BytePort, public BenchActor {
 public:
  static constexpr unsigned bits_per_byte = 10;
  /// What users may ask for, in bit/s.
  static constexpr std::uint32_t slowest_rate = 300;
  static constexpr std::uint32_t fastest_rate = 1'000'000;

  /// @param host where the module's bytes go and the host's come from, without delay; must outlive this
  /// @param kind at a port of the kind rs485 the module listens and speaks at the rate of its global parameter 65, and
  ///        neither side understands the other when that is not the host's
  /// @param baud_rate the host's, in bit/s, more than 0
  PacedPort(hal::BytePort& host, hal::PortKind kind, std::uint32_t baud_rate);
  PacedPort(const PacedPort&) = delete;
  PacedPort& operator=(const PacedPort&) = delete;

  /// `module` is the one that has this as one of its ports, and outlives this. @pre called once, before time passes
  void connect(VirtualModule& module);

  // What the firmware sees.
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override;
  void write(const std::uint8_t* data, std::size_t length) override;
  void set_text_mode(bool text) override {
    is_text_ = text;
    host_.set_text_mode(text);
  }

  // How time passes on the line.
  Microseconds next_act() const override;
  void act(VirtualModule& module) override;

 private:
  /// Bytes that follow each other in one direction.
  struct Train {
    std::vector<std::uint8_t> bytes;
    std::size_t passed = 0;   ///< bytes of it that have arrived
    twin::Tick next_end = 0;  ///< when the next one has

    bool is_under_way() const { return passed < bytes.size(); }
    void start(std::span<const std::uint8_t> all, twin::Tick first_end);
  };

  twin::Tick now() const;
  bool is_understood() const;
  void take_from_host();

  hal::BytePort& host_;
  const hal::PortKind kind_;
  const std::uint32_t baud_rate_;
  const twin::Tick byte_duration_;
  VirtualModule* module_ = nullptr;
  bool is_text_ = false;  ///< typed characters and their echoes pass each other
  Train to_module_;
  Train to_host_;
  std::vector<std::uint8_t> arrived_;  ///< at the module, which has not read it
};

}  // namespace opentmcl
