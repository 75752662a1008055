#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

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

/// What an endpoint sees of the bus that it leads to.
class CanBus {
 public:
  /// Puts a frame on the bus. `sender` must forget() itself before it goes away.
  virtual void push(const hal::CanFrame& frame, CanFrameSink& sender) = 0;

  /// Drops the sender's frames; a reply that is still to come is dropped too.
  virtual void forget(const CanFrameSink& sender) = 0;

  /// At which speed modules are on the bus, bit/s; 0 before their first start.
  virtual std::uint32_t bit_rate() const = 0;

 protected:
  ~CanBus() = default;
};

/// The CAN connector of a virtual module, shared by any number of senders that do not hear each other
/// (docs/decisions/0021-can-endpoints.md). Which frames are requests is the firmware's affair: it reads frames up to
/// the first that is one, and reads on only when it is done with that. So a frame it sends is for the sender of the
/// last frame it read, and when it finds no more frames, those before were none of its business.
class SharedCanPort final : public hal::CanPort, public CanBus, public RequestQueue {
 public:
  /// Frames that wait; what comes on top is lost, as when the receive queue of a CAN controller overflows.
  static constexpr std::size_t capacity = 256;

  void push(const hal::CanFrame& frame, CanFrameSink& sender) override {
    if (frames_.size() < capacity) frames_.push_back({frame, &sender});
  }
  void forget(const CanFrameSink& sender) override;

  std::size_t size() const override { return frames_.size(); }
  std::uint32_t bit_rate() const override { return bit_rate_; }

  void join(std::uint32_t bit_rate) override { bit_rate_ = bit_rate; }
  bool read(hal::CanFrame& frame) override;
  void write(const hal::CanFrame& frame) override;

 private:
  struct Entry {
    hal::CanFrame frame;
    CanFrameSink* sender;
  };

  std::vector<Entry> frames_;
  std::uint32_t bit_rate_ = 0;
  CanFrameSink* current_ = nullptr;   // sender of the frame that was read last
  CanFrameSink* answered_ = nullptr;  // who was sent a frame last
};

/// A bus with several modules on it. Each of them hears every frame of every endpoint; what it sends goes to the
/// endpoint that it answers, and to no other module: modules send nothing but replies
/// (docs/decisions/0050-buses-of-a-farm.md).
class SharedCanBus final : public CanBus {
 public:
  /// A connector for one more module, owned by the bus.
  SharedCanPort& connect();

  void push(const hal::CanFrame& frame, CanFrameSink& sender) override;
  void forget(const CanFrameSink& sender) override;
  /// That of the first module; whoever builds the bus sees to it that all have the same.
  std::uint32_t bit_rate() const override;

 private:
  std::vector<std::unique_ptr<SharedCanPort>> connectors_;
};

}  // namespace opentmcl::server
