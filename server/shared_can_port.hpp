#pragma once

#include <cstdint>
#include <deque>

#include "firmware/hal/can_port.hpp"
#include "server/request_queue.hpp"

namespace opentmcl::server {

/// Who put a frame on the bus of a module, and so gets what the module sends in answer.
class CanFrameSink {
 public:
  virtual void send(const hal::CanFrame& frame) = 0;

 protected:
  ~CanFrameSink() = default;
};

/// The CAN connector of a virtual module, shared by any number of senders that do not hear each other
/// (docs/decisions/0021-can-endpoints.md). Which frames are requests is the firmware's affair: it reads frames up to
/// the first that is one, and reads on only when it is done with that. So a frame it sends is for the sender of the
/// last frame it read, and when it finds no more frames, those before were none of its business.
class SharedCanPort final : public hal::CanPort, public RequestQueue {
 public:
  /// `sender` must forget() itself before it goes away.
  void push(const hal::CanFrame& frame, CanFrameSink& sender) { frames_.push_back({frame, &sender}); }

  /// Drops the sender's frames; a reply that is still to come is dropped too.
  void forget(const CanFrameSink& sender);

  std::size_t size() const override { return frames_.size(); }

  /// At which speed the module is on the bus, bit/s; 0 before its first start.
  std::uint32_t bit_rate() const { return bit_rate_; }

  void join(std::uint32_t bit_rate) override { bit_rate_ = bit_rate; }
  bool read(hal::CanFrame& frame) override;
  void write(const hal::CanFrame& frame) override;

 private:
  struct Entry {
    hal::CanFrame frame;
    CanFrameSink* sender;
  };

  std::deque<Entry> frames_;
  std::uint32_t bit_rate_ = 0;
  CanFrameSink* current_ = nullptr;   // sender of the frame that was read last
  CanFrameSink* answered_ = nullptr;  // who was sent a frame last
};

}  // namespace opentmcl::server
