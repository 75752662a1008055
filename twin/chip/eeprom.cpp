#include "twin/chip/eeprom.hpp"

#include <algorithm>

namespace opentmcl::twin {

void Eeprom::read(std::uint16_t address, std::uint8_t* data, std::size_t length, std::uint64_t clock) const {
  for (std::size_t i = 0; i < length; ++i) {
    data[i] = busy(clock) ? erased : image_[(address + i) % size];
  }
}

void Eeprom::write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length, std::uint64_t clock) {
  if (busy(clock)) {
    ++ignored_writes_;
    return;
  }
  const std::size_t page = address % size / page_size * page_size;
  for (std::size_t i = 0; i < length && !power_lost(); ++i) {
    image_[page + (address + i) % page_size] = data[i];
    ++bytes_written_;
    if (bytes_until_power_cut_) {
      --*bytes_until_power_cut_;
    }
  }
  ready_clock_ = clock + page_write_clocks;
}

void Eeprom::power_up() {
  bytes_until_power_cut_.reset();
  ready_clock_ = 0;
}

void Eeprom::load(std::span<const std::uint8_t, size> image) {
  std::copy(image.begin(), image.end(), image_.begin());
}

}  // namespace opentmcl::twin
