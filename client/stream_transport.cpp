#include "client/stream_transport.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <thread>

namespace opentmcl::client {

namespace {

/// How long a port may refuse to take nine bytes: at 9600 baud they need 10 ms.
constexpr Duration send_limit = std::chrono::seconds(1);

std::string system_message(int error) {
  return std::generic_category().message(error);
}

/// Waits for `events` (POLLIN, POLLOUT), for errors, or until `limit` has passed. A signal starts it anew: whoever
/// wants to react to Ctrl-C looks at its flag between two commands.
bool wait_for(int descriptor, short events, Duration limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (true) {
    const auto left =
        std::max(std::chrono::nanoseconds(0), std::chrono::nanoseconds(deadline - std::chrono::steady_clock::now()));
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    timespec timeout{};
    timeout.tv_sec = static_cast<time_t>(seconds.count());
    timeout.tv_nsec = static_cast<long>((left - seconds).count());
    pollfd request{descriptor, events, 0};
    const int ready = ::ppoll(&request, 1, &timeout, nullptr);
    if (ready > 0) return true;
    if (ready == 0) return false;
    if (errno != EINTR) return true;  // the read or write that follows reports it
  }
}

}  // namespace

StreamTransport::StreamTransport(FileDescriptor stream, std::string name)
    : stream_(std::move(stream)), name_(std::move(name)) {
  const int flags = ::fcntl(stream_.get(), F_GETFL);
  ::fcntl(stream_.get(), F_SETFL, flags | O_NONBLOCK);
}

Error StreamTransport::gone(const std::string& reason) const {
  return {ErrorKind::input_output, name_ + " is gone: " + reason + ". Was it unplugged or its program ended?", {}};
}

Result<void> StreamTransport::send(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(stream_.get(), bytes.data(), bytes.size());
    if (written >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) return gone(system_message(errno));
    if (!wait_for(stream_.get(), POLLOUT, send_limit)) {
      return Error{ErrorKind::input_output, name_ + " takes no more bytes: is anybody reading at the other end?", {}};
    }
  }
  return {};
}

Result<std::size_t> StreamTransport::receive(std::span<std::uint8_t> buffer, Duration limit) {
  if (!wait_for(stream_.get(), POLLIN, limit)) return std::size_t{0};
  const ssize_t count = ::read(stream_.get(), buffer.data(), buffer.size());
  if (count > 0) return static_cast<std::size_t>(count);
  if (count == 0) return gone("the other end closed the connection");
  if (errno == EAGAIN || errno == EINTR) return std::size_t{0};
  return gone(system_message(errno));
}

void StreamTransport::drain() {
  std::uint8_t dropped[256];
  while (::read(stream_.get(), dropped, sizeof dropped) > 0) {
  }
}

void StreamTransport::pause(Duration duration) {
  std::this_thread::sleep_for(duration);
}

Duration StreamTransport::now() const {
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace opentmcl::client
