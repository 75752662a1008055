#include "server/control_caller.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "server/json_rpc.hpp"

namespace opentmcl::server {

using client::Error;
using client::ErrorKind;
using client::Result;
using nlohmann::ordered_json;

namespace {

/// More is no answer of ours.
constexpr std::size_t longest_line = 64 << 20;

Error connection_lost(int error) {
  return {ErrorKind::input_output,
          "the connection to the simulation is gone: " + std::generic_category().message(error),
          {}};
}

Error no_answer() {
  return {ErrorKind::protocol, "what listens there does not speak as tmcl sim does", {}};
}

ErrorKind kind_of(int code) {
  switch (code) {
    case RpcError::method_not_found:
    case RpcError::invalid_params:
      return ErrorKind::usage;
    case RpcError::bad_file:
      return ErrorKind::bad_file;
    case RpcError::timeout:
      return ErrorKind::timeout;
    case RpcError::busy:
      return ErrorKind::refused;
    case RpcError::input_output:
      return ErrorKind::input_output;
    case RpcError::parse_error:
    case RpcError::invalid_request:
      return ErrorKind::protocol;
    default:
      return ErrorKind::internal;
  }
}

/// Waits until `events` are possible. Errors: timeout, input_output.
Result<void> wait_for(int socket, short events, std::chrono::steady_clock::time_point deadline) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd waited{socket, events, 0};
    const int count = ::poll(&waited, 1, static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1'000'000)));
    if (count > 0) return {};
    if (count < 0 && errno != EINTR) return connection_lost(errno);
    if (left.count() <= 0) return Error{ErrorKind::timeout, "the simulation does not answer", {}};
  }
}

}  // namespace

Result<ControlCaller> ControlCaller::connect(const std::string& path) {
  const auto refused = [&path](int error) {
    return Error{ErrorKind::no_such_device,
                 "no simulation listens at " + path + ": " + std::generic_category().message(error),
                 {}};
  };
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return refused(ENAMETOOLONG);
  std::copy(path.begin(), path.end(), address.sun_path);
  client::FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) return refused(errno);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return refused(errno);
  return ControlCaller(std::move(socket));
}

Result<void> ControlCaller::send(const std::string& line, Deadline deadline) {
  std::size_t sent = 0;
  while (sent < line.size()) {
    if (Result<void> ready = wait_for(socket_.get(), POLLOUT, deadline); !ready) return ready;
    const ssize_t count = ::send(socket_.get(), line.data() + sent, line.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && errno != EAGAIN && errno != EINTR) return connection_lost(errno);
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
  return {};
}

Result<ordered_json> ControlCaller::receive(Deadline deadline) {
  std::size_t end = received_.find('\n');
  while (end == std::string::npos) {
    if (received_.size() > longest_line) return no_answer();
    if (Result<void> ready = wait_for(socket_.get(), POLLIN, deadline); !ready) return ready.error();
    std::array<char, 65536> block{};
    const ssize_t count = ::recv(socket_.get(), block.data(), block.size(), 0);
    if (count == 0) return connection_lost(ECONNRESET);
    if (count < 0 && errno != EINTR) return connection_lost(errno);
    if (count < 0) continue;
    const std::size_t searched = received_.size();
    received_.append(block.data(), static_cast<std::size_t>(count));
    end = received_.find('\n', searched);
  }
  constexpr bool with_exceptions = false;
  ordered_json message = ordered_json::parse(received_.substr(0, end), nullptr, with_exceptions);
  received_.erase(0, end + 1);
  if (!message.is_object()) return no_answer();
  return message;
}

Result<ordered_json> ControlCaller::call(const std::string& method, const ordered_json& parameters, Limit limit) {
  const Deadline deadline = std::chrono::steady_clock::now() + limit;
  const unsigned id = ++last_id_;
  const ordered_json request{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", parameters}};
  if (Result<void> sent = send(request.dump() + '\n', deadline); !sent) return sent.error();
  while (true) {
    Result<ordered_json> message = receive(deadline);
    if (!message) return message;
    if (message->contains("method")) {
      notifications_.push_back(std::move(*message));
      continue;
    }
    // The answer to an earlier call that was not waited for.
    if (message->value("id", ordered_json()) != id) continue;
    if (const auto result = message->find("result"); result != message->end()) return ordered_json(*result);
    const auto error = message->find("error");
    if (error == message->end() || !error->is_object() || !error->contains("code") || !error->contains("message") ||
        !error->at("code").is_number_integer() || !error->at("message").is_string()) {
      return no_answer();
    }
    return Error{kind_of(error->at("code")), error->at("message").get<std::string>(), {}};
  }
}

Result<ordered_json> ControlCaller::next_notification(Limit limit) {
  const Deadline deadline = std::chrono::steady_clock::now() + limit;
  while (notifications_.empty()) {
    Result<ordered_json> message = receive(deadline);
    if (!message) return message;
    if (message->contains("method")) notifications_.push_back(std::move(*message));
  }
  ordered_json message = std::move(notifications_.front());
  notifications_.erase(notifications_.begin());
  if (!message.contains("params")) return no_answer();
  return ordered_json(message["params"]);
}

}  // namespace opentmcl::server
