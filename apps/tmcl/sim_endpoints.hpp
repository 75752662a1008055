#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/error.hpp"
#include "firmware/spec/modules.hpp"
#include "server/pty_endpoint.hpp"
#include "server/pty_link.hpp"
#include "server/tcp_endpoint.hpp"

namespace opentmcl::app {

/// The doors of `tmcl sim`: a pseudo terminal, a link to it, and TCP.
class SimEndpoints {
 public:
  static constexpr std::uint16_t default_tcp_port = 5160;

  struct Options {
    std::string link;  ///< empty: the default place, or one with a number where that is taken
    std::string tcp;   ///< PORT, ADDRESS:PORT, none; empty: default_tcp_port, or a free one where that is taken
  };

  /// @param requests_arrived called when one of the ports has new requests
  static client::Result<SimEndpoints> open(boost::asio::io_context& events, const Options& options,
                                           const ModuleDescription& module,
                                           const server::RequestsArrived& requests_arrived);

  std::vector<server::RequestPort*> ports();

  const std::string& pty_path() const { return pty_.path(); }
  const std::string& link_path() const { return link_.path(); }
  /// Empty without TCP.
  std::string tcp_url() const { return tcp_ ? tcp_->url() : std::string(); }

 private:
  SimEndpoints(server::PtyEndpoint pty, server::PtyLink link, std::optional<server::TcpEndpoint> tcp)
      : pty_(std::move(pty)), link_(std::move(link)), tcp_(std::move(tcp)) {}

  server::PtyEndpoint pty_;
  server::PtyLink link_;
  std::optional<server::TcpEndpoint> tcp_;
};

}  // namespace opentmcl::app
