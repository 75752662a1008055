#pragma once

#include <cstdint>
#include <span>

#include "firmware/wire/framer.hpp"
#include "server/request_port.hpp"

namespace opentmcl::server {

/// Cuts what a host sends into requests for a port, or passes it on as it comes while the module expects text.
class RequestCutter {
 public:
  /// @param now when the bytes came, on the clock by which the host's silences count
  /// @return whether the port has anything new for the firmware
  bool take(std::span<const std::uint8_t> bytes, Microseconds now, RequestPort& port, ReplySink& sender) {
    bool has_new = take_rest(port, sender);
    if (port.is_in_text_mode()) {
      for (const std::uint8_t byte : bytes) port.push(byte, sender);
      return true;
    }
    for (const std::uint8_t byte : bytes) {
      if (!framer_.push(byte, now)) continue;
      port.push(framer_.datagram(), sender);
      framer_.reset();
      has_new = true;
    }
    return has_new;
  }

  /// To be asked when the firmware had the opportunity to read. What came in one piece with the command that entered
  /// the ASCII mode was taken for the begin of a request; it is passed on as it is, be it text or, when the text has
  /// left the mode again, part of a request.
  /// @return whether the port has anything new for the firmware
  bool take_rest(RequestPort& port, ReplySink& sender) {
    if (port.mode_changes() == mode_changes_seen_) return false;
    mode_changes_seen_ = port.mode_changes();
    const std::size_t count = datagram_size - framer_.missing();
    for (std::size_t i = 0; i < count; ++i) port.push(framer_.datagram().bytes[i], sender);
    framer_.reset();
    return count > 0;
  }

 private:
  Framer framer_;
  unsigned mode_changes_seen_ = 0;
};

}  // namespace opentmcl::server
