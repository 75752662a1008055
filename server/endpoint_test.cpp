// A module behind a pseudo terminal and a TCP port, with hosts in the same thread.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>

#include <boost/asio/io_context.hpp>
#include <thread>

#include "client/serial_transport.hpp"
#include "client/tcp_transport.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/pty_endpoint.hpp"
#include "server/tcp_endpoint.hpp"

namespace opentmcl::server {
namespace {

using client::Transport;

constexpr Request first_request{1, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}};
constexpr Request second_request{1, {static_cast<std::uint8_t>(Opcode::gap), 2, 0, 0}};

/// Answers a request with the request itself.
void echo(RequestPort& port) {
  std::uint8_t buffer[16];
  for (std::size_t count = port.read(buffer, sizeof buffer); count > 0; count = port.read(buffer, sizeof buffer)) {
    port.write(buffer, count);
  }
}

struct Hosts : testing::Test {
  void send(Transport& host, std::span<const std::uint8_t> bytes) { ASSERT_TRUE(host.send(bytes).ok()); }
  void send(Transport& host, const Request& request) { send(host, encode(request).bytes); }

  /// Turns the event loop until the host has nine bytes, or for ten seconds.
  Request receive(Transport& host) {
    Datagram datagram;
    std::size_t received = 0;
    const client::Duration deadline = host.now() + std::chrono::seconds(10);
    while (received < datagram_size && host.now() < deadline) {
      events.poll();
      const auto count = host.receive(std::span(datagram.bytes).subspan(received), std::chrono::milliseconds(1));
      if (!count) break;
      received += *count;
    }
    EXPECT_EQ(datagram_size, received);
    return decode_request(datagram);
  }

  boost::asio::io_context events;
};

struct PtyEndpointTest : Hosts {
  PtyEndpointTest()
      : endpoint(PtyEndpoint::open(
            events, [this](WallTime) { echo(endpoint->port()); }, [this] { return now; })) {}

  std::unique_ptr<Transport> open() {
    auto host = client::open_serial(endpoint->path());
    EXPECT_TRUE(host.ok());
    return std::move(*host);
  }

  WallTime now{};
  client::Result<PtyEndpoint> endpoint;
};

TEST_F(PtyEndpointTest, AnswersAHost) {
  const auto host = open();
  send(*host, first_request);
  EXPECT_EQ(first_request, receive(*host));
}

TEST_F(PtyEndpointTest, IsRawBeforeAnyHostConfiguresIt) {
  const client::FileDescriptor terminal(::open(endpoint->path().c_str(), O_RDWR | O_NOCTTY));
  termios settings{};
  ASSERT_EQ(0, ::tcgetattr(terminal.get(), &settings));
  EXPECT_EQ(0u, settings.c_lflag & static_cast<tcflag_t>(ECHO | ICANON | ISIG));
  EXPECT_EQ(0u, settings.c_oflag & static_cast<tcflag_t>(OPOST));
}

TEST_F(PtyEndpointTest, OutlivesHostsThatComeAndGo) {
  for (std::int32_t i = 0; i < 100; ++i) {
    const auto host = open();
    const Request request{1, {static_cast<std::uint8_t>(Opcode::mvp), 0, 0, i}};
    send(*host, request);
    ASSERT_EQ(request, receive(*host));
  }
}

TEST_F(PtyEndpointTest, HasNothingToDoWhileNoHostIsThere) {
  open();
  events.poll();
  EXPECT_EQ(0u, events.poll());
}

TEST_F(PtyEndpointTest, ForgetsHalfARequestAfterSilence) {
  const auto host = open();
  const Datagram half = encode(first_request);
  send(*host, std::span(half.bytes).first(4));
  ASSERT_EQ(1u, events.run_one_for(std::chrono::seconds(10)));
  now += std::chrono::milliseconds(6);
  send(*host, second_request);
  EXPECT_EQ(second_request, receive(*host));
}

TEST_F(PtyEndpointTest, KeepsTheRepliesOfAHostThatIsSlowToRead) {
  const auto host = open();
  constexpr int count = 5000;
  std::thread sender([&] {
    for (int i = 0; i < count; ++i) send(*host, Request{1, {1, 0, 0, i}});
  });
  for (int i = 0; i < count; ++i) ASSERT_EQ(i, receive(*host).command.value);
  sender.join();
}

TEST_F(PtyEndpointTest, ReadsNoMoreFromAHostWhoseRequestsNobodyTakes) {
  auto endpoint_without_module = PtyEndpoint::open(
      events, [](WallTime) {}, [this] { return now; });
  ASSERT_TRUE(endpoint_without_module.ok());
  auto host = client::open_serial(endpoint_without_module->path());
  constexpr int count = 2000;
  std::thread sender([&] {
    for (int i = 0; i < count; ++i) send(**host, Request{1, {1, 0, 0, i}});
  });
  RequestPort& port = endpoint_without_module->port();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  const auto run_until = [&](const auto& condition) {
    while (!condition() && std::chrono::steady_clock::now() < deadline)
      events.run_one_for(std::chrono::milliseconds(1));
    return condition();
  };
  EXPECT_TRUE(run_until([&] { return port.is_full(); }));
  events.poll();
  EXPECT_LT(port.size(), 2 * RequestPort::capacity);
  // Taken at last, they all arrive: that nobody listened was no silence of the host.
  now += std::chrono::seconds(1);
  int received = 0;
  EXPECT_TRUE(run_until([&] {
    std::uint8_t buffer[datagram_size];
    for (; port.read(buffer, sizeof buffer) > 0; ++received) EXPECT_EQ(received & 0xFF, buffer[7]);
    return received == count;
  }));
  sender.join();
}

struct TcpEndpointTest : Hosts {
  TcpEndpointTest()
      : endpoint(
            TcpEndpoint::listen(events, TcpEndpoint::local_address, 0, [this](WallTime) { echo(endpoint->port()); })) {}

