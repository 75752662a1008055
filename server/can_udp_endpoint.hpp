#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "client/error.hpp"
#include "server/pace.hpp"
#include "server/shared_can_port.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// The module on a CAN bus that is a UDP multicast group, in the format of python-can's `udp_multicast`. Hosts of this
/// machine only: packets from elsewhere are ignored and replies do not leave it. Works without a network too
/// (docs/decisions/0021-can-endpoints.md).
class CanUdpEndpoint {
 public:
  /// @param group IPv4 or IPv6 multicast address
  /// @param port 1 to 65535
  /// @param requests_arrived called when `bus` has new frames
  /// Errors: usage (no multicast address, port 0), input_output.
  static client::Result<CanUdpEndpoint> join(boost::asio::io_context& events, const std::string& group,
                                             std::uint16_t port, std::shared_ptr<CanBus> bus,
                                             RequestsArrived requests_arrived,
                                             WallClock clock = std::chrono::steady_clock::now);

  /// "udp://239.74.163.2:43113"
  const std::string& url() const { return url_; }

 private:
  explicit CanUdpEndpoint(std::string url) : url_(std::move(url)) {}

  std::string url_;
};

}  // namespace opentmcl::server
