#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/eeprom.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/param/eeprom_layout.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl {

/// The settings in the EEPROM. What is stored here is what a restart finds: a copy in RAM answers reads at once, and
/// poll() brings it to the EEPROM one record after the other, so that nothing ever waits for a page write. A power cut
/// between any two bytes leaves each setting at its old or its new value.
class ParameterStore {
 public:
  ParameterStore(hal::Eeprom& eeprom, const ModuleDescription& module) : eeprom_(eeprom), module_(module) {}

  /// Reads everything. An EEPROM that is empty, of another module or of another layout version is put into service with
  /// factory settings; its program memory then holds nothing that may be started.
  void load();

  /// @return whether the slot holds a value, and which
  bool holds(std::uint8_t slot) const { return bit(held_, slot); }
  std::int32_t value(std::uint8_t slot) const { return values_[slot]; }

  /// Stores a value: in force for value() at once, in the EEPROM soon.
  void store(std::uint8_t slot, std::int32_t value);

  /// Starts to write the record of one slot before all others, unless it is written; the EEPROM must be free.
  /// @return whether there was something to write
  bool write_first(std::uint8_t slot);

  /// Forgets every setting in one step: the records of the old generation are no longer valid.
  void restore_factory_settings();

  /// Everything stored so far is in the EEPROM, or being written as the last page.
  bool is_written() const { return dirty_count_ == 0 && !header_dirty_; }

  /// Starts the next page write when the EEPROM is free. @return when to call again, or never
  Microseconds poll(Microseconds now) { return is_written() ? never : write_next(now); }

  /// How often poll() looks whether a page write is over.
  static constexpr Microseconds poll_period = 500;

 private:
  using Bits = std::uint8_t[(eeprom_layout::slot_count + 7) / 8];
  static bool bit(const Bits& bits, std::uint8_t slot) { return (bits[slot / 8] >> slot % 8 & 1) != 0; }
  static void set_bit(Bits& bits, std::uint8_t slot, bool value);

  Microseconds write_next(Microseconds now);
  bool load_header();
  void load_record(std::uint8_t slot);
  bool read_record(std::uint8_t slot, unsigned copy, std::uint8_t& sequence, std::int32_t& value);
  void write_header();
  void write_record(std::uint8_t slot);
  void write_dirty(std::uint8_t slot);
  std::uint16_t record_crc(const std::uint8_t* record) const;

  hal::Eeprom& eeprom_;
  const ModuleDescription& module_;
  std::int32_t values_[eeprom_layout::slot_count] = {};
  Bits held_ = {};
  Bits dirty_ = {};
  std::uint8_t dirty_count_ = 0;
  std::uint8_t next_slot_ = 0;
  std::uint16_t generation_ = 0;
  std::uint8_t header_copy_ = 0;  ///< the one to write next
  bool header_dirty_ = false;
};

}  // namespace opentmcl
