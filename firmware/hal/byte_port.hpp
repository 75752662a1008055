#pragma once

#include <cstddef>
#include <cstdint>

namespace opentmcl::hal {

/// A serial line: UART with RS485 transceiver, RS232 or USB CDC. On silicon a pair of ring buffers that interrupts
/// fill and drain; in the twin a pty, a TCP connection or a test.
class BytePort {
 public:
  /// Moves up to `capacity` received bytes into `buffer` and returns how many there were; never waits. Fewer than
  /// `capacity` means that there are no more at present.
  virtual std::size_t read(std::uint8_t* buffer, std::size_t capacity) = 0;

  /// Queues bytes for sending; never waits. A TMCL reply is 9 bytes, so a transmit buffer of 64 is ample.
  virtual void write(const std::uint8_t* data, std::size_t length) = 0;

 protected:
  ~BytePort() = default;
};

}  // namespace opentmcl::hal
