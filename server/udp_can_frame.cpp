#include "server/udp_can_frame.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace opentmcl::server {

namespace {

using nlohmann::json;

// Names of the fields.
constexpr const char* timestamp_field = "timestamp";
constexpr const char* id_field = "arbitration_id";
constexpr const char* extended_field = "is_extended_id";
constexpr const char* remote_field = "is_remote_frame";
constexpr const char* error_field = "is_error_frame";
constexpr const char* channel_field = "channel";
constexpr const char* length_field = "dlc";
constexpr const char* data_field = "data";
constexpr const char* fd_field = "is_fd";
constexpr const char* bit_rate_switch_field = "bitrate_switch";
constexpr const char* error_state_field = "error_state_indicator";

bool is_true(const json& message, const char* field) {
  const auto found = message.find(field);
  return found != message.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

std::vector<std::uint8_t> encode_udp_can_frame(const hal::CanFrame& frame, double timestamp) {
  const json message{{timestamp_field, timestamp},
                     {id_field, frame.id},
                     {extended_field, frame.is_extended},
                     {remote_field, false},
                     {error_field, false},
                     {channel_field, nullptr},
                     {length_field, frame.length},
                     {data_field, json::binary({frame.data, frame.data + frame.length})},
                     {fd_field, false},
                     {bit_rate_switch_field, false},
                     {error_state_field, false}};
  return json::to_msgpack(message);
}

std::optional<hal::CanFrame> decode_udp_can_frame(std::span<const std::uint8_t> packet) {
  constexpr bool complete = true;
  constexpr bool throws = false;
  const json message = json::from_msgpack(packet.begin(), packet.end(), complete, throws);
  if (!message.is_object()) return std::nullopt;
  if (is_true(message, remote_field) || is_true(message, error_field) || is_true(message, fd_field)) {
    return std::nullopt;
  }
  const auto id = message.find(id_field);
  const auto data = message.find(data_field);
  if (id == message.end() || !id->is_number_unsigned() || data == message.end() || !data->is_binary()) {
    return std::nullopt;
  }
  hal::CanFrame frame;
  frame.is_extended = is_true(message, extended_field);
  const auto highest_id = frame.is_extended ? std::uint64_t{0x1FFF'FFFF} : std::uint64_t{0x7FF};
  const auto& bytes = data->get_binary();
  if (id->get<std::uint64_t>() > highest_id || bytes.size() > sizeof frame.data) return std::nullopt;
  frame.id = id->get<std::uint32_t>();
  frame.length = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data);
  return frame;
}

}  // namespace opentmcl::server
