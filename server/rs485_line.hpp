#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "boards/twin/rs485_bus.hpp"
#include "boards/twin/simulated.hpp"
#include "boards/twin/virtual_module.hpp"
#include "server/request_port.hpp"

namespace opentmcl::server {

/// Several modules on one RS485 line with a host at its end, moved through time together: each byte takes its time on
/// the wires and is heard by all.
///
/// Hosts that share `host` take turns: the next request goes out when the nine bytes of a reply have been heard or,
/// since no reply follows a request to a group, to nobody or while replies are switched off, when the line has been
/// silent for a while (docs/decisions/0050-buses-of-a-farm.md).
class Rs485Line final : public Simulated {
 public:
  /// Longer than a module takes to begin its reply, unless it pauses (global parameter 75) or waits for its EEPROM.
  static constexpr Microseconds silence_without_reply = 5 * one_millisecond;

  /// @param host what hosts send and get; must outlive this
  /// @param baud_rate bit/s, more than 0
  Rs485Line(RequestPort& host, std::uint32_t baud_rate);
  Rs485Line(const Rs485Line&) = delete;
  Rs485Line& operator=(const Rs485Line&) = delete;

  /// The end of the line that a module is to have as a port of the kind rs485.
  hal::BytePort& connect() { return bus_.connect(); }
  /// A module with such a port, as old as this; it must outlive this.
  void add(VirtualModule& module) { modules_.push_back(&module); }

  Microseconds now() const override { return bus_.now() / twin::ticks_per_microsecond; }
  void advance_to(Microseconds time) override;
  void wake() override { is_woken_ = true; }
  Microseconds next_turn() const override;

  /// How often two spoke at once: a module and a host that did not wait for its reply.
  std::size_t collisions() const { return bus_.collisions(); }

 private:
  void move_to(Microseconds time);
  void take_turn();
  void hear();
  void speak();
  Microseconds line_is_free_at() const;

  RequestPort& host_;
  Rs485Bus bus_;
  hal::BytePort& host_end_;
  std::vector<VirtualModule*> modules_;
  bool is_woken_ = false;
  Microseconds silent_since_ = 0;  ///< since then the wires have carried nothing, or will when the request is over
  std::size_t heard_ = 0;          ///< bytes since the last request
  bool is_waiting_for_reply_ = false;
};

}  // namespace opentmcl::server
