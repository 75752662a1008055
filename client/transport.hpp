#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "client/error.hpp"

namespace opentmcl::client {

using Duration = std::chrono::microseconds;

/// A connection that carries bytes both ways. Real: a serial port or a TCP connection. In the process: a virtual
/// module, where time passes only while somebody waits. For tests: a script.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Sends all of it, or says why not.
  virtual Result<void> send(std::span<const std::uint8_t> bytes) = 0;

  /// Waits for at least one byte, `limit` at most, and returns how many were put into `buffer`; 0 when the time was up.
  virtual Result<std::size_t> receive(std::span<std::uint8_t> buffer, Duration limit) = 0;

  /// Drops what has arrived and nobody has asked for.
  virtual void drain() = 0;

  /// Lets time pass.
  virtual void pause(Duration duration) = 0;

  /// Time on this connection's own clock, from an arbitrary start; of use as a difference only.
  virtual Duration now() const = 0;

  /// As the user would name it, for messages: "/dev/ttyACM0".
  virtual const std::string& name() const = 0;
};

}  // namespace opentmcl::client
