#include "client/tcp_transport.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <system_error>

#include "client/stream_transport.hpp"

namespace opentmcl::client {

namespace {

struct AddressList {
  addrinfo* first = nullptr;
  ~AddressList() {
    if (first != nullptr) ::freeaddrinfo(first);
  }
};

/// 0, or the system's error number.
int connect_within(int socket, const addrinfo& address, Duration limit) {
  if (::connect(socket, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  pollfd request{socket, POLLOUT, 0};
  const int milliseconds = static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(limit).count());
  if (::poll(&request, 1, milliseconds) <= 0) return ETIMEDOUT;
  int error = 0;
  socklen_t length = sizeof error;
  ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &length);
  return error;
}

}  // namespace

Result<std::unique_ptr<Transport>> connect_tcp(const std::string& host, unsigned port, Duration limit) {
  const std::string service = std::to_string(port);
  const bool is_ipv6 = host.find(':') != std::string::npos;
  const std::string name = "tcp://" + (is_ipv6 ? "[" + host + "]" : host) + ":" + service;

  // "localhost" is this machine (RFC 6761), also where no file or name server says so.
  const std::string known_host = host == "localhost" ? "127.0.0.1" : host;
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  AddressList addresses;
  if (const int error = ::getaddrinfo(known_host.c_str(), service.c_str(), &wanted, &addresses.first); error != 0) {
    return Error{ErrorKind::no_such_device, "unknown host in " + name + ": " + ::gai_strerror(error), {}};
  }

  int error = 0;
  for (const addrinfo* address = addresses.first; address != nullptr; address = address->ai_next) {
    FileDescriptor socket(::socket(address->ai_family, address->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!socket.is_open()) {
      error = errno;
      continue;
    }
    error = connect_within(socket.get(), *address, limit);
    if (error != 0) continue;
    // A datagram must leave at once instead of waiting for more bytes.
    const int on = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return std::unique_ptr<Transport>(std::make_unique<StreamTransport>(std::move(socket), name));
  }
  return Error{
      ErrorKind::no_such_device, "cannot connect to " + name + ": " + std::generic_category().message(error), {}};
}

}  // namespace opentmcl::client
