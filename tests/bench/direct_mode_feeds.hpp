// The ways a command reaches the module, and a pass over the mix by one of them.
#pragma once

#include "tests/bench/direct_mode_boards.hpp"
#include "tests/bench/direct_mode_mix.hpp"

namespace opentmcl::bench {

/// Module::handle(): a datagram in, a datagram out, nothing of port, framing and main loop.
struct Handle {
  template <class Board>
  static void exchange(Board& board, const Datagram& request) {
    Datagram reply;
    board.module().handle(request, hal::PortKind::usb, board.now(), reply);
    board.port().write(reply.bytes, datagram_size);
  }
};

/// One turn of the main loop finds all nine bytes at the port, as with USB.
struct WholeDatagram {
  template <class Board>
  static void exchange(Board& board, const Datagram& request) {
    board.port().send(request);
    board.module().poll(board.now());
  }
};

/// Nine turns of the main loop find one byte each, as with RS485; the last of them replies.
struct ByteByByte {
  template <class Board>
  static void exchange(Board& board, const Datagram& request) {
    for (const std::uint8_t byte : request.bytes) {
      board.port().send(byte);
      board.module().poll(board.now());
    }
  }
};

/// The requests of the mix, encoded once: what the host does to make them is not measured.
class MixRequests {
 public:
  MixRequests() {
    for (std::size_t i = 0; i < direct_mode_mix_size; ++i)
      requests_[i] = encode(Request{1, direct_mode_mix[i].command});
  }

  const Datagram& operator[](std::size_t index) const { return requests_[index]; }

 private:
  Datagram requests_[direct_mode_mix_size];
};

/// Starts the module and sends each command of the mix once, so that what happens only the first time is over.
/// @return the first command that is not answered as it should be, or nullptr
template <class Feed, class Board>
const MixedCommand* warm_up(Board& board, const MixRequests& requests) {
  constexpr int turns_to_start = 16;  // start, and the header of a new EEPROM
  for (int turn = 0; turn < turns_to_start; ++turn) board.module().poll(board.now());
  for (std::size_t i = 0; i < direct_mode_mix_size; ++i) {
    Feed::exchange(board, requests[i]);
    const Reply reply = decode_reply(board.port().reply());
    const bool is_whole = board.port().reply().checksum_is_right() && reply.opcode == direct_mode_mix[i].command.opcode;
    if (!is_whole || reply.status != direct_mode_mix[i].expected) return &direct_mode_mix[i];
  }
  return nullptr;
}

}  // namespace opentmcl::bench
