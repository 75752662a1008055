#pragma once

#include <functional>
#include <memory>
#include <string>

#include "client/error.hpp"
#include "client/file_descriptor.hpp"
#include "server/pace.hpp"
#include "server/request_port.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// A pseudo terminal that looks to a host like the module's USB serial port. Hosts may open and close it as they like.
class PtyEndpoint {
 public:
  /// @param requests_arrived called when port() has new requests
  /// @param clock tells the silence between two requests
  /// @param port where the requests go, shared with other endpoints; nullptr: one of its own
  /// Error: input_output.
  static client::Result<PtyEndpoint> open(boost::asio::io_context& events, RequestsArrived requests_arrived,
                                          WallClock clock = std::chrono::steady_clock::now,
                                          std::shared_ptr<RequestPort> port = nullptr);

  RequestPort& port() { return *port_; }

  /// What a host opens: "/dev/pts/3".
  const std::string& path() const { return path_; }

 private:
  PtyEndpoint(std::shared_ptr<RequestPort> port, client::FileDescriptor terminal, std::string path)
      : port_(std::move(port)), terminal_(std::move(terminal)), path_(std::move(path)) {}

  std::shared_ptr<RequestPort> port_;
  /// The host's side. Held open so that our side does not hang up whenever a host closes it, and keeps its settings.
  client::FileDescriptor terminal_;
  std::string path_;
};

}  // namespace opentmcl::server
