#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "client/error.hpp"
#include "server/pace.hpp"
#include "server/request_port.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// Raw 9-byte datagrams over TCP. Any number of hosts may be connected; their requests are served in the order in which
/// they became complete, and each reply goes to the connection its request came from. A second reply of command 138
/// goes to the connection that was served last.
class TcpEndpoint {
 public:
  /// Listens on this machine only unless told otherwise.
  static constexpr const char* local_address = "127.0.0.1";

  /// @param address IPv4 or IPv6 address to listen on
  /// @param port 0 for any free one
  /// @param requests_arrived called when port() has new requests
  /// @param clock tells the silence between two requests
  /// @param requests where they go, shared with other endpoints; nullptr: a port of its own
  /// Errors: usage (no address), input_output (the port is taken or not allowed).
  static client::Result<TcpEndpoint> listen(boost::asio::io_context& events, const std::string& address,
                                            std::uint16_t port, RequestsArrived requests_arrived,
                                            WallClock clock = std::chrono::steady_clock::now,
                                            std::shared_ptr<RequestPort> requests = nullptr);

  RequestPort& port() { return *port_; }

  /// What a host connects to: "tcp://127.0.0.1:5160".
  const std::string& url() const { return url_; }

 private:
  TcpEndpoint(std::shared_ptr<RequestPort> port, std::string url) : port_(std::move(port)), url_(std::move(url)) {}

  std::shared_ptr<RequestPort> port_;
  std::string url_;
};

}  // namespace opentmcl::server
