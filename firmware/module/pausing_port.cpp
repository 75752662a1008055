#include "firmware/module/pausing_port.hpp"

namespace opentmcl {

std::size_t PausingPort::read(std::uint8_t* buffer, std::size_t capacity) {
  return has_reply() ? 0 : port_->read(buffer, capacity);
}

void PausingPort::write(const std::uint8_t* data, std::size_t length) {
  if ((*parameters_)[GlobalParameter::telegram_pause_time] == 0) {
    port_->write(data, length);
    return;
  }
  for (std::size_t i = 0; i < datagram_size; ++i) reply_.bytes[i] = data[i];
  state_ = State::new_reply;
}

Microseconds PausingPort::poll(Microseconds now) {
  if (state_ == State::empty) return never;
  if (state_ == State::new_reply) {
    reply_due_ =
        now + static_cast<Microseconds>((*parameters_)[GlobalParameter::telegram_pause_time]) * one_millisecond;
    state_ = State::pausing;
  }
  if (now < reply_due_) return reply_due_;
  state_ = State::empty;
  port_->write(reply_.bytes, datagram_size);
  // What came meanwhile can be read now.
  return now;
}

}  // namespace opentmcl
