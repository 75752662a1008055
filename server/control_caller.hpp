#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "client/error.hpp"
#include "client/file_descriptor.hpp"

namespace opentmcl::server {

/// The other end of ControlServer: asks, and waits for the answer.
class ControlCaller {
 public:
  using Limit = std::chrono::milliseconds;

  /// Error: no_such_device (nobody listens there).
  static client::Result<ControlCaller> connect(const std::string& path);

  /// The result of a method. Errors: usage (the method or its parameters), bad_file, timeout (no answer within
  /// `limit`, or the simulation says so), refused (it is busy), internal, input_output (the connection is gone),
  /// protocol (an answer that is none).
  client::Result<nlohmann::ordered_json> call(const std::string& method, const nlohmann::ordered_json& parameters,
                                              Limit limit);

  /// The parameters of the next notification. Errors: timeout, input_output, protocol.
  client::Result<nlohmann::ordered_json> next_notification(Limit limit);

 private:
  using Deadline = std::chrono::steady_clock::time_point;

  explicit ControlCaller(client::FileDescriptor socket) : socket_(std::move(socket)) {}

  client::Result<void> send(const std::string& line, Deadline deadline);
  client::Result<nlohmann::ordered_json> receive(Deadline deadline);

  client::FileDescriptor socket_;
  std::string received_;
  std::vector<nlohmann::ordered_json> notifications_;  // that came while an answer was waited for
  unsigned last_id_ = 0;
};

}  // namespace opentmcl::server
