#include "tests/rs485/shared_bus.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace opentmcl::tests {

BusModule::BusModule(const ModuleDescription& description, hal::BytePort& bus_port)
    : module(description, {{&bus_port, hal::PortKind::rs485}, {&usb, hal::PortKind::usb}}, {}, &steps) {}

Reply BusModule::over_usb(const Command& command) {
  const Datagram request = encode(Request{0, command});
  usb.received.clear();
  usb.to_module.assign(request.bytes, request.bytes + datagram_size);
  module.wake();
  module.advance_to(module.now());
  EXPECT_EQ(usb.received.size(), datagram_size) << "opcode " << int{command.opcode} << " over USB";
  Datagram reply;
  std::copy_n(usb.received.begin(), std::min(usb.received.size(), datagram_size), reply.bytes);
  return decode_reply(reply);
}

SharedBus::SharedBus(const ModuleDescription& first_module, const ModuleDescription& second_module,
                     std::uint32_t baud_rate)
    : bus(baud_rate), host_(bus.connect()), first(first_module, bus.connect()), second(second_module, bus.connect()) {
  wait(one_millisecond);
  const auto set = [](BusModule& node, GlobalParameter parameter, std::uint8_t value) {
    const Command command{static_cast<std::uint8_t>(Opcode::sgp), static_cast<std::uint8_t>(parameter), 0, value};
    EXPECT_EQ(node.over_usb(command).status, Status::ok);
  };
  set(first, GlobalParameter::serial_address, first_address);
  set(second, GlobalParameter::serial_address, second_address);
  for (BusModule* node : {&first, &second}) set(*node, GlobalParameter::serial_secondary_address, group_address);
  wait(50 * one_millisecond);
}

void SharedBus::send(std::uint8_t address, const Command& command) {
  const Datagram request = encode(Request{address, command});
  host_.write(request.bytes, datagram_size);
}

std::vector<std::uint8_t> SharedBus::wait(Microseconds duration) {
  const Microseconds end = now() + duration;
  const auto arrival = [this] {
    if (bus.is_idle()) return never;
    return (bus.next_arrival() + twin::ticks_per_microsecond - 1) / twin::ticks_per_microsecond;
  };
  while (now() < end) {
    const Microseconds next = std::min({end, arrival(), first.module.next_turn(), second.module.next_turn()});
    const bool heard = bus.advance_to(std::max(next, now()) * twin::ticks_per_microsecond);
    for (BusModule* node : {&first, &second}) {
      node->module.advance_to(now());
      if (!heard) continue;
      node->module.wake();
      node->module.advance_to(now());
    }
  }
  std::vector<std::uint8_t> bytes(10'000);
  bytes.resize(host_.read(bytes.data(), bytes.size()));
  return bytes;
}

std::optional<Datagram> SharedBus::exchange(std::uint8_t address, const Command& command, Microseconds limit) {
  send(address, command);
  const Microseconds deadline = now() + 2 * datagram_duration() + limit;
  std::vector<std::uint8_t> heard;
  while (heard.size() < datagram_size) {
    if (now() >= deadline) return std::nullopt;
    const std::vector<std::uint8_t> more = wait(100);
    heard.insert(heard.end(), more.begin(), more.end());
  }
  EXPECT_EQ(heard.size(), datagram_size) << "one reply";
  Datagram reply;
  std::copy_n(heard.begin(), datagram_size, reply.bytes);
  return reply;
}

}  // namespace opentmcl::tests
