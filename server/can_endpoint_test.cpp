// The bus of a module behind a serial adapter, a UDP multicast group and a socket, with hosts in the same thread.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>
#include <optional>
#include <thread>

#include "client/serial_transport.hpp"
#include "server/can_udp_endpoint.hpp"
#include "server/slcan_endpoint.hpp"
#include "server/socket_can_endpoint.hpp"
#include "server/udp_can_frame.hpp"

namespace opentmcl::server {
namespace {

using boost::asio::ip::udp;

/// A bus with something on it that sends every frame back with the next identifier.
struct CanHosts : testing::Test {
  CanHosts() { bus->join(1'000'000); }

  void answer() {
    hal::CanFrame frame;
    while (bus->read(frame)) {
      ++frame.id;
      bus->write(frame);
    }
  }
  RequestsArrived answers() {
    return [this](WallTime) { answer(); };
  }

  /// Turns the event loop until `condition` holds, or for ten seconds.
  template <class Condition>
  void run_until(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    bool holds = condition();
    while (!holds && std::chrono::steady_clock::now() < deadline) {
      events.run_one_for(std::chrono::milliseconds(1));
      holds = condition();
    }
    EXPECT_TRUE(holds);
  }

  boost::asio::io_context events;
  std::shared_ptr<SharedCanPort> bus = std::make_shared<SharedCanPort>();
};

struct SlcanEndpointTest : CanHosts {
  SlcanEndpointTest() : endpoint(SlcanEndpoint::open(events, bus, answers())) {}

  std::unique_ptr<client::Transport> open() {
    auto host = client::open_serial(endpoint->path());
    EXPECT_TRUE(host.ok());
    return std::move(*host);
  }
  static void type(client::Transport& host, std::string_view text) {
    ASSERT_TRUE(host.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}).ok());
  }
  std::string hear(client::Transport& host, std::size_t length) {
    std::string heard(length, ' ');
    std::size_t received = 0;
    run_until([&] {
      const auto rest = std::span(reinterpret_cast<std::uint8_t*>(heard.data()), length).subspan(received);
      if (const auto count = host.receive(rest, std::chrono::milliseconds(0))) received += *count;
      return received == length;
    });
    return heard.substr(0, received);
  }
  void expect(client::Transport& host, std::string_view question, std::string_view answer) {
    type(host, question);
    EXPECT_EQ(answer, hear(host, answer.size()));
  }

  client::Result<SlcanEndpoint> endpoint;
};

TEST_F(SlcanEndpointTest, CarriesFramesOfAHost) {
  const auto host = open();
  expect(*host, "C\rS8\rO\rO\r", "\a\r\r\a");
  expect(*host, "t0012ABCD\r", "z\rt0022ABCD\r");
  expect(*host, "T000000010\r", "Z\rT000000020\r");
}

TEST_F(SlcanEndpointTest, OutlivesHostsThatComeAndGo) {
  for (int i = 0; i < 50; ++i) {
    const auto host = open();
    expect(*host, i == 0 ? "O\r" : "C\rO\r", i == 0 ? "\r" : "\r\r");
    expect(*host, "t0010\r", "z\rt0020\r");
  }
}

TEST_F(SlcanEndpointTest, KeepsTheRepliesOfAHostThatIsSlowToRead) {
  const auto host = open();
  expect(*host, "O\r", "\r");
  constexpr int count = 5000;
  std::thread sender([&] {
    for (int i = 0; i < count; ++i) type(*host, "t00180102030405060708\r");
  });
  const std::string reply = "z\rt00280102030405060708\r";
  std::string expected;
  for (int i = 0; i < count; ++i) expected += reply;
  const std::string heard = hear(*host, expected.size());
  sender.join();
  // What came together is acknowledged together: only the order within each of the two kinds is given.
  const auto frames = [](std::string text) {
    for (std::size_t at = text.find("z\r"); at != std::string::npos; at = text.find("z\r", at)) text.erase(at, 2);
    return text;
  };
  EXPECT_EQ(frames(heard), frames(expected));
}

/// A host on the loopback interface; like all of the group it hears itself too.
class UdpHost {
 public:
  UdpHost(boost::asio::io_context& events, const udp::endpoint& group) : group_(group), socket_(events) {
    namespace multicast = boost::asio::ip::multicast;
    const auto loopback = boost::asio::ip::address_v4::loopback();
    socket_.open(group.protocol());
    socket_.set_option(udp::socket::reuse_address(true));
    socket_.bind(udp::endpoint(group.protocol(), group.port()));
    socket_.set_option(multicast::join_group(group.address().to_v4(), loopback));
    socket_.set_option(multicast::outbound_interface(loopback));
    socket_.non_blocking(true);
  }

  void send_packet(const std::vector<std::uint8_t>& packet) { socket_.send_to(boost::asio::buffer(packet), group_); }
  void send(const hal::CanFrame& frame) { send_packet(encode_udp_can_frame(frame, 0)); }

  /// Whether a frame with this identifier was heard by now.
  bool has_heard(std::uint32_t id) {
    std::array<std::uint8_t, 4096> packet{};
    boost::system::error_code error;
    while (true) {
      const std::size_t count = socket_.receive(boost::asio::buffer(packet), 0, error);
      if (error) break;
      if (const auto frame = decode_udp_can_frame(std::span(packet).first(count))) heard.push_back(*frame);
    }
    return std::any_of(heard.begin(), heard.end(), [id](const hal::CanFrame& frame) { return frame.id == id; });
  }

  std::vector<hal::CanFrame> heard;

 private:
  udp::endpoint group_;
  udp::socket socket_;
};

