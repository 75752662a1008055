#include "boards/twin/paced_port.hpp"

#include <algorithm>

#include "firmware/module/module.hpp"

namespace opentmcl {

namespace {

constexpr twin::Tick ticks_per_second = 1'000'000 * twin::ticks_per_microsecond;

/// The whole microsecond in which `tick` is over.
Microseconds rounded_up(twin::Tick tick) {
  return (tick + twin::ticks_per_microsecond - 1) / twin::ticks_per_microsecond;
}

}  // namespace

PacedPort::PacedPort(hal::BytePort& host, hal::PortKind kind, std::uint32_t baud_rate)
    : host_(host),
      kind_(kind),
      baud_rate_(baud_rate),
      byte_duration_((ticks_per_second * bits_per_byte + baud_rate / 2) / baud_rate) {}

void PacedPort::connect(VirtualModule& module) {
  module_ = &module;
  module.add_actor(*this);
}

twin::Tick PacedPort::now() const {
  return module_->world().now();
}

bool PacedPort::is_understood() const {
  return kind_ != hal::PortKind::rs485 || module_->module().rs485_baud_rate() == baud_rate_;
}

void PacedPort::take_from_host() {
  if (to_module_.is_under_way() || (to_host_.is_under_way() && !is_text_)) return;
  std::uint8_t bytes[16];  // a request of nine bytes, or a piece of a stream
  const std::size_t count = host_.read(bytes, sizeof bytes);
  to_module_.start({bytes, count}, now() + byte_duration_);
}

std::size_t PacedPort::read(std::uint8_t* buffer, std::size_t capacity) {
  if (capacity == 0) return 0;
  if (arrived_.empty()) take_from_host();
  const std::size_t count = std::min(capacity, arrived_.size());
  std::copy_n(arrived_.begin(), count, buffer);
  arrived_.erase(arrived_.begin(), arrived_.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

void PacedPort::write(const std::uint8_t* data, std::size_t length) {
  if (!is_understood()) return;
  if (to_host_.is_under_way()) {
    to_host_.bytes.insert(to_host_.bytes.end(), data, data + length);
  } else {
    to_host_.start({data, length}, now() + byte_duration_);
  }
}

void PacedPort::Train::start(std::span<const std::uint8_t> all, twin::Tick first_end) {
  bytes.assign(all.begin(), all.end());
  passed = 0;
  next_end = first_end;
}

Microseconds PacedPort::next_act() const {
  Microseconds next = never;
  for (const Train* train : {&to_module_, &to_host_}) {
    if (train->is_under_way()) next = std::min(next, rounded_up(train->next_end));
  }
  return next;
}

void PacedPort::act(VirtualModule& module) {
  const auto each_that_has_passed = [this](Train& train, const auto& arrive) {
    for (; train.is_under_way() && train.next_end <= now(); train.next_end += byte_duration_) {
      arrive(train.bytes[train.passed++]);
    }
  };
  each_that_has_passed(to_module_, [this](std::uint8_t byte) {
    if (is_understood()) arrived_.push_back(byte);
  });
  each_that_has_passed(to_host_, [this](std::uint8_t byte) { host_.write(&byte, 1); });
  // The firmware reads what has come, or asks for the next request now that the line is free.
  module.wake();
}

}  // namespace opentmcl
