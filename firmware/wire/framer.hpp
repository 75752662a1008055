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
    if (is_complete()) reset();
    *room(now) = byte;
    return filled(1, now);
  }

  /// Where bytes that arrive at `now` belong: up to missing() of them. What came is told to filled().
  std::uint8_t* room(Microseconds now) {
    if (now > expires_) count_ = 0;
    return datagram_.bytes + count_;
  }

  /// Bytes that the datagram needs to be complete; ask after room().
  std::size_t missing() const { return datagram_size - count_; }

  /// `count` bytes that arrived at `now` were put into room(now); true when the datagram is complete.
  bool filled(std::size_t count, Microseconds now) {
    if (count != 0) {
      count_ += count;
      // Complete, it may wait as long as it takes.
      expires_ = is_complete() ? never : now + gap;
    }
    return is_complete();
  }

  /// A complete datagram stays until the next push() or reset().
  bool is_complete() const { return count_ == datagram_size; }
  const Datagram& datagram() const { return datagram_; }

  /// Forgets the datagram, complete or not.
  void reset() { count_ = 0; }

 private:
  Datagram datagram_;
  std::size_t count_ = 0;
  Microseconds expires_ = never;  ///< later than this the bytes of an unfinished datagram are dropped
};

}  // namespace opentmcl
