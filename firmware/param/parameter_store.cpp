#include "firmware/param/parameter_store.hpp"

#include "firmware/param/crc16.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

namespace layout = eeprom_layout;

namespace {

/// Newer of two sequence numbers or generations that count modulo 256 or 65536 and are one apart.
template <class Number>
constexpr bool is_newer(Number a, Number b) {
  const auto ahead = static_cast<Number>(a - b);
  return ahead != 0 && ahead <= static_cast<Number>(~Number{0}) / 2;
}

// Header bytes: "OTMCL", layout version, module type number (2), generation (2), 4 zero bytes, CRC (2).
constexpr std::uint8_t magic[] = {'O', 'T', 'M', 'C', 'L'};
constexpr std::size_t version_offset = sizeof magic;
constexpr std::size_t type_offset = version_offset + 1;
constexpr std::size_t generation_offset = type_offset + 2;
constexpr std::size_t header_crc_offset = layout::header_size - 2;

// Record bytes: slot, value (4), CRC (2) over generation, sequence and the five bytes before, sequence. The sequence is
// last because some torn records have a right CRC by chance: they still have the old sequence.
constexpr std::size_t slot_offset = 0;
constexpr std::size_t value_offset = 1;
constexpr std::size_t record_crc_offset = 5;
constexpr std::size_t sequence_offset = 7;

constexpr void put_uint16(std::uint8_t* bytes, std::uint16_t value) {
  bytes[0] = static_cast<std::uint8_t>(value >> 8);
  bytes[1] = static_cast<std::uint8_t>(value);
}
constexpr std::uint16_t get_uint16(const std::uint8_t* bytes) {
  return static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
}

constexpr bool is_header(const std::uint8_t* header, std::uint16_t type_number) {
  for (std::size_t i = 0; i < sizeof magic; ++i) {
    if (header[i] != magic[i]) return false;
  }
  return header[version_offset] == layout::version && get_uint16(header + type_offset) == type_number &&
         get_uint16(header + header_crc_offset) == crc16(header, header_crc_offset);
}

}  // namespace

void ParameterStore::set_bit(Bits& bits, std::uint8_t slot, bool value) {
  const auto mask = static_cast<std::uint8_t>(1U << slot % 8);
  if (value) {
    bits[slot / 8] = static_cast<std::uint8_t>(bits[slot / 8] | mask);
  } else {
    bits[slot / 8] = static_cast<std::uint8_t>(bits[slot / 8] & ~mask);
  }
}

bool ParameterStore::load_header() {
  bool found = false;
  for (unsigned copy = 0; copy < 2; ++copy) {
    std::uint8_t header[layout::header_size];
    eeprom_.read(layout::header_copies[copy], header, sizeof header);
    if (!is_header(header, module_.type_number)) continue;
    const std::uint16_t generation = get_uint16(header + generation_offset);
    if (found && !is_newer(generation, generation_)) continue;
    found = true;
    generation_ = generation;
    header_copy_ = static_cast<std::uint8_t>(1 - copy);
  }
  return found;
}

void ParameterStore::load() {
  for (std::uint8_t& bits : held_) bits = 0;
  for (std::uint8_t& bits : dirty_) bits = 0;
  dirty_count_ = 0;
  header_dirty_ = false;
  if (!load_header()) {
    // Records of whatever was here before must not come to life again: take a generation that neither header has.
    std::uint8_t foreign[2][layout::header_size];
    for (unsigned copy = 0; copy < 2; ++copy) {
      eeprom_.read(layout::header_copies[copy], foreign[copy], sizeof foreign[copy]);
    }
    generation_ = static_cast<std::uint16_t>(get_uint16(foreign[0] + generation_offset) + 1);
    if (generation_ == get_uint16(foreign[1] + generation_offset)) ++generation_;
    header_copy_ = 0;
    header_dirty_ = true;
    return;
  }
  for (std::uint8_t slot = 0; slot < layout::slot_count; ++slot) load_record(slot);
}

