#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/byte_port.hpp"
#include "firmware/hal/can_port.hpp"
#include "firmware/param/global_parameter_access.hpp"

namespace opentmcl {

/// CAN as one more line of a module: what a frame asks is read as a datagram, and the reply to it leaves as a frame.
/// A request has 7 data bytes, which are the middle seven of a datagram, or 8, the last of which does not count; its
/// reply has as many. Frames of another length and to other identifiers are dropped. Source: TMCM-1110 manual V1.03
/// 4.1, docs/decisions/0020-can.md.
class CanLine final : public hal::BytePort {
 public:
  /// To whom a frame went stands in place of the address of the datagram that read() makes of it.
  static constexpr std::uint8_t to_module = 0;  ///< global parameter 71
  static constexpr std::uint8_t to_group = 1;   ///< global parameter 83

  /// @param port used from join() on; like `settings` it must outlive this
  CanLine(hal::CanPort* port, const GlobalParameterAccess& settings) : port_(port), settings_(settings) {}

  /// Joins the bus at the speed that global parameter 69 now says. @pre there is a port
  void join();

  /// Takes frames up to the first request. @return datagram_size, or 0 when there is none or no room for all of it
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override;

  /// Sends a reply datagram in the form in which the last request came.
  void write(const std::uint8_t* data, std::size_t length) override;

 private:
  bool is_request(const hal::CanFrame& frame, std::uint8_t& recipient) const;
  std::uint32_t setting(GlobalParameter parameter) const { return static_cast<std::uint32_t>(settings_[parameter]); }

  hal::CanPort* port_;
  const GlobalParameterAccess& settings_;
  // Of the last request:
  bool is_extended_ = false;
  std::uint8_t length_ = 0;
  bool wants_text_ = false;  ///< eight characters, which leave no byte without meaning
};

}  // namespace opentmcl
