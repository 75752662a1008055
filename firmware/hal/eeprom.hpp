#pragma once

#include <cstddef>
#include <cstdint>

namespace opentmcl::hal {

/// The AT25128 of the real boards: 16 KiB, 64-byte pages, a page write takes up to 5 ms during which the chip
/// answers nothing but its status. On silicon: an SPI EEPROM. In the twin: a model that may be kept in a file.
class Eeprom {
 public:
  static constexpr std::size_t size = 16384;
  static constexpr std::size_t page_size = 64;

  /// True while a page write is in progress; neither read() nor write_page() may be called then.
  virtual bool busy() = 0;

  /// Copies `length` bytes from `address` on; address + length must not exceed `size`.
  virtual void read(std::uint16_t address, std::uint8_t* data, std::size_t length) = 0;

  /// Starts to write `length` bytes, all within one page, and returns at once.
  virtual void write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length) = 0;

 protected:
  ~Eeprom() = default;
};

}  // namespace opentmcl::hal
