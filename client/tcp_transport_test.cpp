#include "client/tcp_transport.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "client/file_descriptor.hpp"

namespace opentmcl::client {
namespace {

/// A socket that listens on a free port of this machine.
struct Listener {
  Listener() : socket(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    auto* plain = reinterpret_cast<sockaddr*>(&address);
    if (::bind(socket.get(), plain, length) != 0 || ::listen(socket.get(), 1) != 0 ||
        ::getsockname(socket.get(), plain, &length) != 0) {
      throw std::runtime_error("cannot listen");
    }
    port = ::ntohs(address.sin_port);
  }

  FileDescriptor socket;
  unsigned port = 0;
};

TEST(TcpTransport, ConnectsToANameOrAnAddress) {
  const Listener listener;
  for (const char* host : {"127.0.0.1", "localhost"}) {
    const auto connection = connect_tcp(host, listener.port, std::chrono::seconds(10));
    ASSERT_TRUE(connection.ok()) << connection.error().message;
    EXPECT_EQ(std::string("tcp://") + host + ":" + std::to_string(listener.port), (*connection)->name());
    const FileDescriptor accepted(::accept(listener.socket.get(), nullptr, nullptr));
    const std::uint8_t sent[] = {7};
    ASSERT_TRUE((*connection)->send(sent).ok());
    std::uint8_t received = 0;
    EXPECT_EQ(1, ::read(accepted.get(), &received, 1));
    EXPECT_EQ(7, received);
  }
}

TEST(TcpTransport, SaysThatNobodyListens) {
  unsigned port = 0;
  {
    const Listener listener;
    port = listener.port;
  }
  const auto connection = connect_tcp("127.0.0.1", port, std::chrono::seconds(10));
  ASSERT_FALSE(connection.ok());
  EXPECT_EQ(ErrorKind::no_such_device, connection.error().kind);
}

TEST(TcpTransport, SaysThatTheHostIsUnknown) {
  const auto connection = connect_tcp("no such host", 5160, std::chrono::seconds(10));
  ASSERT_FALSE(connection.ok());
  EXPECT_EQ(ErrorKind::no_such_device, connection.error().kind);
}

}  // namespace
}  // namespace opentmcl::client
