#include "editor/message_stream.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <string_view>
#include <system_error>

namespace opentmcl::editor {
namespace {

using Clock = std::chrono::steady_clock;
using State = ReadOutcome::State;

/// Bytes a read takes at most.
constexpr std::size_t piece_size = 65536;

ReadOutcome outcome_of(std::string_view body) {
  ReadOutcome outcome;
  outcome.message = nlohmann::json::parse(body, nullptr, false);
  outcome.state = outcome.message.is_discarded() ? State::not_json : State::message;
  if (outcome.state == State::not_json) {
    outcome.message = nullptr;
    outcome.error = "the body of a message is not JSON";
  }
  return outcome;
}

ReadOutcome ended(State state, std::string error = {}) {
  ReadOutcome outcome;
  outcome.state = state;
  outcome.error = std::move(error);
  return outcome;
}

/// Text that is not UTF-8, as a source file's may be, does not stop a message.
std::string body_of(const nlohmann::json& message) {
  return message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Waits until `descriptor` is ready or the deadline has passed; without one for ever.
bool wait_for(int descriptor, short event, const std::optional<Clock::time_point>& deadline) {
  while (true) {
    int milliseconds = -1;
    if (deadline) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now()).count();
      milliseconds = static_cast<int>(std::clamp<decltype(left)>(left, 0, std::numeric_limits<int>::max()));
    }
    pollfd waiting{descriptor, event, 0};
    const int ready = ::poll(&waiting, 1, milliseconds);
    if (ready > 0) return true;
    if (ready == 0 && deadline && Clock::now() >= *deadline) return false;
    if (ready < 0 && errno != EINTR && errno != EAGAIN) return true;  // read or write will say what is wrong
  }
}

std::optional<Clock::time_point> deadline_of(MessageStream::Limit limit) {
  if (!limit) return std::nullopt;
  return Clock::now() + *limit;
}

}  // namespace

// ---- on descriptors

bool DescriptorStream::take_message() {
  if (at_hand_) return true;
  if (std::optional<std::string> body = decoder_.next()) {
    at_hand_ = outcome_of(*body);
  } else if (!decoder_.error().empty()) {
    at_hand_ = ended(State::broken, decoder_.error());
  }
  return at_hand_.has_value();
}

bool DescriptorStream::has_message() {
  return take_message();
}

ReadOutcome DescriptorStream::read(Limit limit) {
  const std::optional<Clock::time_point> deadline = deadline_of(limit);
  std::array<char, piece_size> piece;
  while (!take_message()) {
    if (is_closed_) {
      return decoder_.is_within_message() ? ended(State::broken, "the input ends within a message")
                                          : ended(State::closed);
    }
    if (!wait_for(input_, POLLIN, deadline)) return ended(State::nothing_yet);
    const ssize_t count = ::read(input_, piece.data(), piece.size());
    if (count > 0) {
      decoder_.append({piece.data(), static_cast<std::size_t>(count)});
    } else if (count == 0) {
      is_closed_ = true;
    } else if (errno != EINTR && errno != EAGAIN) {
      return ended(State::broken, "cannot read messages: " + std::generic_category().message(errno));
    }
  }
  ReadOutcome outcome = std::move(*at_hand_);
  at_hand_.reset();
  return outcome;
}

bool DescriptorStream::write(const nlohmann::json& message) {
  const std::string bytes = with_header(body_of(message));
  std::string_view left = bytes;
  while (!left.empty()) {
    if (!wait_for(output_, POLLOUT, deadline_of(write_limit))) return false;
    const ssize_t count = ::write(output_, left.data(), left.size());
    if (count > 0) {
      left.remove_prefix(static_cast<std::size_t>(count));
    } else if (count < 0 && errno != EINTR && errno != EAGAIN) {
      return false;
    }
  }
  return true;
}

// ---- in memory

std::pair<std::unique_ptr<MemoryStream>, std::unique_ptr<MemoryStream>> MemoryStream::make_pair() {
  auto there = std::make_shared<Bodies>();
  auto back = std::make_shared<Bodies>();
  std::unique_ptr<MemoryStream> left(new MemoryStream(there, back));
  std::unique_ptr<MemoryStream> right(new MemoryStream(std::move(back), std::move(there)));
  return {std::move(left), std::move(right)};
}

ReadOutcome MemoryStream::read(Limit /*limit*/) {
  if (incoming_->empty()) return ended(incoming_.use_count() > 1 ? State::nothing_yet : State::closed);
  const std::string body = std::move(incoming_->front());
  incoming_->pop_front();
  return outcome_of(body);
}

bool MemoryStream::write(const nlohmann::json& message) {
  return write_text(body_of(message));
}

bool MemoryStream::write_text(std::string body) {
  if (outgoing_.use_count() == 1) return false;
  outgoing_->push_back(std::move(body));
  return true;
}

}  // namespace opentmcl::editor
