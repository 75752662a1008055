#include "twin/chip/eeprom.hpp"

#include <algorithm>

namespace opentmcl::twin {
namespace {

constexpr std::array<std::uint8_t, Eeprom::page_size> erased_page = [] {
  std::array<std::uint8_t, Eeprom::page_size> page{};
  for (std::uint8_t& byte : page) byte = Eeprom::erased;
  return page;
}();

}  // namespace

const Eeprom::Content& Eeprom::page(std::size_t number) const {
  const auto place = std::lower_bound(pages_.begin(), pages_.end(), number,
                                      [](const Page& page, std::size_t wanted) { return page.number < wanted; });
  return place != pages_.end() && place->number == number ? place->content : erased_page;
}

Eeprom::Content& Eeprom::page_to_write(std::size_t number) {
  auto place = std::lower_bound(pages_.begin(), pages_.end(), number,
                                [](const Page& page, std::size_t wanted) { return page.number < wanted; });
  if (place == pages_.end() || place->number != number) {
    place = pages_.insert(place, {static_cast<std::uint8_t>(number), erased_page});
  }
  return place->content;
}

void Eeprom::read(std::uint16_t address, std::uint8_t* data, std::size_t length, std::uint64_t clock) const {
  if (busy(clock)) {
    std::fill_n(data, length, erased);
    return;
  }
  for (std::size_t done = 0; done < length;) {
    const std::size_t place = (address + done) % size;
    const std::size_t offset = place % page_size;
    const std::size_t count = std::min(length - done, page_size - offset);
    std::copy_n(page(place / page_size).begin() + static_cast<std::ptrdiff_t>(offset), count, data + done);
    done += count;
  }
}

void Eeprom::write_page(std::uint16_t address, const std::uint8_t* data, std::size_t length, std::uint64_t clock) {
  if (busy(clock)) {
    ++ignored_writes_;
    return;
  }
  if (length > page_size) {
    const std::size_t overwritten = length - page_size;
    data += overwritten;
    address = static_cast<std::uint16_t>(address / page_size * page_size + (address + overwritten) % page_size);
    length = page_size;
  }
  const std::size_t number = address % size / page_size;
  Content content = page(number);
  write_ = Write{clock, address, static_cast<std::uint8_t>(length), content};
  for (std::size_t i = 0; i < length && !power_lost(); ++i) {
    content[(address + i) % page_size] = data[i];
    ++bytes_written_;
    if (bytes_until_power_cut_) --*bytes_until_power_cut_;
  }
  // The firmware erases whole pages; that takes no memory where nothing was.
  if (content != page(number)) page_to_write(number) = content;
}

void Eeprom::lose_power(std::uint64_t clock) {
  if (busy(clock)) {
    Content& content = page_to_write(write_->address % size / page_size);
    const std::uint64_t finished = (clock - write_->begin) * write_->length / page_write_clocks;
    for (std::uint64_t i = finished; i < write_->length; ++i) {
      const std::size_t offset = (write_->address + i) % page_size;
      content[offset] = write_->before[offset];
      ++bytes_written_;
    }
  }
  bytes_until_power_cut_ = 0;
}

void Eeprom::power_up() {
  bytes_until_power_cut_.reset();
  write_.reset();
}

Eeprom::Image Eeprom::image() const {
  Image image{};
  image.fill(erased);
  for (const Page& page : pages_) {
    std::copy(page.content.begin(), page.content.end(), image.begin() + page.number * page_size);
  }
  return image;
}

void Eeprom::load(std::span<const std::uint8_t, size> image) {
  pages_.clear();
  for (std::size_t number = 0; number < size / page_size; ++number) {
    const auto content = image.subspan(number * page_size, page_size);
    if (!std::equal(content.begin(), content.end(), erased_page.begin())) {
      std::copy(content.begin(), content.end(), page_to_write(number).begin());
    }
  }
}

}  // namespace opentmcl::twin