struct CanUdpEndpointTest : CanHosts {
  static std::uint16_t free_port() {
    boost::asio::io_context nothing;
    return udp::socket(nothing, udp::endpoint(udp::v4(), 0)).local_endpoint().port();
  }

  const std::string group = "239.74.163.99";
  const std::uint16_t port = free_port();
  const udp::endpoint group_endpoint{boost::asio::ip::make_address(group), port};
  client::Result<CanUdpEndpoint> endpoint = CanUdpEndpoint::join(events, group, port, bus, answers());
};

TEST_F(CanUdpEndpointTest, AnswersAHost) {
  ASSERT_TRUE(endpoint.ok()) << endpoint.error().message;
  UdpHost host(events, group_endpoint);
  host.send({5, false, 3, {1, 2, 3}});
  run_until([&] { return host.has_heard(6); });
  const hal::CanFrame& reply = host.heard.back();
  EXPECT_EQ(reply.length, 3);
  EXPECT_EQ(reply.data[2], 3);
}

TEST_F(CanUdpEndpointTest, DoesNotHearItself) {
  // What sends every frame back with the next identifier would never end if it did.
  UdpHost host(events, group_endpoint);
  host.send({5, false, 0, {}});
  host.send({100, false, 0, {}});
  host.send({200, false, 0, {}});
  run_until([&] { return host.has_heard(201); });
  EXPECT_EQ(host.heard.size(), 6U);
}

TEST_F(CanUdpEndpointTest, IgnoresPacketsThatAreNoFrames) {
  UdpHost host(events, group_endpoint);
  host.send_packet({});
  host.send_packet({0x81, 0xA1});
  host.send_packet(std::vector<std::uint8_t>(2000, 0xFF));
  host.send({5, false, 0, {}});
  run_until([&] { return host.has_heard(6); });
  EXPECT_EQ(host.heard.size(), 2U);
}

TEST_F(CanUdpEndpointTest, WantsAMulticastGroup) {
  for (const auto& [address, number] : {std::pair("127.0.0.1", std::uint16_t{5000}), std::pair("somewhere", port),
                                        std::pair("239.1.1.1", std::uint16_t{0}), std::pair("::1", port)}) {
    const auto another = CanUdpEndpoint::join(events, address, number, bus, answers());
    ASSERT_FALSE(another.ok()) << address;
    EXPECT_EQ(client::ErrorKind::usage, another.error().kind);
  }
}

TEST_F(CanUdpEndpointTest, SaysWhereItIs) {
  EXPECT_EQ(endpoint->url(), "udp://239.74.163.99:" + std::to_string(port));
}

struct SocketCanEndpointTest : CanHosts {
  SocketCanEndpointTest() {
    int ends[2];
    EXPECT_EQ(0, ::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends));
    host = client::FileDescriptor(ends[0]);
    SocketCanEndpoint::serve(events, client::FileDescriptor(ends[1]), bus, answers());
  }

  can_frame exchange(const can_frame& frame) {
    EXPECT_EQ(ssize_t{sizeof frame}, ::send(host.get(), &frame, sizeof frame, 0));
    can_frame reply{};
    run_until([&] { return ::recv(host.get(), &reply, sizeof reply, MSG_DONTWAIT) == ssize_t{sizeof reply}; });
    return reply;
  }

  client::FileDescriptor host;
};

can_frame linux_frame(std::uint32_t id, std::uint8_t length) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = length;
  for (std::uint8_t i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(i + 1);
  return frame;
}

TEST_F(SocketCanEndpointTest, CarriesFramesOfBothKinds) {
  const can_frame standard = exchange(linux_frame(1, 7));
  EXPECT_EQ(standard.can_id, 2U);
  EXPECT_EQ(standard.can_dlc, 7);
  EXPECT_EQ(standard.data[6], 7);
  EXPECT_EQ(standard.data[7], 0);
  const can_frame extended = exchange(linux_frame(0x1234'5678 | CAN_EFF_FLAG, 8));
  EXPECT_EQ(extended.can_id, 0x1234'5679 | CAN_EFF_FLAG);
  EXPECT_EQ(extended.data[7], 8);
}

TEST_F(SocketCanEndpointTest, IgnoresRemoteAndErrorFrames) {
  for (const std::uint32_t flag : {CAN_RTR_FLAG, CAN_ERR_FLAG}) {
    const can_frame ignored = linux_frame(5 | flag, 0);
    ASSERT_EQ(ssize_t{sizeof ignored}, ::send(host.get(), &ignored, sizeof ignored, 0));
  }
  EXPECT_EQ(exchange(linux_frame(1, 0)).can_id, 2U);
}

TEST_F(SocketCanEndpointTest, SaysWhatIsMissing) {
  const auto endpoint = SocketCanEndpoint::open(events, "no_such_can", bus, answers());
  ASSERT_FALSE(endpoint.ok());
  EXPECT_EQ(client::ErrorKind::no_such_device, endpoint.error().kind);
  EXPECT_NE(std::string::npos, endpoint.error().message.find("no_such_can"));
}

struct SeveralEndpoints : SlcanEndpointTest {};

TEST_F(SeveralEndpoints, GetEachItsOwnReplies) {
  const auto second = SlcanEndpoint::open(events, bus, answers());
  const auto first_host = open();
  auto opened = client::open_serial(second->path());
  ASSERT_TRUE(opened.ok());
  const auto second_host = std::move(*opened);
  expect(*first_host, "O\r", "\r");
  expect(*second_host, "O\r", "\r");
  type(*first_host, "t1000\r");
  type(*second_host, "t2000\r");
  EXPECT_EQ(hear(*first_host, 8), "z\rt1010\r");
  EXPECT_EQ(hear(*second_host, 8), "z\rt2010\r");
}

}  // namespace
}  // namespace opentmcl::server
