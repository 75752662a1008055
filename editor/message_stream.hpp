// Messages from an editor and back: JSON values, framed by the base protocol (message_decoder.hpp).
//
// A server that only answers, as a language server does, calls `read` and waits. One that also has something to do in
// between, as a debug adapter whose program runs, either asks now and then with a limit of zero, or waits for
// `descriptor()` together with descriptors of its own in poll(2): `has_message()` first, because a message that has
// been read already does not make the descriptor ready.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "editor/message_decoder.hpp"

namespace opentmcl::editor {

// Moving JSON throws nothing, whatever clang-tidy sees in its checks of itself.
struct ReadOutcome {  // NOLINT(bugprone-exception-escape)
  enum class State : std::uint8_t {
    message,
    nothing_yet,  ///< the limit has passed
    not_json,     ///< a message whose body is no JSON; the next one may be
    closed,       ///< the other end has gone, between two messages
    broken,       ///< no further message can be read
  };

  State state = State::nothing_yet;
  nlohmann::json message;
  std::string error;  ///< of `not_json` and `broken`: what was expected, and what came
};

/// One end of a conversation.
class MessageStream {
 public:
  using Limit = std::optional<std::chrono::milliseconds>;

  virtual ~MessageStream() = default;

  /// The next message, or why there is none. Waits at most `limit`, without one until something happens.
  virtual ReadOutcome read(Limit limit) = 0;
  /// Whether `read` has a message at hand without looking at the descriptor.
  virtual bool has_message() = 0;
  /// Becomes readable when there is more to read; -1 for a stream that has none.
  virtual int descriptor() const = 0;

  /// Sends a message as a whole. False if the other end has gone; then nothing more can be sent.
  virtual bool write(const nlohmann::json& message) = 0;

 protected:
  MessageStream() = default;
  MessageStream(const MessageStream&) = default;
  MessageStream& operator=(const MessageStream&) = default;
};

/// A stream on two file descriptors, such as stdin and stdout, which may be the same. They are not closed at the end.
/// SIGPIPE must be ignored: an editor can go at any time.
class DescriptorStream final : public MessageStream {
 public:
  /// An editor that reads nothing for so long has hung.
  static constexpr std::chrono::milliseconds write_limit{10'000};

  DescriptorStream(int input, int output) : input_(input), output_(output) {}

  ReadOutcome read(Limit limit) override;
  bool has_message() override;
  int descriptor() const override { return input_; }
  bool write(const nlohmann::json& message) override;

 private:
  bool take_message();

  int input_;
  int output_;
  MessageDecoder decoder_;
  std::optional<ReadOutcome> at_hand_;
  bool is_closed_ = false;
};

/// A stream inside the process, for tests: what one end writes the other one reads. Nothing ever waits: without a
/// message `read` says `nothing_yet`, or `closed` when the other end has been destroyed.
class MemoryStream final : public MessageStream {
 public:
  static std::pair<std::unique_ptr<MemoryStream>, std::unique_ptr<MemoryStream>> make_pair();

  ReadOutcome read(Limit limit) override;
  bool has_message() override { return !incoming_->empty(); }
  int descriptor() const override { return -1; }
  bool write(const nlohmann::json& message) override;

  /// A body as it is, JSON or not.
  bool write_text(std::string body);

 private:
  using Bodies = std::deque<std::string>;

  MemoryStream(std::shared_ptr<Bodies> incoming, std::shared_ptr<Bodies> outgoing)
      : incoming_(std::move(incoming)), outgoing_(std::move(outgoing)) {}

  std::shared_ptr<Bodies> incoming_;
  std::shared_ptr<Bodies> outgoing_;
};

}  // namespace opentmcl::editor
