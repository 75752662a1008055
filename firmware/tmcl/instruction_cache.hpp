#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/tmcl/dispatch.hpp"

namespace opentmcl {

/// Instructions of the program that were executed lately, decoded, so that a loop neither reads the EEPROM nor checks
/// its operands again. A program up to `line_count` long is in it as a whole after one pass, and runs on while a page
/// of the EEPROM is written. Direct mapped: an instruction has one place, the low byte of its address.
class InstructionCache {
 public:
  static constexpr std::size_t line_count = 256;

  InstructionCache() { clear(); }

  /// @return the instruction if it is here and has Reach::program, else nullptr: the question asked most often has the
  ///         shortest answer
  const DecodedInstruction* find_contained(std::uint16_t address) const {
    const std::uint8_t line = line_of(address);
    return tags_[line] == page_of(address) ? &lines_[line] : nullptr;
  }

  /// @return the instruction if it is here, else nullptr
  const DecodedInstruction* find(std::uint16_t address) const {
    const std::uint8_t line = line_of(address);
    return (tags_[line] & ~reaches_module) == page_of(address) ? &lines_[line] : nullptr;
  }

  /// Keeps an instruction in place of the one that was there. @return where it is, until the next insert()
  const DecodedInstruction* insert(std::uint16_t address, const DecodedInstruction& instruction, Reach reach) {
    const std::uint8_t line = line_of(address);
    lines_[line] = instruction;
    tags_[line] = static_cast<std::uint8_t>(page_of(address) | (reach == Reach::module ? reaches_module : 0));
    return &lines_[line];
  }

  /// The instruction in the memory is another one now.
  void forget(std::uint16_t address) { tags_[line_of(address)] = empty; }
  void clear() {
    for (std::uint8_t& tag : tags_) tag = empty;
  }

 private:
  // A tag is the high byte of the address, which stays far below 0x7f.
  static constexpr std::uint8_t empty = 0x7f;
  static constexpr std::uint8_t reaches_module = 0x80;

  static std::uint8_t line_of(std::uint16_t address) { return static_cast<std::uint8_t>(address); }
  static std::uint8_t page_of(std::uint16_t address) { return static_cast<std::uint8_t>(address >> 8); }

  DecodedInstruction lines_[line_count];
  std::uint8_t tags_[line_count];
};

}  // namespace opentmcl
