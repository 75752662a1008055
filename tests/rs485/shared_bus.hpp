// A host and two modules on one RS485 bus; each module has a USB port beside it for what the bus must not see.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "boards/twin/rs485_bus.hpp"
#include "boards/twin/virtual_module.hpp"
#include "firmware/wire/datagram.hpp"
#include "tests/module/bench.hpp"

namespace opentmcl::tests {

/// Writes down when the motor makes its steps.
class StepTimes final : public twin::TraceObserver {
 public:
  void changed(twin::Tick tick, std::string_view signal, std::int64_t value) override {
    if (signal == "step" && value != 0) ticks.push_back(tick);
  }

  std::vector<twin::Tick> ticks;
};

/// One module of the bus. Its address is set over USB, as one does before it joins a bus.
struct BusModule {
  BusModule(const ModuleDescription& description, hal::BytePort& bus_port);

  /// Executes a command over USB. @return its reply
  Reply over_usb(const Command& command);

  StepTimes steps;
  TestPort usb;
  VirtualModule module;
};

class SharedBus {
 public:
  static constexpr std::uint8_t first_address = 1;
  static constexpr std::uint8_t second_address = 3;
  static constexpr std::uint8_t group_address = 9;
  static constexpr std::uint8_t host_address = 2;

  SharedBus(const ModuleDescription& first_module, const ModuleDescription& second_module, std::uint32_t baud_rate);

  /// The host puts bytes on the wires.
  void send(const std::vector<std::uint8_t>& bytes) { host_.write(bytes.data(), bytes.size()); }
  void send(std::uint8_t address, const Command& command);

  /// Lets time pass for the wires and both modules together. @return what the host has heard meanwhile
  std::vector<std::uint8_t> wait(Microseconds duration);

  /// Sends a request and waits for the nine bytes of its reply, at most for `limit`.
  std::optional<Datagram> exchange(std::uint8_t address, const Command& command,
                                   Microseconds limit = 100 * one_millisecond);

  Microseconds now() const { return bus.now() / twin::ticks_per_microsecond; }
  /// Time of nine bytes on the wires.
  Microseconds datagram_duration() const { return datagram_size * bus.byte_duration() / twin::ticks_per_microsecond; }

  Rs485Bus bus;

 private:
  hal::BytePort& host_;

 public:
  BusModule first;
  BusModule second;
};

}  // namespace opentmcl::tests
