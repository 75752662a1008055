#include "server/request_port.hpp"

#include <algorithm>

namespace opentmcl::server {

void RequestPort::push(const Datagram& request, ReplySink& sender) {
  entries_.push_back({request, datagram_size, &sender});
}

void RequestPort::push(std::uint8_t character, ReplySink& sender) {
  entries_.push_back({{{character}}, 1, &sender});
}

void RequestPort::forget(const ReplySink& sender) {
  if (current_ == &sender) current_ = nullptr;
  // The rest of a request that was read in part has to follow; only its sender is unknown from now on.
  auto first = entries_.begin();
  if (offset_ > 0) ++first;
  entries_.erase(std::remove_if(first, entries_.end(), [&](const Entry& entry) { return entry.sender == &sender; }),
                 entries_.end());
}

std::size_t RequestPort::read(std::uint8_t* buffer, std::size_t capacity) {
  // The firmware has no room while a request waits for the EEPROM: it is not done with that one.
  if (entries_.empty() || capacity == 0) return 0;
  const Entry& entry = entries_.front();
  const std::size_t count = std::min(capacity, entry.size - offset_);
  std::copy_n(entry.bytes.bytes + offset_, count, buffer);
  if (offset_ == 0) current_ = entry.sender;
  offset_ += count;
  if (offset_ == entry.size) {
    entries_.pop_front();
    offset_ = 0;
  }
  return count;
}

void RequestPort::write(const std::uint8_t* data, std::size_t length) {
  if (current_ != nullptr) current_->reply({data, length});
}

}  // namespace opentmcl::server
