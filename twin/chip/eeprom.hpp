// The AT25128 EEPROM: 16 KiB in pages of 64 bytes, with the time a page write takes and what a power cut leaves behind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace opentmcl::twin {

/// As a device driver sees it, reads and page writes at a time: instructions, write enable latch, block protection and
/// the rest of the status register belong to the SPI protocol below, which hal::Eeprom hides; of them only "busy" is
/// seen from above.
///
/// Only pages that hold something take memory: a virtual module is to stay small.
class Eeprom {
 public:
  static constexpr std::size_t size = 16384;
  static constexpr std::size_t page_size = 64;
  static constexpr std::uint8_t erased = 0xFF;
  static constexpr std::uint64_t page_write_clocks = 80'000;  ///< 5 ms at 16 MHz, the datasheet's maximum

  using Image = std::array<std::uint8_t, size>;

  /// True for page_write_clocks after a page write. Clocks may count from anywhere, but always go on.
  bool busy(std::uint64_t clock) const { return write_ && clock < write_->begin + page_write_clocks; }

  /// Reads on from `address` and past the end from 0 again; only `erased` comes back while busy.
  void read(std::uint16_t address, std::uint8_t* data, std::size_t length, std::uint64_t clock) const;

  /// Writes within the page of `address`: what would go past its end lands at its beginning, and of more than 64 bytes
  /// the last 64 count. Ignored, and counted by ignored_writes(), while busy.
  void write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length, std::uint64_t clock);

  /// The supply fails at `clock`. A page write in progress leaves a torn page: its bytes are taken to be written one
  /// after the other, evenly over its time, so those whose time was over by then are new and the others old. No write
  /// has an effect until power_up().
  void lose_power(std::uint64_t clock);
  /// The supply fails when `bytes` more bytes have been written, as if at just that time: the write then in progress
  /// stops short and no other one has an effect, until power_up().
  void cut_power_after(std::size_t bytes) { bytes_until_power_cut_ = bytes; }
  bool power_lost() const { return bytes_until_power_cut_ == std::size_t{0}; }
  void power_up();

  /// All bytes; those of a page write in progress are the new ones already.
  Image image() const;
  void load(std::span<const std::uint8_t, size> image);

  /// Bytes written since construction, and torn ones once more: tells whether image() may have changed.
  std::uint64_t bytes_written() const { return bytes_written_; }
  std::uint64_t ignored_writes() const { return ignored_writes_; }
  /// Pages that take memory.
  std::size_t stored_pages() const { return pages_.size(); }

 private:
  using Content = std::array<std::uint8_t, page_size>;

  struct Page {
    std::uint8_t number;
    Content content;
  };

  /// The latest page write.
  struct Write {
    std::uint64_t begin;
    std::uint16_t address;  ///< of the first byte
    std::uint8_t length;    ///< 1…64
    Content before;         ///< of the page
  };

  const Content& page(std::size_t number) const;
  Content& page_to_write(std::size_t number);

  std::vector<Page> pages_;  ///< in the order of their numbers; the others are erased
  std::optional<Write> write_;
  std::optional<std::size_t> bytes_until_power_cut_;
  std::uint64_t bytes_written_ = 0;
  std::uint64_t ignored_writes_ = 0;
};

}  // namespace opentmcl::twin
