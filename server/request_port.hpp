#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>

#include "firmware/hal/byte_port.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::server {

/// Who sent a request, and so gets the reply.
class ReplySink {
 public:
  virtual void reply(std::span<const std::uint8_t> bytes) = 0;

 protected:
  ~ReplySink() = default;
};

/// The byte port of a virtual module, shared by any number of senders. The firmware reads one whole request at a time
/// and reads the next one only when it is done with it; so what it writes is for the sender of the request it read
/// last.
class RequestPort final : public hal::BytePort {
 public:
  /// `sender` must forget() itself before it goes away.
  void push(const Datagram& request, ReplySink& sender);

  /// Drops the sender's requests; a reply that is still to come is dropped too.
  void forget(const ReplySink& sender);

  /// Requests the firmware has not read yet.
  std::size_t size() const { return requests_.size(); }

  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override;
  void write(const std::uint8_t* data, std::size_t length) override;

 private:
  struct Entry {
    Datagram request;
    ReplySink* sender;
  };

  std::deque<Entry> requests_;
  std::size_t offset_ = 0;        // bytes of the first entry that have been read
  ReplySink* current_ = nullptr;  // sender of the request that was read last
};

}  // namespace opentmcl::server
