#include "firmware/module/can_line.hpp"

#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

namespace {

constexpr std::uint8_t shortest_request = 7;
constexpr std::uint8_t longest_request = 8;

constexpr bool wants_version_text(const hal::CanFrame& request) {
  constexpr std::uint8_t as_text = 0;
  return request.data[0] == static_cast<std::uint8_t>(Opcode::get_firmware_version) && request.data[1] == as_text;
}

}  // namespace

void CanLine::join() {
  port_->join(can_bit_rates[setting(GlobalParameter::can_bit_rate)]);
}

bool CanLine::is_request(const hal::CanFrame& frame, std::uint8_t& recipient) const {
  if (frame.length < shortest_request || frame.length > longest_request) return false;
  if (frame.id == setting(GlobalParameter::can_id)) {
    recipient = to_module;
    return true;
  }
  const std::uint32_t group = setting(GlobalParameter::can_secondary_id);
  recipient = to_group;
  return group != 0 && frame.id == group;
}

std::size_t CanLine::read(std::uint8_t* buffer, std::size_t capacity) {
  if (capacity < datagram_size) return 0;
  hal::CanFrame frame;
  Datagram datagram;
  while (port_->read(frame)) {
    if (!is_request(frame, datagram.bytes[0])) continue;
    is_extended_ = frame.is_extended;
    length_ = frame.length;
    wants_text_ = wants_version_text(frame);
    for (std::size_t i = 0; i < shortest_request; ++i) datagram.bytes[1 + i] = frame.data[i];
    datagram.seal();
    for (std::size_t i = 0; i < datagram_size; ++i) buffer[i] = datagram.bytes[i];
    return datagram_size;
  }
  return 0;
}

void CanLine::write(const std::uint8_t* data, std::size_t) {
  hal::CanFrame frame;
  frame.id = setting(GlobalParameter::can_reply_id);
  frame.is_extended = is_extended_;
  frame.length = length_;
  for (std::size_t i = 0; i < shortest_request; ++i) frame.data[i] = data[1 + i];
  // A checksum has no place on CAN.
  if (wants_text_) frame.data[7] = data[8];
  wants_text_ = false;
  port_->write(frame);
}

}  // namespace opentmcl
