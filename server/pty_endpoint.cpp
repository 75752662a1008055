#include "server/pty_endpoint.hpp"

#include <fcntl.h>
#include <termios.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "server/stream_line.hpp"

namespace opentmcl::server {

namespace {

client::Error no_pty() {
  return {
      client::ErrorKind::input_output, "cannot make a pseudo terminal: " + std::generic_category().message(errno), {}};
}

/// Bytes pass unchanged and unechoed even before a host has configured the port.
bool make_raw(int terminal) {
  termios settings{};
  if (::tcgetattr(terminal, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  return ::tcsetattr(terminal, TCSANOW, &settings) == 0;
}

}  // namespace

client::Result<PtyEndpoint> PtyEndpoint::open(boost::asio::io_context& events, RequestsArrived requests_arrived,
                                              WallClock clock) {
  client::FileDescriptor own_side(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!own_side.is_open() || ::grantpt(own_side.get()) != 0 || ::unlockpt(own_side.get()) != 0) return no_pty();
  char path[64] = {};
  if (::ptsname_r(own_side.get(), path, sizeof path) != 0) return no_pty();
  client::FileDescriptor terminal(::open(path, O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!terminal.is_open() || !make_raw(terminal.get())) return no_pty();

  auto port = std::make_shared<RequestPort>();
  using Stream = boost::asio::posix::basic_stream_descriptor<boost::asio::io_context::executor_type>;
  std::make_shared<StreamLine<Stream>>(Stream(events, own_side.release()), port, std::move(requests_arrived),
                                       std::move(clock))
      ->read();
  return PtyEndpoint(std::move(port), std::move(terminal), path);
}

}  // namespace opentmcl::server
