#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/error.hpp"
#include "server/can_udp_endpoint.hpp"
#include "server/farm_description.hpp"
#include "server/pty_endpoint.hpp"
#include "server/pty_link.hpp"
#include "server/shared_can_port.hpp"
#include "server/slcan_endpoint.hpp"
#include "server/tcp_endpoint.hpp"

namespace opentmcl::server {

/// The doors of a module or a bus of a farm, open.
class OpenDoors {
 public:
  /// @param tcp_address where a TCP port listens
  /// @param port where both serial doors lead; nullptr: each to a port of its own
  /// @param bus where doors to CAN lead; may be nullptr without such doors
  /// @param requests_arrived called when one of the doors has new requests
  /// Errors: usage, input_output.
  static client::Result<OpenDoors> open(boost::asio::io_context& events, const FarmDoors& wanted,
                                        const std::string& tcp_address, const std::shared_ptr<RequestPort>& port,
                                        const std::shared_ptr<CanBus>& bus, const RequestsArrived& requests_arrived,
                                        const WallClock& clock);

  // Empty, or nullptr, without:
  std::string link() const { return link_ ? link_->path() : std::string(); }
  std::string tcp_url() const { return tcp_ ? tcp_->url() : std::string(); }
  std::string slcan_link() const { return slcan_link_ ? slcan_link_->path() : std::string(); }
  std::string can_url() const { return can_udp_ ? can_udp_->url() : std::string(); }
  RequestPort* pty_port() { return pty_ ? &pty_->port() : nullptr; }
  RequestPort* tcp_port() { return tcp_ ? &tcp_->port() : nullptr; }

 private:
  OpenDoors() = default;

  std::optional<PtyEndpoint> pty_;
  std::optional<PtyLink> link_;
  std::optional<TcpEndpoint> tcp_;
  std::optional<SlcanEndpoint> slcan_;
  std::optional<PtyLink> slcan_link_;
  std::optional<CanUdpEndpoint> can_udp_;
};

}  // namespace opentmcl::server
