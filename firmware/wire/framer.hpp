#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/time.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

/// Cuts a stream of bytes into datagrams. Nothing in the stream marks a beginning: as in every TMCL node, alignment
/// is recovered by silence alone (docs/decisions/0002-framing.md).
class Framer {
 public:
  /// Bytes of an unfinished datagram are dropped when the next byte comes later than this.
  static constexpr Microseconds gap = 5000;

  /// Takes one byte that arrived at `now`; true when it completed a datagram.
  bool push(std::uint8_t byte, Microseconds now) {
    if (now - last_byte_ > gap) count_ = 0;
    last_byte_ = now;
    datagram_.bytes[count_++] = byte;
    if (count_ < datagram_size) return false;
    count_ = 0;
    return true;
  }

  /// The datagram push() completed; valid until the next push().
  const Datagram& datagram() const { return datagram_; }

  /// True between datagrams.
  bool is_aligned(Microseconds now) const { return count_ == 0 || now - last_byte_ > gap; }

  /// Forgets the bytes of an unfinished datagram.
  void reset() { count_ = 0; }

 private:
  Datagram datagram_;
  std::size_t count_ = 0;
  Microseconds last_byte_ = 0;
};

}  // namespace opentmcl
