#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/hal/byte_port.hpp"
#include "firmware/wire/datagram.hpp"
#include "server/request_queue.hpp"

namespace opentmcl::server {

/// Who sent a request, and so gets the reply.
class ReplySink {
 public:
  virtual void reply(std::span<const std::uint8_t> bytes) = 0;

  /// The port that was full has room again. Only for senders that wait_for_room().
  virtual void room_again() {}

 protected:
  ~ReplySink() = default;
};

/// The byte port of a virtual module, shared by any number of senders. The firmware reads one whole request at a time
/// and reads the next one only when it is done with it; so what it writes is for the sender of the request it read
/// last. In ASCII mode it reads single characters, and what it writes is for the sender of the last of them: senders
/// that type at the same time share one line.
///
/// The queue is short: a sender that has filled it is to read no more from its host until there is room, so that a
/// host that floods its module costs no memory and is slowed down by its own line.
class RequestPort final : public hal::BytePort, public RequestQueue {
 public:
  /// Requests and characters that wait before the port is full. What a sender has in hand may still be pushed.
  static constexpr std::size_t capacity = 256;

  /// `sender` must forget() itself before it goes away.
  void push(const Datagram& request, ReplySink& sender);

  /// In ASCII mode, and for what came in one piece with a change of mode.
  void push(std::uint8_t character, ReplySink& sender);

  /// The firmware expects text (ASCII mode), not requests.
  bool is_in_text_mode() const { return text_mode_; }
  /// How often that has changed.
  unsigned mode_changes() const { return mode_changes_; }

  /// Drops the sender's requests; a reply that is still to come is dropped too.
  void forget(const ReplySink& sender);

  /// Requests and characters the firmware has not read yet.
  std::size_t size() const override { return entries_.size() - first_; }

  bool is_full() const { return size() >= capacity; }
  /// `sender` is told once, by room_again(), when the port is no longer full.
  void wait_for_room(ReplySink& sender) { waiting_.push_back(&sender); }

  std::size_t read(std::uint8_t* buffer, std::size_t room) override;
  void write(const std::uint8_t* data, std::size_t length) override;
  void set_text_mode(bool text) override {
    if (text != text_mode_) ++mode_changes_;
    text_mode_ = text;
  }

 private:
  /// A request, or a character in the first byte.
  struct Entry {
    Datagram bytes;
    std::uint8_t size;
    ReplySink* sender;
  };

  void drop_first();

  std::vector<Entry> entries_;
  std::size_t first_ = 0;  // entries before it have been read
  std::vector<ReplySink*> waiting_;
  std::size_t offset_ = 0;        // bytes of the first entry that have been read
  ReplySink* current_ = nullptr;  // sender of the entry that was read last
  bool text_mode_ = false;
  unsigned mode_changes_ = 0;
};

}  // namespace opentmcl::server
