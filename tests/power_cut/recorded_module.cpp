#include "tests/power_cut/recorded_module.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace opentmcl::tests {

Image erased_image() {
  return twin::Eeprom{}.image();
}

RecordedModule::RecordedModule(const ModuleDescription& description, const Image& eeprom)
    : module_(description, {{&port_, hal::PortKind::usb}}, {}, this) {
  module_.world().eeprom().load(eeprom);
  wait(one_millisecond);
}

void RecordedModule::changed(twin::Tick, std::string_view signal, std::int64_t value) {
  if (signal == "eeprom.write") address_ = static_cast<std::uint16_t>(value);
}

/// In each turn the firmware starts at most one page write: the chip is busy for longer than a turn.
void RecordedModule::take_turns_until(Microseconds time) {
  const twin::Eeprom& eeprom = module_.world().eeprom();
  while (module_.now() < time) {
    module_.advance_to(std::min(time, std::max(module_.next_turn(), module_.now() + 1)));
    const auto length = static_cast<std::ptrdiff_t>(eeprom.bytes_written() - bytes_written_);
    if (length == 0) continue;
    bytes_written_ = eeprom.bytes_written();
    const Image image = eeprom.image();
    const auto* first = image.begin() + address_;
    writes_.push_back({address_, {first, first + length}});
  }
}

void RecordedModule::wait(Microseconds duration) {
  take_turns_until(module_.now() + duration);
}

std::optional<Datagram> RecordedModule::exchange(const Command& command) {
  const Datagram request = encode(Request{1, command});
  port_.received.clear();
  port_.to_module.insert(port_.to_module.end(), request.bytes, request.bytes + datagram_size);
  module_.wake();
  // The turn of this very moment; a command that needs the EEPROM may take longer.
  module_.advance_to(module_.now());
  const Microseconds deadline = module_.now() + 2'000 * one_millisecond;
  while (port_.received.size() < datagram_size && module_.now() < deadline) {
    take_turns_until(std::min(deadline, module_.now() + one_millisecond));
  }
  if (port_.received.size() < datagram_size) return std::nullopt;
  Datagram reply;
  std::copy_n(port_.received.begin(), datagram_size, reply.bytes);
  return reply;
}

std::int32_t RecordedModule::execute(const Command& command) {
  const std::optional<Datagram> datagram = exchange(command);
  EXPECT_TRUE(datagram.has_value()) << "opcode " << int{command.opcode} << " is not answered";
  if (!datagram) return 0;
  const Reply reply = decode_reply(*datagram);
  EXPECT_GE(reply.status, Status::ok) << "opcode " << int{command.opcode} << ", type " << int{command.type}
                                      << ", value " << command.value;
  return reply.value;
}

void RecordedModule::settle() {
  std::size_t known = writes_.size() + 1;
  while (known != writes_.size()) {
    known = writes_.size();
    wait(20 * one_millisecond);
  }
}

std::size_t at_every_cut(const Image& before, const std::vector<PageWrite>& writes,
                         const std::function<void(const Image&)>& check) {
  std::size_t cuts = 0;
  twin::Eeprom whole;
  whole.load(before);
  std::uint64_t clock = 0;
  for (const PageWrite& write : writes) {
    for (std::size_t length = 0; length < write.bytes.size(); ++length) {
      twin::Eeprom torn;
      torn.load(whole.image());
      torn.cut_power_after(length);
      torn.write_page(write.address, write.bytes.data(), write.bytes.size(), 0);
      check(torn.image());
      ++cuts;
    }
    whole.write_page(write.address, write.bytes.data(), write.bytes.size(), clock);
    clock += twin::Eeprom::page_write_clocks;
  }
  check(whole.image());
  return cuts + 1;
}

}  // namespace opentmcl::tests
