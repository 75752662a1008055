#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/hal.hpp"
#include "firmware/param/global_parameter_access.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl {

/// A port on a bus: a reply leaves when the telegram pause (global parameter 75) is over, and nothing is read before.
/// With no pause to keep it is just the port.
class PausingPort final : public hal::BytePort {
 public:
  /// @param parameters the pause, which may change at any time
  void begin(hal::BytePort& port, const GlobalParameterAccess& parameters) {
    port_ = &port;
    parameters_ = &parameters;
  }

  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override;

  /// @param data one reply; there must be none that waits. While has_reply(), poll() has to be called, first in this
  /// turn
  void write(const std::uint8_t* data, std::size_t length) override;

  /// A reply waits.
  bool has_reply() const { return state_ != State::empty; }

  /// Sends the reply when it is time. @return when to call again
  Microseconds poll(Microseconds now);

 private:
  /// The pause begins with the first poll() after the reply was written, which is in the same turn.
  enum class State : std::uint8_t { empty, new_reply, pausing };

  hal::BytePort* port_ = nullptr;
  const GlobalParameterAccess* parameters_ = nullptr;
  Microseconds reply_due_ = 0;
  Datagram reply_;
  State state_ = State::empty;
};

}  // namespace opentmcl
