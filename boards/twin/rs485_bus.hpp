// Two wires with several transceivers: the bus that modules share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "firmware/hal/byte_port.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl {

/// A half-duplex bus in simulated time. A byte takes ten bits (start, eight, stop) and is heard by all other nodes when
/// it is over. A node that is sending hears nothing, as its receiver is switched off then.
class Rs485Bus {
 public:
  static constexpr unsigned bits_per_byte = 10;
  static constexpr twin::Tick never = ~twin::Tick{0};

  explicit Rs485Bus(std::uint32_t baud_rate);
  ~Rs485Bus();

  /// A new node on the wires, owned by the bus.
  hal::BytePort& connect();

  twin::Tick now() const { return now_; }
  /// Lets time pass: what is sent until `tick` arrives. @return whether any node has heard something
  bool advance_to(twin::Tick tick);
  /// When the next byte that is on the wires will be heard, or `never`.
  twin::Tick next_arrival() const;
  bool is_idle() const { return next_arrival() == never; }

  twin::Tick byte_duration() const { return byte_duration_; }

  /// How often a byte began while another node was sending one. What is heard of both is their common ones: a driver
  /// that pulls low wins.
  std::size_t collisions() const { return collisions_; }

 private:
  class Node;

  void start_byte(Node& node, twin::Tick tick);
  void end_byte(Node& node);
  Node* next_to_end();

  const twin::Tick byte_duration_;
  twin::Tick now_ = 0;
  std::size_t collisions_ = 0;
  std::vector<std::unique_ptr<Node>> nodes_;
};

}  // namespace opentmcl
