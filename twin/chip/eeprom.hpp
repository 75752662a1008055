// The AT25128 EEPROM: 16 KiB in pages of 64 bytes, with the time a page write takes and what a power cut leaves behind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace opentmcl::twin {

class Eeprom {
 public:
  static constexpr std::size_t size = 16384;
  static constexpr std::size_t page_size = 64;
  static constexpr std::uint8_t erased = 0xFF;
  static constexpr std::uint64_t page_write_clocks = 80'000;  ///< 5 ms at 16 MHz, the datasheet's maximum

  Eeprom() { image_.fill(erased); }

  /// True for page_write_clocks after a page write. Clocks count from power-on.
  bool busy(std::uint64_t clock) const { return clock < ready_clock_; }

  /// Reads on from `address` and past the end from 0 again; only `erased` comes back while busy.
  void read(std::uint16_t address, std::uint8_t* data, std::size_t length, std::uint64_t clock) const;

  /// Writes within the page of `address`: what would go past its end lands at its beginning, and of more than 64 bytes
  /// the last 64 count. Ignored, and counted by ignored_writes(), while busy.
  void write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length, std::uint64_t clock);

  /// The supply fails when `bytes` more bytes have been written: the write then in progress stops short and no other
  /// one has an effect, until power_up().
  void cut_power_after(std::size_t bytes) { bytes_until_power_cut_ = bytes; }
  bool power_lost() const { return bytes_until_power_cut_ == std::size_t{0}; }
  void power_up();

  const std::array<std::uint8_t, size>& image() const { return image_; }
  void load(std::span<const std::uint8_t, size> image);

  /// Bytes written since construction: tells whether image() may have changed.
  std::uint64_t bytes_written() const { return bytes_written_; }
  std::uint64_t ignored_writes() const { return ignored_writes_; }

 private:
  std::array<std::uint8_t, size> image_;
  std::uint64_t ready_clock_ = 0;
  std::optional<std::size_t> bytes_until_power_cut_;
  std::uint64_t bytes_written_ = 0;
  std::uint64_t ignored_writes_ = 0;
};

}  // namespace opentmcl::twin
