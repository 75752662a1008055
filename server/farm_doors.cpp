#include "server/farm_doors.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

namespace opentmcl::server {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// The folder of a link is made when it does not exist.
Result<PtyLink> make_link(const std::string& path, const std::string& terminal) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error)
    return Error{ErrorKind::input_output, "cannot make the folder " + folder.string() + ": " + error.message(), {}};
  return PtyLink::create(path, terminal);
}

}  // namespace

Result<OpenDoors> OpenDoors::open(boost::asio::io_context& events, const FarmDoors& wanted,
                                  const std::string& tcp_address, const std::shared_ptr<RequestPort>& port,
                                  const std::shared_ptr<CanBus>& bus, const RequestsArrived& requests_arrived,
                                  const WallClock& clock) {
  OpenDoors doors;
  if (!wanted.link.empty()) {
    Result<PtyEndpoint> pty = PtyEndpoint::open(events, requests_arrived, clock, port);
    if (!pty) return pty.error();
    Result<PtyLink> link = make_link(wanted.link, pty->path());
    if (!link) return link.error();
    doors.pty_.emplace(std::move(*pty));
    doors.link_.emplace(std::move(*link));
  }
  if (wanted.tcp) {
    Result<TcpEndpoint> tcp = TcpEndpoint::listen(events, tcp_address, *wanted.tcp, requests_arrived, clock, port);
    if (!tcp) return tcp.error();
    doors.tcp_.emplace(std::move(*tcp));
  }
  if (!wanted.slcan_link.empty()) {
    Result<SlcanEndpoint> slcan = SlcanEndpoint::open(events, bus, requests_arrived, clock);
    if (!slcan) return slcan.error();
    Result<PtyLink> link = make_link(wanted.slcan_link, slcan->path());
    if (!link) return link.error();
    doors.slcan_.emplace(std::move(*slcan));
    doors.slcan_link_.emplace(std::move(*link));
  }
  if (!wanted.can_group.empty()) {
    Result<CanUdpEndpoint> joined =
        CanUdpEndpoint::join(events, wanted.can_group, wanted.can_port, bus, requests_arrived, clock);
    if (!joined) return joined.error();
    doors.can_udp_.emplace(std::move(*joined));
  }
  return doors;
}

}  // namespace opentmcl::server
