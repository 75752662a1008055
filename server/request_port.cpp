#include "server/request_port.hpp"

#include <algorithm>

namespace opentmcl::server {

void RequestPort::push(const Datagram& request, ReplySink& sender) {
  requests_.push_back({request, &sender});
}

void RequestPort::forget(const ReplySink& sender) {
  if (current_ == &sender) current_ = nullptr;
  // The rest of a request that was read in part has to follow; only its sender is unknown from now on.
  auto first = requests_.begin();
  if (offset_ > 0) ++first;
  requests_.erase(std::remove_if(first, requests_.end(), [&](const Entry& entry) { return entry.sender == &sender; }),
                  requests_.end());
}

std::size_t RequestPort::read(std::uint8_t* buffer, std::size_t capacity) {
  // The firmware has no room while a request waits for the EEPROM: it is not done with that one.
  if (requests_.empty() || capacity == 0) return 0;
  const Entry& entry = requests_.front();
  const std::size_t count = std::min(capacity, datagram_size - offset_);
  std::copy_n(entry.request.bytes + offset_, count, buffer);
  if (offset_ == 0) current_ = entry.sender;
  offset_ += count;
  if (offset_ == datagram_size) {
    requests_.pop_front();
    offset_ = 0;
  }
  return count;
}

void RequestPort::write(const std::uint8_t* data, std::size_t length) {
  if (current_ != nullptr) current_->reply({data, length});
}

}  // namespace opentmcl::server
