#include "server/rs485_line.hpp"

#include <algorithm>

#include "firmware/wire/datagram.hpp"

namespace opentmcl::server {

namespace {

Microseconds rounded_up(twin::Tick ticks) {
  return (ticks + twin::ticks_per_microsecond - 1) / twin::ticks_per_microsecond;
}

}  // namespace

Rs485Line::Rs485Line(RequestPort& host, std::uint32_t baud_rate)
    : host_(host), bus_(baud_rate), host_end_(bus_.connect()) {}

Microseconds Rs485Line::line_is_free_at() const {
  if (!is_waiting_for_reply_) return silent_since_;
  // Of what begins at the end of the silence the first byte is heard a byte later.
  return silent_since_ + silence_without_reply + rounded_up(2 * bus_.byte_duration());
}

Microseconds Rs485Line::next_turn() const {
  if (is_woken_) return now();
  Microseconds next = bus_.is_idle() ? never : rounded_up(bus_.next_arrival());
  if (host_.size() > 0) next = std::min(next, line_is_free_at());
  for (const VirtualModule* module : modules_) next = std::min(next, module->next_turn());
  return next;
}

void Rs485Line::advance_to(Microseconds time) {
  for (Microseconds next = next_turn(); next <= time; next = next_turn()) {
    move_to(std::max(next, now()));
    if (is_woken_) take_turn();
    speak();
  }
  move_to(std::max(time, now()));
}

void Rs485Line::move_to(Microseconds time) {
  const bool is_heard = bus_.advance_to(time * twin::ticks_per_microsecond);
  for (VirtualModule* module : modules_) module->advance_to(time);
  if (!is_heard) return;
  hear();
  take_turn();
}

void Rs485Line::take_turn() {
  is_woken_ = false;
  for (VirtualModule* module : modules_) {
    module->wake();
    module->advance_to(now());
  }
}

void Rs485Line::hear() {
  std::uint8_t bytes[64];
  const std::size_t count = host_end_.read(bytes, sizeof bytes);
  if (count == 0) return;
  host_.write(bytes, count);
  heard_ += count;
  silent_since_ = now();
  if (heard_ >= datagram_size) is_waiting_for_reply_ = false;
}

void Rs485Line::speak() {
  if (host_.size() == 0 || now() < line_is_free_at()) return;
  std::uint8_t request[datagram_size];
  const std::size_t length = host_.read(request, sizeof request);
  host_end_.write(request, length);
  silent_since_ = now() + rounded_up(length * bus_.byte_duration());
  heard_ = 0;
  is_waiting_for_reply_ = true;
}

}  // namespace opentmcl::server
