#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/eeprom.hpp"
#include "firmware/param/eeprom_layout.hpp"
#include "firmware/param/parameter_store.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/tmcl/dispatch.hpp"
#include "firmware/tmcl/instruction_cache.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

/// The TMCL program in the EEPROM, seven bytes an instruction. Whether it is whole is a record of the parameter store:
/// a download that never ended leaves a program that is not started by itself.
class ProgramMemory {
 public:
  /// What an access comes to.
  enum class Access : std::uint8_t {
    done,
    busy,  ///< a page write is in progress: try again on the next turn
  };

  ProgramMemory(hal::Eeprom& eeprom, ParameterStore& store, const ModuleDescription& module)
      : eeprom_(eeprom),
        store_(store),
        dispatch_(dispatch_tables[static_cast<std::size_t>(module.id)]),
        capacity_(module.program_capacity) {}

  std::uint16_t capacity() const { return capacity_; }

  /// True after a download that came to its end.
  bool is_complete() const;

  /// Marks the program as incomplete; the mark reaches the EEPROM before any instruction does.
  void begin_download();

  /// Stores one instruction. @param address less than capacity()
  Access write(std::uint16_t address, const Command& instruction);

  /// Writes what is left in the buffer and marks the program as complete.
  Access end_download();

  /// Overwrites the whole memory, in the background: until that is done every access is busy. Only the mark that the
  /// program is incomplete is written before; no other setting may be, for it could lift the program's protection.
  void erase();
  bool is_erasing() const { return erase_page_ != 0; }

  /// Moves erase() on. @return when to call again, or never
  Microseconds poll(Microseconds now) { return is_erasing() ? erase_next(now) : never; }

  /// @param address less than capacity()
  Access read(std::uint16_t address, Command& instruction);

  /// The instruction at an address, to be executed. @param address less than capacity()
  /// @return valid until the next call, or nullptr when it is not in the cache and the EEPROM is busy
  const DecodedInstruction* fetch(std::uint16_t address) {
    const DecodedInstruction* const cached = cache_.find(address);
    return cached != nullptr ? cached : fetch_from_eeprom(address);
  }
  /// The same for an instruction that is in the cache and has Reach::program; nullptr for all others.
  const DecodedInstruction* fetch_contained(std::uint16_t address) const { return cache_.find_contained(address); }

 private:
  enum State : std::int32_t { incomplete = 0, complete = 1 };

  Microseconds erase_next(Microseconds now);
  bool flush_page();
  const DecodedInstruction* fetch_from_eeprom(std::uint16_t address);

  hal::Eeprom& eeprom_;
  ParameterStore& store_;
  const DispatchTable& dispatch_;
  std::uint16_t capacity_;
  /// Bytes that are not written yet: `pending_` of them, from EEPROM address `pending_address_` on. They may run over
  /// the end of their page by less than an instruction.
  std::uint8_t buffer_[hal::Eeprom::page_size + eeprom_layout::instruction_size] = {};
  std::uint16_t pending_address_ = 0;
  std::uint8_t pending_ = 0;
  std::uint16_t erase_page_ = 0;  ///< EEPROM address of the next page to erase, 0 when not erasing
  InstructionCache cache_;
};

}  // namespace opentmcl
