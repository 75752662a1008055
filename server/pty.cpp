#include "server/pty.hpp"

#include <fcntl.h>
#include <termios.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace opentmcl::server {

namespace {

client::Error no_pty() {
  return {
      client::ErrorKind::input_output, "cannot make a pseudo terminal: " + std::generic_category().message(errno), {}};
}

bool make_raw(int terminal) {
  termios settings{};
  if (::tcgetattr(terminal, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  return ::tcsetattr(terminal, TCSANOW, &settings) == 0;
}

}  // namespace

client::Result<Pty> Pty::open() {
  client::FileDescriptor own_side(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!own_side.is_open() || ::grantpt(own_side.get()) != 0 || ::unlockpt(own_side.get()) != 0) return no_pty();
  char path[64] = {};
  if (::ptsname_r(own_side.get(), path, sizeof path) != 0) return no_pty();
  client::FileDescriptor terminal(::open(path, O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!terminal.is_open() || !make_raw(terminal.get())) return no_pty();
  return Pty{std::move(own_side), std::move(terminal), path};
}

}  // namespace opentmcl::server