  unsigned port_number() const {
    const std::string& url = endpoint->url();
    return static_cast<unsigned>(std::stoul(url.substr(url.rfind(':') + 1)));
  }
  std::unique_ptr<Transport> connect() {
    auto host = client::connect_tcp("127.0.0.1", port_number(), std::chrono::seconds(10));
    EXPECT_TRUE(host.ok());
    return std::move(*host);
  }

  client::Result<TcpEndpoint> endpoint;
};

TEST_F(TcpEndpointTest, AnswersSeveralHostsEachItsOwnRequest) {
  const auto first = connect();
  const auto second = connect();
  send(*first, first_request);
  send(*second, second_request);
  EXPECT_EQ(second_request, receive(*second));
  EXPECT_EQ(first_request, receive(*first));
}

TEST_F(TcpEndpointTest, TakesANewConnectionForEachCommand) {
  for (int i = 0; i < 20; ++i) {
    const auto host = connect();
    send(*host, first_request);
    ASSERT_EQ(first_request, receive(*host));
  }
}

TEST_F(TcpEndpointTest, LetsAHalfRequestOfOneHostNotDisturbAnother) {
  const auto first = connect();
  const auto second = connect();
  const Datagram half = encode(first_request);
  send(*first, std::span(half.bytes).first(4));
  send(*second, second_request);
  EXPECT_EQ(second_request, receive(*second));
}

TEST_F(TcpEndpointTest, SaysThatItsPortIsTaken) {
  const auto another = TcpEndpoint::listen(events, TcpEndpoint::local_address,
                                           static_cast<std::uint16_t>(port_number()), [](WallTime) {});
  ASSERT_FALSE(another.ok());
  EXPECT_EQ(client::ErrorKind::input_output, another.error().kind);
}

TEST_F(TcpEndpointTest, ListensOnAddressesOnly) {
  const auto another = TcpEndpoint::listen(events, "somewhere", 0, [](WallTime) {});
  ASSERT_FALSE(another.ok());
  EXPECT_EQ(client::ErrorKind::usage, another.error().kind);
}

}  // namespace
}  // namespace opentmcl::server
