#include "server/request_port.hpp"

#include <algorithm>
#include <utility>

namespace opentmcl::server {

void RequestPort::push(const Datagram& request, ReplySink& sender) {
  entries_.push_back({request, datagram_size, &sender});
}

void RequestPort::push(std::uint8_t character, ReplySink& sender) {
  entries_.push_back({{{character}}, 1, &sender});
}

void RequestPort::forget(const ReplySink& sender) {
  if (current_ == &sender) current_ = nullptr;
  waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), &sender), waiting_.end());
  // The rest of a request that was read in part has to follow; only its sender is unknown from now on.
  auto first = entries_.begin() + static_cast<std::ptrdiff_t>(first_);
  if (offset_ > 0) ++first;
  entries_.erase(std::remove_if(first, entries_.end(), [&](const Entry& entry) { return entry.sender == &sender; }),
                 entries_.end());
}

std::size_t RequestPort::read(std::uint8_t* buffer, std::size_t room) {
  // The firmware has no room while a request waits for the EEPROM: it is not done with that one.
  if (size() == 0 || room == 0) return 0;
  const Entry& entry = entries_[first_];
  const std::size_t count = std::min(room, entry.size - offset_);
  std::copy_n(entry.bytes.bytes + offset_, count, buffer);
  if (offset_ == 0) current_ = entry.sender;
  offset_ += count;
  if (offset_ == entry.size) {
    offset_ = 0;
    drop_first();
  }
  return count;
}

void RequestPort::drop_first() {
  ++first_;
  // Most often that was the only one; in a long queue the front is given back from time to time.
  if (first_ == entries_.size() || first_ >= capacity) {
    entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
  if (waiting_.empty() || size() > capacity / 2) return;
  for (ReplySink* sender : std::exchange(waiting_, {})) sender->room_again();
}

void RequestPort::write(const std::uint8_t* data, std::size_t length) {
  if (current_ != nullptr) current_->reply({data, length});
}

}  // namespace opentmcl::server
