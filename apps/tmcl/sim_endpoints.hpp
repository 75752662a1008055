#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/error.hpp"
#include "firmware/hal/hal.hpp"
#include "firmware/spec/modules.hpp"
#include "server/can_udp_endpoint.hpp"
#include "server/pty_endpoint.hpp"
#include "server/pty_link.hpp"
#include "server/shared_can_port.hpp"
#include "server/slcan_endpoint.hpp"
#include "server/socket_can_endpoint.hpp"
#include "server/tcp_endpoint.hpp"

namespace opentmcl::app {

/// The doors of `tmcl sim`: a pseudo terminal with a link to it, TCP, and the ways to a TMCM-1110's CAN bus.
class SimEndpoints {
 public:
  static constexpr std::uint16_t default_tcp_port = 5160;

  struct Options {
    std::string link;               ///< empty: the default place, or one with a number where that is taken
    std::string port_kind = "usb";  ///< what the pseudo terminal stands for, as server/port_kinds.hpp calls it
    std::string tcp;         ///< PORT, ADDRESS:PORT, none; empty: default_tcp_port, or a free one where that is taken
    std::string slcan_link;  ///< of a second pseudo terminal, an SLCAN adapter; empty: none
    std::string can_udp;     ///< GROUP:PORT of a UDP multicast group; empty: none
    std::string can;         ///< SocketCAN interface; empty: none
  };

  /// @param requests_arrived called when one of the ports has new requests
  static client::Result<SimEndpoints> open(boost::asio::io_context& events, const Options& options,
                                           const ModuleDescription& module,
                                           const server::RequestsArrived& requests_arrived);

  /// The serial ports of the module.
  std::vector<hal::Port> ports();
  /// Its connector to CAN; nullptr when nothing is plugged in.
  hal::CanPort* can_port() { return can_bus_.get(); }
  /// What waits at any of them.
  std::vector<const server::RequestQueue*> requests();

  const std::string& pty_path() const { return pty_.path(); }
  const std::string& link_path() const { return link_.path(); }
  hal::PortKind port_kind() const { return port_kind_; }
  // Empty without:
  std::string tcp_url() const { return tcp_ ? tcp_->url() : std::string(); }
  std::string slcan_path() const { return slcan_ ? slcan_->path() : std::string(); }
  std::string slcan_link_path() const { return slcan_link_ ? slcan_link_->path() : std::string(); }
  std::string can_udp_url() const { return can_udp_ ? can_udp_->url() : std::string(); }
  std::string can_interface() const { return socket_can_ ? socket_can_->interface() : std::string(); }

 private:
  SimEndpoints(server::PtyEndpoint pty, server::PtyLink link, hal::PortKind port_kind,
               std::optional<server::TcpEndpoint> tcp)
      : pty_(std::move(pty)), link_(std::move(link)), port_kind_(port_kind), tcp_(std::move(tcp)) {}

  client::Result<void> open_can(boost::asio::io_context& events, const Options& options,
                                const server::RequestsArrived& requests_arrived);

  server::PtyEndpoint pty_;
  server::PtyLink link_;
  hal::PortKind port_kind_;
  std::optional<server::TcpEndpoint> tcp_;
  std::shared_ptr<server::SharedCanPort> can_bus_;
  std::optional<server::SlcanEndpoint> slcan_;
  std::optional<server::PtyLink> slcan_link_;
  std::optional<server::CanUdpEndpoint> can_udp_;
  std::optional<server::SocketCanEndpoint> socket_can_;
};

}  // namespace opentmcl::app
