#include "editor/lsp/serve.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <utility>

#include "editor/lsp/language_server.hpp"

namespace opentmcl::editor::lsp {
namespace {

using State = ReadOutcome::State;

constexpr const char* cancel_method = "$/cancelRequest";
/// So many messages are read ahead.
constexpr std::size_t most_waiting = 1000;

class Conversation {
 public:
  Conversation(MessageStream& stream, lang::FileProvider& disk)
      : stream_(&stream), server_([this](const json& message) { send(message); }, disk) {}

  ServeResult run() {
    while (!server_.exit_code()) {
      if (waiting_.empty()) server_.publish();
      if (!is_reader_gone_ && !read_ahead()) break;
      if (is_reader_gone_) break;
      take_next();
    }
    if (is_reader_gone_ && error_.empty()) error_ = "the editor does not read any more";
    return {server_.exit_code().value_or(1), error_};
  }

 private:
  /// False when the client has gone and nothing is left to be answered.
  bool read_ahead() {
    constexpr std::chrono::milliseconds at_once{0};
    while (waiting_.size() < most_waiting && !has_ended_) {
      const MessageStream::Limit limit = waiting_.empty() ? MessageStream::Limit() : at_once;
      ReadOutcome outcome = stream_->read(limit);
      switch (outcome.state) {
        case State::message:
          if (!cancels(outcome.message)) waiting_.push_back(std::move(outcome));
          break;
        case State::not_json:
          waiting_.push_back(std::move(outcome));
          break;
        case State::nothing_yet:
          return true;
        case State::closed:
          has_ended_ = true;
          break;
        case State::broken:
          has_ended_ = true;
          error_ = outcome.error;
          break;
      }
    }
    return !waiting_.empty();
  }

  /// A request that has been answered cannot be cancelled any more; it is too late then.
  bool cancels(const json& message) {
    if (text_of(member(message, "method")) != cancel_method) return false;
    const json& id = member(message, "params", "id");
    const bool is_id = id.is_string() || id.is_number_integer();
    const auto cancelled = std::find_if(waiting_.begin(), waiting_.end(), [&](const ReadOutcome& request) {
      return is_id && member(request.message, "id") == id && member(request.message, "method").is_string();
    });
    if (cancelled != waiting_.end()) {
      server_.refuse_cancelled(cancelled->message);
      waiting_.erase(cancelled);
    }
    return true;
  }

  void take_next() {
    if (waiting_.empty()) return;
    const ReadOutcome next = std::move(waiting_.front());
    waiting_.pop_front();
    if (next.state == State::message) {
      server_.take(next.message);
    } else {
      server_.refuse_message(next.error);
    }
  }

  void send(const json& message) {
    if (!is_reader_gone_ && !stream_->write(message)) is_reader_gone_ = true;
  }

  MessageStream* stream_;
  LanguageServer server_;
  std::deque<ReadOutcome> waiting_;
  bool has_ended_ = false;
  bool is_reader_gone_ = false;
  std::string error_;
};

}  // namespace

ServeResult serve(MessageStream& stream, lang::FileProvider& disk) {
  return Conversation(stream, disk).run();
}

}  // namespace opentmcl::editor::lsp
