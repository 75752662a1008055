#include "server/can_udp_endpoint.hpp"

#include <net/if.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>
#include <utility>

#include "server/udp_can_frame.hpp"

namespace opentmcl::server {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

namespace {

constexpr const char* loopback_interface = "lo";

/// Seconds since 1970, for hosts that show it; nothing here depends on it.
double unix_time() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// One end of the group: a socket that hears it and one that speaks to it. What the latter sends comes back to the
/// former, recognisable by the port of its own that no other socket has.
class Member final : public CanFrameSink, public std::enable_shared_from_this<Member> {
 public:
  Member(asio::io_context& events, udp::endpoint group, std::shared_ptr<CanBus> bus, RequestsArrived requests_arrived,
         WallClock clock)
      : group_(std::move(group)),
        receiver_(events),
        sender_(events),
        bus_(std::move(bus)),
        requests_arrived_(std::move(requests_arrived)),
        clock_(std::move(clock)) {}
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;
  ~Member() { bus_->forget(*this); }

  error_code join() {
    error_code error;
    receiver_.open(group_.protocol(), error);
    if (error) return error;
    // Hosts of this machine listen at the same port.
    receiver_.set_option(udp::socket::reuse_address(true), error);
    receiver_.bind(udp::endpoint(group_.protocol(), group_.port()), error);
    if (error) return error;
    sender_.open(group_.protocol(), error);
    if (!error) sender_.bind(udp::endpoint(group_.protocol(), 0), error);
    if (!error) sender_.non_blocking(true, error);
    if (!error) receiver_.non_blocking(true, error);
    // Not even to the next router: the module is for this machine.
    if (!error) sender_.set_option(asio::ip::multicast::hops(0), error);
    if (error) return error;
    // Where the operating system's routes lead, as hosts do; without a network that is nowhere.
    receiver_.set_option(asio::ip::multicast::join_group(group_.address()), error);
    return error ? join_on_loopback() : error;
  }

  void receive() {
    receiver_.async_wait(udp::socket::wait_read, [self = shared_from_this()](const error_code& error) {
      if (error == asio::error::operation_aborted) return;
      if (!error) self->take_packet();
      self->receive();
    });
  }

  void send(const hal::CanFrame& frame) override {
    // As on a bus that is disturbed, a frame may get lost.
    error_code ignored;
    sender_.send_to(asio::buffer(encode_udp_can_frame(frame, unix_time())), group_, 0, ignored);
  }

 private:
  error_code join_on_loopback() {
    using asio::ip::address_v4;
    namespace multicast = asio::ip::multicast;
    error_code error;
    if (group_.address().is_v4()) {
      receiver_.set_option(multicast::join_group(group_.address().to_v4(), address_v4::loopback()), error);
      if (!error) sender_.set_option(multicast::outbound_interface(address_v4::loopback()), error);
    } else {
      const unsigned index = ::if_nametoindex(loopback_interface);
      receiver_.set_option(multicast::join_group(group_.address().to_v6(), index), error);
      if (!error) sender_.set_option(multicast::outbound_interface(index), error);
    }
    return error;
  }

  void take_packet() {
    std::array<std::uint8_t, longest_packet> packet;  // NOLINT(cppcoreguidelines-pro-type-member-init): read into
    udp::endpoint from;
    error_code error;
    const std::size_t count = receiver_.receive_from(asio::buffer(packet), from, 0, error);
    if (error || !is_of_this_machine(from)) return;
    const auto frame = decode_udp_can_frame(std::span(packet).first(count));
    if (!frame) return;
    bus_->push(*frame, *this);
    requests_arrived_(clock_());
  }

  /// And not of the module itself. An address is one of this machine's when a socket can be bound to it.
  bool is_of_this_machine(const udp::endpoint& from) {
    error_code error;
    if (from.port() == sender_.local_endpoint(error).port()) return false;
    if (from.address() == trusted_ || from.address().is_loopback()) return true;
    udp::socket probe(receiver_.get_executor());
    probe.open(from.protocol(), error);
    if (!error) probe.bind(udp::endpoint(from.address(), 0), error);
    if (error) return false;
    trusted_ = from.address();
    return true;
  }

  /// More than python-can ever sends.
  static constexpr std::size_t longest_packet = 4096;

  udp::endpoint group_;
  udp::socket receiver_;
  udp::socket sender_;
  std::shared_ptr<CanBus> bus_;
  RequestsArrived requests_arrived_;
  WallClock clock_;
  asio::ip::address trusted_;  // the last address of this machine that was seen
};

}  // namespace

client::Result<CanUdpEndpoint> CanUdpEndpoint::join(asio::io_context& events, const std::string& group,
                                                    std::uint16_t port, std::shared_ptr<CanBus> bus,
                                                    RequestsArrived requests_arrived, WallClock clock) {
  error_code error;
  const asio::ip::address address = asio::ip::make_address(group, error);
  if (error || !address.is_multicast() || port == 0) {
    return client::Error{client::ErrorKind::usage,
                         "\"" + group + "\" port " + std::to_string(port) +
                             " is no multicast group: expected an address such as 239.74.163.2 and a port from 1 on",
                         {}};
  }
  const std::string url = "udp://" + (address.is_v6() ? "[" + group + "]" : group) + ":" + std::to_string(port);
  const auto member = std::make_shared<Member>(events, udp::endpoint(address, port), std::move(bus),
                                               std::move(requests_arrived), std::move(clock));
  if (error = member->join(); error) {
    return client::Error{client::ErrorKind::input_output, "cannot join " + url + ": " + error.message(), {}};
  }
  member->receive();
  return CanUdpEndpoint(url);
}

}  // namespace opentmcl::server
