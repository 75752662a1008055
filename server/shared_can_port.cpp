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
  frames_.erase(frames_.begin());
  return true;
}

void SharedCanPort::write(const hal::CanFrame& frame) {
  answered_ = current_;
  if (current_ != nullptr) current_->send(frame);
}

SharedCanPort& SharedCanBus::connect() {
  connectors_.push_back(std::make_unique<SharedCanPort>());
  return *connectors_.back();
}

void SharedCanBus::push(const hal::CanFrame& frame, CanFrameSink& sender) {
  for (const auto& connector : connectors_) connector->push(frame, sender);
}

void SharedCanBus::forget(const CanFrameSink& sender) {
  for (const auto& connector : connectors_) connector->forget(sender);
}

std::uint32_t SharedCanBus::bit_rate() const {
  return connectors_.empty() ? 0 : connectors_.front()->bit_rate();
}

}  // namespace opentmcl::server