std::uint16_t ParameterStore::record_crc(const std::uint8_t* record) const {
  std::uint8_t first[3];
  put_uint16(first, generation_);
  first[2] = record[sequence_offset];
  return crc16(record, record_crc_offset, crc16(first, sizeof first));
}

bool ParameterStore::read_record(std::uint8_t slot, unsigned copy, std::uint8_t& sequence, std::int32_t& value) {
  std::uint8_t record[layout::record_size];
  eeprom_.read(layout::record_address(slot, copy), record, sizeof record);
  if (record[slot_offset] != slot || get_uint16(record + record_crc_offset) != record_crc(record)) return false;
  sequence = record[sequence_offset];
  value = get_int32(record + value_offset);
  return true;
}

void ParameterStore::load_record(std::uint8_t slot) {
  std::uint8_t sequences[2];
  std::int32_t values[2];
  const bool valid[2] = {read_record(slot, 0, sequences[0], values[0]), read_record(slot, 1, sequences[1], values[1])};
  if (!valid[0] && !valid[1]) return;
  const bool second = valid[1] && (!valid[0] || is_newer(sequences[1], sequences[0]));
  values_[slot] = values[second ? 1 : 0];
  set_bit(held_, slot, true);
}

void ParameterStore::store(std::uint8_t slot, std::int32_t value) {
  if (holds(slot) && values_[slot] == value) return;  // saves wear
  values_[slot] = value;
  set_bit(held_, slot, true);
  if (!bit(dirty_, slot)) {
    set_bit(dirty_, slot, true);
    ++dirty_count_;
  }
}

void ParameterStore::restore_factory_settings() {
  for (std::uint8_t& bits : held_) bits = 0;
  for (std::uint8_t& bits : dirty_) bits = 0;
  dirty_count_ = 0;
  ++generation_;
  header_dirty_ = true;
}

void ParameterStore::write_header() {
  std::uint8_t header[layout::header_size] = {};
  for (std::size_t i = 0; i < sizeof magic; ++i) header[i] = magic[i];
  header[version_offset] = layout::version;
  put_uint16(header + type_offset, module_.type_number);
  put_uint16(header + generation_offset, generation_);
  put_uint16(header + header_crc_offset, crc16(header, header_crc_offset));
  eeprom_.write_page(layout::header_copies[header_copy_], header, sizeof header);
  header_copy_ = static_cast<std::uint8_t>(1 - header_copy_);
}

/// Overwrites the older copy, so that the newer one stays valid until the new record is whole.
void ParameterStore::write_record(std::uint8_t slot) {
  std::uint8_t sequences[2];
  std::int32_t values[2];
  const bool valid[2] = {read_record(slot, 0, sequences[0], values[0]), read_record(slot, 1, sequences[1], values[1])};
  unsigned newest = 1;
  if (valid[0]) newest = valid[1] && is_newer(sequences[1], sequences[0]) ? 1 : 0;
  const std::uint8_t sequence = valid[newest] ? sequences[newest] : 0;

  std::uint8_t record[layout::record_size];
  record[sequence_offset] = static_cast<std::uint8_t>(sequence + 1);
  record[slot_offset] = slot;
  put_int32(record + value_offset, values_[slot]);
  put_uint16(record + record_crc_offset, record_crc(record));
  eeprom_.write_page(layout::record_address(slot, 1 - newest), record, sizeof record);
}

void ParameterStore::write_dirty(std::uint8_t slot) {
  set_bit(dirty_, slot, false);
  --dirty_count_;
  write_record(slot);
}

bool ParameterStore::write_first(std::uint8_t slot) {
  if (!bit(dirty_, slot)) return false;
  write_dirty(slot);
  return true;
}

Microseconds ParameterStore::write_next(Microseconds now) {
  if (eeprom_.busy()) return now + poll_period;
  if (header_dirty_) {
    header_dirty_ = false;
    write_header();
  } else {
    while (!bit(dirty_, next_slot_)) next_slot_ = static_cast<std::uint8_t>((next_slot_ + 1) % layout::slot_count);
    write_dirty(next_slot_);
  }
  return is_written() ? never : now + poll_period;
}

}  // namespace opentmcl
