// A CAN frame as python-can's UDP multicast bus sends it: a MessagePack map of the fields of its class Message.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware/hal/can_port.hpp"

namespace opentmcl::server {

/// @param timestamp seconds since 1970
std::vector<std::uint8_t> encode_udp_can_frame(const hal::CanFrame& frame, double timestamp);

/// @return nothing when the packet is no data frame of classical CAN: remote, error and FD frames, and nonsense
std::optional<hal::CanFrame> decode_udp_can_frame(std::span<const std::uint8_t> packet);

}  // namespace opentmcl::server
