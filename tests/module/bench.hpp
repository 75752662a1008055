// A virtual module on the bench: bytes in, bytes out, simulated time.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::tests {

/// A measurement of stallGuard2 that shows 0, a stall, with every threshold (parameter 174).
inline constexpr std::int32_t measured_at_a_stall = -1'000;

/// One end of a serial line that a test holds.
class TestPort final : public hal::BytePort {
 public:
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override;
  void write(const std::uint8_t* data, std::size_t length) override {
    received.insert(received.end(), data, data + length);
  }

  std::deque<std::uint8_t> to_module;
  std::vector<std::uint8_t> received;
};

class Bench {
 public:
  explicit Bench(const ModuleDescription& description, hal::PortKind kind = hal::PortKind::usb,
                 twin::TraceObserver* observer = nullptr, const VirtualModule::Options& options = {});

  /// Sends raw bytes and lets 3 ms pass. @return everything that came back
  std::vector<std::uint8_t> send(const std::vector<std::uint8_t>& bytes);
  /// Sends one datagram to `address`. @return the datagram that came back, or nothing; never more than one
  std::optional<Datagram> exchange(const Datagram& request);
  /// @return the reply, whose frame is checked; fails the test when there is none
  Reply command(const Command& command);
  Reply command(Opcode opcode, std::uint8_t type = 0, std::uint8_t motor = 0, std::int32_t value = 0);

  /// Shorthands that expect status 100.
  std::int32_t get(AxisParameter parameter);
  void set(AxisParameter parameter, std::int32_t value);
  std::int32_t get(GlobalParameter parameter);
  void set(GlobalParameter parameter, std::int32_t value);

  /// Assembles, downloads (132, 133) and starts (129) a program.
  void run_program(const std::string& source);
  void download(const std::string& source);

  void wait(Microseconds duration) { module.advance_to(module.now() + duration); }
  /// Lets time pass until the motor is at its target. @return how long it took; fails after `limit`
  Microseconds wait_until_reached(Microseconds limit);

  TestPort port;
  VirtualModule module;
};

}  // namespace opentmcl::tests
