#pragma once

#include <memory>
#include <string>

#include "client/error.hpp"
#include "client/file_descriptor.hpp"
#include "server/pace.hpp"
#include "server/shared_can_port.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// The module as a node on a CAN interface of Linux, can0 or vcan0. Its bit rate is the affair of whoever set it up.
class SocketCanEndpoint {
 public:
  /// @param interface name as `ip link` shows it
  /// @param requests_arrived called when `bus` has new frames
  /// Errors: no_such_device (a kernel without SocketCAN, no such interface), input_output.
  static client::Result<SocketCanEndpoint> open(boost::asio::io_context& events, const std::string& interface,
                                                std::shared_ptr<CanBus> bus, RequestsArrived requests_arrived,
                                                WallClock clock = std::chrono::steady_clock::now);

  /// Serves a socket that carries one `struct can_frame` a packet.
  static void serve(boost::asio::io_context& events, client::FileDescriptor socket, std::shared_ptr<CanBus> bus,
                    RequestsArrived requests_arrived, WallClock clock = std::chrono::steady_clock::now);

  const std::string& interface() const { return interface_; }

 private:
  explicit SocketCanEndpoint(std::string interface) : interface_(std::move(interface)) {}

  std::string interface_;
};

}  // namespace opentmcl::server
