#include "apps/tmcl/sim_endpoints.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "firmware/spec/lookup.hpp"
#include "server/port_kinds.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using server::CanUdpEndpoint;
using server::PtyEndpoint;
using server::PtyLink;
using server::SharedCanPort;
using server::SlcanEndpoint;
using server::SocketCanEndpoint;
using server::TcpEndpoint;

namespace {

/// Virtual modules of one kind that get a link of their own without being told which.
constexpr int most_links = 20;

/// python-can's own for IPv4.
constexpr const char* usual_group = "239.74.163.2:43113";

Result<PtyLink> make_link(const std::string& wanted, const ModuleDescription& module, const std::string& terminal) {
  if (!wanted.empty()) return PtyLink::create(wanted, terminal);
  const std::string usual = server::default_link_path(module.argument);
  for (int number = 1;; ++number) {
    Result<PtyLink> link = PtyLink::create(number == 1 ? usual : fmt::format("{}-{}", usual, number), terminal);
    if (link.ok() || number == most_links) return link;
  }
}

std::optional<std::uint16_t> parse_port(const std::string& digits) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return port;
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
  const std::optional<std::uint16_t> port = parse_port(digits);
  if (!port) {
    return Error{
        ErrorKind::usage,
        fmt::format("\"{}\" is no TCP port: expected 0 to 65535 (0: any free one), ADDRESS:PORT, or none", wanted),
        {}};
  }
  return TcpEndpoint::listen(events, address, *port, requests_arrived);
}

/// @param wanted "239.74.163.2:43113" or "[ff15::1]:43113"
Result<CanUdpEndpoint> join(boost::asio::io_context& events, const std::string& wanted,
                            const std::shared_ptr<SharedCanPort>& bus,
                            const server::RequestsArrived& requests_arrived) {
  const std::size_t colon = wanted.rfind(':');
  const std::optional<std::uint16_t> port =
      colon == std::string::npos ? std::nullopt : parse_port(wanted.substr(colon + 1));
  if (!port) {
    return Error{
        ErrorKind::usage, fmt::format("\"{}\" is no GROUP:PORT: expected for example {}", wanted, usual_group), {}};
  }
  std::string group = wanted.substr(0, colon);
  if (group.size() >= 2 && group.front() == '[' && group.back() == ']') group = group.substr(1, group.size() - 2);
  return CanUdpEndpoint::join(events, group, *port, bus, requests_arrived);
}

Result<hal::PortKind> parse_port_kind(const std::string& wanted, const ModuleDescription& module) {
  const server::PortKindName* const found = server::find_port_kind(wanted);
  if (found == nullptr) {
    return Error{ErrorKind::usage,
                 fmt::format("\"{}\" is no kind of port: expected {}", wanted, server::port_kind_choice(module)),
                 {}};
  }
  if (const auto objection = server::absence(found->kind, module)) return Error{ErrorKind::usage, *objection, {}};
  return found->kind;
}

bool wants_can(const SimEndpoints::Options& options) {
  return !options.slcan_link.empty() || !options.can_udp.empty() || !options.can.empty();
}

}  // namespace

Result<SimEndpoints> SimEndpoints::open(boost::asio::io_context& events, const Options& options,
                                        const ModuleDescription& module,
                                        const server::RequestsArrived& requests_arrived) {
  const Result<hal::PortKind> port_kind = parse_port_kind(options.port_kind, module);
  if (!port_kind) return port_kind.error();
  if (wants_can(options) && !has_can(module.id)) {
    return Error{
        ErrorKind::usage,
        fmt::format("a {} has no CAN: --slcan-link, --can-udp and --can need {}", module.name, tmcm1110.argument),
        {}};
  }
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
  SimEndpoints endpoints(std::move(*pty), std::move(*link), *port_kind, std::move(tcp));
  if (wants_can(options)) {
    if (Result<void> opened = endpoints.open_can(events, options, requests_arrived); !opened) return opened.error();
  }
  return endpoints;
}

Result<void> SimEndpoints::open_can(boost::asio::io_context& events, const Options& options,
                                    const server::RequestsArrived& requests_arrived) {
  can_bus_ = std::make_shared<SharedCanPort>();
  if (!options.slcan_link.empty()) {
    Result<SlcanEndpoint> opened = SlcanEndpoint::open(events, can_bus_, requests_arrived);
    if (!opened) return opened.error();
    Result<PtyLink> link = PtyLink::create(options.slcan_link, opened->path());
    if (!link) return link.error();
    slcan_.emplace(std::move(*opened));
    slcan_link_.emplace(std::move(*link));
  }
  if (!options.can_udp.empty()) {
    Result<CanUdpEndpoint> joined = join(events, options.can_udp, can_bus_, requests_arrived);
    if (!joined) return joined.error();
    can_udp_.emplace(std::move(*joined));
  }
  if (!options.can.empty()) {
    Result<SocketCanEndpoint> opened = SocketCanEndpoint::open(events, options.can, can_bus_, requests_arrived);
    if (!opened) return opened.error();
    socket_can_.emplace(std::move(*opened));
  }
  return {};
}

std::vector<hal::Port> SimEndpoints::ports() {
  std::vector<hal::Port> ports{{&pty_.port(), port_kind_}};
  if (tcp_) ports.push_back({&tcp_->port(), hal::PortKind::usb});
  return ports;
}

std::vector<const server::RequestQueue*> SimEndpoints::requests() {
  std::vector<const server::RequestQueue*> requests{&pty_.port()};
  if (tcp_) requests.push_back(&tcp_->port());
  if (can_bus_) requests.push_back(can_bus_.get());
  return requests;
}

}  // namespace opentmcl::app
