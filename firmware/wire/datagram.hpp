// The 9-byte datagrams of RS232, RS485 and USB. Source: PD-1161 manual 3.1 and 3.2.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/status_codes.hpp"

namespace opentmcl {

inline constexpr std::size_t datagram_size = 9;

/// What an instruction says, however it came: serial, CAN, ASCII or program memory.
struct Command {
  std::uint8_t opcode = 0;
  std::uint8_t type = 0;
  std::uint8_t motor = 0;  ///< motor or bank
  std::int32_t value = 0;

  friend constexpr bool operator==(const Command&, const Command&) = default;
};

struct Request {
  std::uint8_t address = 0;
  Command command;

  friend constexpr bool operator==(const Request&, const Request&) = default;
};

struct Reply {
  std::uint8_t host_address = 0;
  std::uint8_t module_address = 0;
  Status status = Status::ok;
  std::uint8_t opcode = 0;
  std::int32_t value = 0;

  friend constexpr bool operator==(const Reply&, const Reply&) = default;
};

/// Low byte of the sum of the first eight bytes.
constexpr std::uint8_t checksum_of(const std::uint8_t* bytes) {
  std::uint8_t sum = 0;
  for (std::size_t i = 0; i + 1 < datagram_size; ++i) sum = static_cast<std::uint8_t>(sum + bytes[i]);
  return sum;
}

constexpr void put_int32(std::uint8_t* bytes, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  bytes[0] = static_cast<std::uint8_t>(bits >> 24);
  bytes[1] = static_cast<std::uint8_t>(bits >> 16);
  bytes[2] = static_cast<std::uint8_t>(bits >> 8);
  bytes[3] = static_cast<std::uint8_t>(bits);
}

constexpr std::int32_t get_int32(const std::uint8_t* bytes) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(bytes[0]) << 24 |
                                   static_cast<std::uint32_t>(bytes[1]) << 16 |
                                   static_cast<std::uint32_t>(bytes[2]) << 8 | static_cast<std::uint32_t>(bytes[3]));
}

/// Nine bytes on the wire, most significant byte of the value first.
struct Datagram {
  std::uint8_t bytes[datagram_size] = {};

  constexpr bool checksum_is_right() const { return bytes[8] == checksum_of(bytes); }
  constexpr void seal() { bytes[8] = checksum_of(bytes); }

  friend constexpr bool operator==(const Datagram&, const Datagram&) = default;
};

constexpr Datagram encode(const Request& request) {
  Datagram datagram;
  datagram.bytes[0] = request.address;
  datagram.bytes[1] = request.command.opcode;
  datagram.bytes[2] = request.command.type;
  datagram.bytes[3] = request.command.motor;
  put_int32(datagram.bytes + 4, request.command.value);
  datagram.seal();
  return datagram;
}

constexpr void encode(const Reply& reply, Datagram& datagram) {
  datagram.bytes[0] = reply.host_address;
  datagram.bytes[1] = reply.module_address;
  datagram.bytes[2] = static_cast<std::uint8_t>(reply.status);
  datagram.bytes[3] = reply.opcode;
  put_int32(datagram.bytes + 4, reply.value);
  datagram.seal();
}

constexpr Datagram encode(const Reply& reply) {
  Datagram datagram;
  encode(reply, datagram);
  return datagram;
}

/// The checksum is not looked at here: ask Datagram::checksum_is_right() first.
constexpr Request decode_request(const Datagram& datagram) {
  return {datagram.bytes[0], {datagram.bytes[1], datagram.bytes[2], datagram.bytes[3], get_int32(datagram.bytes + 4)}};
}

constexpr Reply decode_reply(const Datagram& datagram) {
  return {datagram.bytes[0], datagram.bytes[1], static_cast<Status>(datagram.bytes[2]), datagram.bytes[3],
          get_int32(datagram.bytes + 4)};
}

}  // namespace opentmcl
