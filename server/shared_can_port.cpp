#include "server/shared_can_port.hpp"

#include <algorithm>

namespace opentmcl::server {

void SharedCanPort::forget(const CanFrameSink& sender) {
  if (current_ == &sender) current_ = nullptr;
  if (answered_ == &sender) answered_ = nullptr;
  frames_.erase(
      std::remove_if(frames_.begin(), frames_.end(), [&sender](const Entry& entry) { return entry.sender == &sender; }),
      frames_.end());
}

bool SharedCanPort::read(hal::CanFrame& frame) {
  if (frames_.empty()) {
    current_ = answered_;
    return false;
  }
  frame = frames_.front().frame;
  current_ = frames_.front().sender;
  frames_.pop_front();
  return true;
}

void SharedCanPort::write(const hal::CanFrame& frame) {
  answered_ = current_;
  if (current_ != nullptr) current_->send(frame);
}

}  // namespace opentmcl::server
