#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "server/pace.hpp"
#include "server/shared_can_port.hpp"

namespace opentmcl::server {

/// What a host at a serial CAN adapter talks to: lines of ASCII that end with a carriage return, as the LAWICEL CANUSB
/// adapter introduced them. Bytes in, text and frames out; whoever owns it moves the bytes.
///
/// Done lines are answered with a carriage return (after `z` or `Z` for a frame), others with a bell. S, s and Z are
/// for a closed channel, frames and F for an open one. The channel hears the module only at the module's bit rate;
/// without S or s it takes that rate itself (docs/decisions/0021-can-endpoints.md).
class SlcanChannel final : public CanFrameSink {
 public:
  using Write = std::function<void(std::string_view)>;

  /// @param bus must outlive the channel
  /// @param write takes text for the host
  /// @param clock gives the time stamps
  SlcanChannel(CanBus& bus, Write write, WallClock clock);
  SlcanChannel(const SlcanChannel&) = delete;
  SlcanChannel& operator=(const SlcanChannel&) = delete;
  ~SlcanChannel() { bus_.forget(*this); }

  /// Takes bytes of the host, and answers. @return whether frames were put on the bus
  bool take(std::span<const std::uint8_t> bytes);

  /// A frame of the module for the host; lost while the channel does not hear the module.
  void send(const hal::CanFrame& frame) override;

 private:
  enum class State : std::uint8_t { closed, open, listening };

  std::string answer_to(std::string_view line);
  bool set_bit_rate(std::optional<std::uint32_t> bit_rate);
  bool set_time_stamps(std::string_view digit);
  bool open(State state);
  bool close();
  std::string put_on_bus(std::string_view line);
  std::string status_flags();
  bool hears_module() const;
  std::uint32_t time_stamp() const;

  CanBus& bus_;
  Write write_;
  WallClock clock_;
  std::string line_;
  State state_ = State::closed;
  bool has_time_stamps_ = false;
  bool has_sent_ = false;  // a frame, during the present take()
  std::optional<std::uint32_t> bit_rate_;
  std::uint8_t flags_ = 0;
};

}  // namespace opentmcl::server
