#include "server/socket_can_endpoint.hpp"

#include <linux/can.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <system_error>
#include <utility>

namespace opentmcl::server {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

/// Moves frames between a socket and the bus; lives as long as the socket gives any.
class Node final : public CanFrameSink, public std::enable_shared_from_this<Node> {
 public:
  using Stream = asio::posix::basic_stream_descriptor<asio::io_context::executor_type>;

  Node(Stream socket, std::shared_ptr<CanBus> bus, RequestsArrived requests_arrived, WallClock clock)
      : socket_(std::move(socket)),
        bus_(std::move(bus)),
        requests_arrived_(std::move(requests_arrived)),
        clock_(std::move(clock)) {
    socket_.non_blocking(true);
  }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node() { bus_->forget(*this); }

  void read() {
    socket_.async_read_some(asio::buffer(&frame_, sizeof frame_),
                            [self = shared_from_this()](const error_code& error, std::size_t count) {
                              if (error) return;
                              if (count == sizeof self->frame_) self->take();
                              self->read();
                            });
  }

  void send(const hal::CanFrame& frame) override {
    can_frame sent{};
    sent.can_id = frame.id | (frame.is_extended ? CAN_EFF_FLAG : 0U);
    sent.can_dlc = frame.length;
    std::copy_n(frame.data, frame.length, sent.data);
    // A full transmit queue means that nobody acknowledges; then the frame is lost, as on any bus without nodes.
    error_code ignored;
    socket_.write_some(asio::buffer(&sent, sizeof sent), ignored);
  }

 private:
  void take() {
    if ((frame_.can_id & (CAN_RTR_FLAG | CAN_ERR_FLAG)) != 0) return;
    hal::CanFrame frame;
    frame.is_extended = (frame_.can_id & CAN_EFF_FLAG) != 0;
    frame.id = frame_.can_id & (frame.is_extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.length = std::min<std::uint8_t>(frame_.can_dlc, sizeof frame.data);
    std::copy_n(frame_.data, frame.length, frame.data);
    bus_->push(frame, *this);
    requests_arrived_(clock_());
  }

  Stream socket_;
  std::shared_ptr<CanBus> bus_;
  RequestsArrived requests_arrived_;
  WallClock clock_;
  can_frame frame_{};
};

client::Error no_can(const std::string& interface, const std::string& why) {
  return {client::ErrorKind::no_such_device, "cannot use the CAN interface \"" + interface + "\": " + why, {}};
}

std::string system_message() {
  return std::generic_category().message(errno);
}

}  // namespace

client::Result<SocketCanEndpoint> SocketCanEndpoint::open(asio::io_context& events, const std::string& interface,
                                                          std::shared_ptr<CanBus> bus, RequestsArrived requests_arrived,
                                                          WallClock clock) {
  client::FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  if (!socket.is_open()) {
    const bool is_missing = errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT;
    return no_can(interface, is_missing ? "this kernel has no SocketCAN" : system_message());
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) return no_can(interface, system_message());
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return no_can(interface, system_message());
  }
  serve(events, std::move(socket), std::move(bus), std::move(requests_arrived), std::move(clock));
  return SocketCanEndpoint(interface);
}

void SocketCanEndpoint::serve(asio::io_context& events, client::FileDescriptor socket, std::shared_ptr<CanBus> bus,
                              RequestsArrived requests_arrived, WallClock clock) {
  std::make_shared<Node>(Node::Stream(events, socket.release()), std::move(bus), std::move(requests_arrived),
                         std::move(clock))
      ->read();
}

}  // namespace opentmcl::server
