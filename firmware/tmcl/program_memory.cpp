#include "firmware/tmcl/program_memory.hpp"

namespace opentmcl {

namespace layout = eeprom_layout;

namespace {

constexpr std::uint16_t eeprom_address(std::uint16_t instruction_address) {
  return static_cast<std::uint16_t>(layout::program_address + instruction_address * layout::instruction_size);
}

constexpr std::size_t room_in_page(std::uint16_t address) {
  return hal::Eeprom::page_size - address % hal::Eeprom::page_size;
}

void pack(const Command& instruction, std::uint8_t* bytes) {
  bytes[0] = instruction.opcode;
  bytes[1] = instruction.type;
  bytes[2] = instruction.motor;
  put_int32(bytes + 3, instruction.value);
}

Command unpack(const std::uint8_t* bytes) {
  return {bytes[0], bytes[1], bytes[2], get_int32(bytes + 3)};
}

}  // namespace

bool ProgramMemory::is_complete() const {
  return store_.holds(layout::program_state_slot) && store_.value(layout::program_state_slot) == complete;
}

void ProgramMemory::begin_download() {
  store_.store(layout::program_state_slot, incomplete);
  pending_ = 0;
}

/// Starts to write the part of the pending bytes that lies in their first page.
bool ProgramMemory::flush_page() {
  // The record that says "incomplete" goes first: settings are written before the program.
  if (!store_.is_written() || eeprom_.busy()) return false;
  const std::size_t room = room_in_page(pending_address_);
  const std::size_t length = pending_ < room ? pending_ : room;
  eeprom_.write_page(pending_address_, buffer_, length);
  pending_ = static_cast<std::uint8_t>(pending_ - length);
  pending_address_ = static_cast<std::uint16_t>(pending_address_ + length);
  for (std::size_t i = 0; i < pending_; ++i) buffer_[i] = buffer_[i + length];
  return true;
}

void ProgramMemory::erase() {
  begin_download();
  cache_.clear();
  erase_page_ = layout::program_address;
}

Microseconds ProgramMemory::erase_next(Microseconds now) {
  if (!eeprom_.busy() && !store_.write_first(layout::program_state_slot)) {
    for (std::uint8_t& byte : buffer_) byte = 0;
    eeprom_.write_page(erase_page_, buffer_, hal::Eeprom::page_size);
    erase_page_ = static_cast<std::uint16_t>((erase_page_ + hal::Eeprom::page_size) % hal::Eeprom::size);
  }
  return now + ParameterStore::poll_period;
}

ProgramMemory::Access ProgramMemory::write(std::uint16_t address, const Command& instruction) {
  if (is_erasing()) return Access::busy;
  const std::uint16_t start = eeprom_address(address);
  while (pending_ != 0 && pending_address_ + pending_ != start) {
    if (!flush_page()) return Access::busy;
  }
  if (pending_ != 0 && pending_ >= room_in_page(pending_address_) && !flush_page()) return Access::busy;
  if (pending_ == 0) pending_address_ = start;
  cache_.forget(address);
  pack(instruction, buffer_ + pending_);
  pending_ = static_cast<std::uint8_t>(pending_ + layout::instruction_size);
  return Access::done;
}

ProgramMemory::Access ProgramMemory::end_download() {
  while (pending_ != 0) {
    if (!flush_page()) return Access::busy;
  }
  store_.store(layout::program_state_slot, complete);
  return Access::done;
}

ProgramMemory::Access ProgramMemory::read(std::uint16_t address, Command& instruction) {
  if (is_erasing() || eeprom_.busy()) return Access::busy;
  const std::uint16_t start = eeprom_address(address);
  std::uint8_t bytes[layout::instruction_size];
  eeprom_.read(start, bytes, sizeof bytes);
  for (std::size_t i = 0; i < sizeof bytes; ++i) {
    const std::size_t offset = start + i - pending_address_;  // huge for addresses before the pending bytes
    if (start + i >= pending_address_ && offset < pending_) bytes[i] = buffer_[offset];
  }
  instruction = unpack(bytes);
  return Access::done;
}

const DecodedInstruction* ProgramMemory::fetch_from_eeprom(std::uint16_t address) {
  Command instruction;
  if (read(address, instruction) == Access::busy) return nullptr;
  Reach reach{};
  const DecodedInstruction decoded = decode(dispatch_, instruction, reach);
  return cache_.insert(address, decoded, reach);
}

}  // namespace opentmcl
