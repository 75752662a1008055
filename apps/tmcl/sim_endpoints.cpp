#include "apps/tmcl/sim_endpoints.hpp"

#include <fmt/format.h>

#include <charconv>

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using server::PtyEndpoint;
using server::PtyLink;
using server::TcpEndpoint;

namespace {

/// Virtual modules of one kind that get a link of their own without being told which.
constexpr int most_links = 20;

Result<PtyLink> make_link(const std::string& wanted, const ModuleDescription& module, const std::string& terminal) {
  if (!wanted.empty()) return PtyLink::create(wanted, terminal);
  const std::string usual = server::default_link_path(module.argument);
  for (int number = 1;; ++number) {
    Result<PtyLink> link = PtyLink::create(number == 1 ? usual : fmt::format("{}-{}", usual, number), terminal);
    if (link.ok() || number == most_links) return link;
  }
}

Result<TcpEndpoint> listen(boost::asio::io_context& events, const std::string& wanted,
                           const server::RequestsArrived& requests_arrived) {
  if (wanted.empty()) {
    Result<TcpEndpoint> usual =
        TcpEndpoint::listen(events, TcpEndpoint::local_address, SimEndpoints::default_tcp_port, requests_arrived);
    return usual.ok() ? usual : TcpEndpoint::listen(events, TcpEndpoint::local_address, 0, requests_arrived);
  }
  const std::size_t colon = wanted.rfind(':');
  const std::string address = colon == std::string::npos ? TcpEndpoint::local_address : wanted.substr(0, colon);
  const std::string digits = colon == std::string::npos ? wanted : wanted.substr(colon + 1);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    return Error{
        ErrorKind::usage,
        fmt::format("\"{}\" is no TCP port: expected 0 to 65535 (0: any free one), ADDRESS:PORT, or none", wanted),
        {}};
  }
  return TcpEndpoint::listen(events, address, port, requests_arrived);
}

}  // namespace

Result<SimEndpoints> SimEndpoints::open(boost::asio::io_context& events, const Options& options,
                                        const ModuleDescription& module,
                                        const server::RequestsArrived& requests_arrived) {
  std::optional<TcpEndpoint> tcp;
  if (options.tcp != "none") {
    Result<TcpEndpoint> opened = listen(events, options.tcp, requests_arrived);
    if (!opened) return opened.error();
    tcp = std::move(*opened);
  }
  Result<PtyEndpoint> pty = PtyEndpoint::open(events, requests_arrived);
  if (!pty) return pty.error();
  Result<PtyLink> link = make_link(options.link, module, pty->path());
  if (!link) return link.error();
  return SimEndpoints(std::move(*pty), std::move(*link), std::move(tcp));
}

std::vector<server::RequestPort*> SimEndpoints::ports() {
  std::vector<server::RequestPort*> ports{&pty_.port()};
  if (tcp_) ports.push_back(&tcp_->port());
  return ports;
}

}  // namespace opentmcl::app
