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

  /// Queues bytes for sending; never waits. A TMCL reply is 9 bytes, in ASCII mode up to 19
  /// after an echo of up to 65: a transmit buffer of 128 is ample.
  virtual void write(const std::uint8_t* data, std::size_t length) = 0;

  /// The firmware expects lines of text from now on, or whole datagrams again. Only for ports that gather the bytes of
  /// a datagram before they hand it over; a line that passes each byte as it comes need not care.
  virtual void set_text_mode(bool) {}

 protected:
  ~BytePort() = default;
};

}  // namespace opentmcl::hal
