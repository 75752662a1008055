#include "client/serial_transport.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <termios.h>

#include <cerrno>
#include <optional>
#include <system_error>

#include "client/stream_transport.hpp"

namespace opentmcl::client {

namespace {

struct BaudRate {
  unsigned rate;
  speed_t code;
};

/// The rates of global parameter 65 that Linux has a constant for.
constexpr BaudRate baud_rates[] = {{9600, B9600},     {19200, B19200},   {38400, B38400},   {57600, B57600},
                                   {115200, B115200}, {230400, B230400}, {500000, B500000}, {1000000, B1000000}};

std::optional<speed_t> code_of(unsigned rate) {
  for (const BaudRate& row : baud_rates) {
    if (row.rate == rate) return row.code;
  }
  return std::nullopt;
}

Error cannot_open(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return {ErrorKind::no_such_device,
              "there is no " + path + ": is the module plugged in, the virtual one running?",
              {}};
    case EACCES:
    case EPERM:
      return {ErrorKind::no_such_device,
              "no permission to open " + path +
                  ": its group is usually dialout; become a member (adduser USER dialout) and log in again",
              {}};
    case EBUSY:
      return {ErrorKind::no_such_device, path + " is in use by another program", {}};
    default:
      return {ErrorKind::input_output, "cannot open " + path + ": " + std::generic_category().message(error), {}};
  }
}

}  // namespace

Result<std::unique_ptr<Transport>> open_serial(const std::string& path, unsigned baud_rate) {
  const std::optional<speed_t> speed = code_of(baud_rate);
  if (!speed) {
    return Error{ErrorKind::usage,
                 "no baud rate " + std::to_string(baud_rate) +
                     ": one of 9600, 19200, 38400, 57600, 115200, 230400, 500000, 1000000 is possible",
                 {}};
  }
  // Without O_NONBLOCK, opening a port that has no carrier would wait for one.
  FileDescriptor port(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port.is_open()) return cannot_open(path, errno);

  termios settings{};
  if (::tcgetattr(port.get(), &settings) != 0) {
    return Error{ErrorKind::no_such_device, path + " is not a serial port", {}};
  }
  // Not TIOCEXCL: on a pseudo terminal, whose other end stays open, it would outlive a program that was killed.
  if (::flock(port.get(), LOCK_EX | LOCK_NB) != 0) return cannot_open(path, errno == EWOULDBLOCK ? EBUSY : errno);

  ::cfmakeraw(&settings);
  settings.c_cflag |= static_cast<tcflag_t>(CLOCAL | CREAD);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  ::cfsetispeed(&settings, *speed);
  ::cfsetospeed(&settings, *speed);
  if (::tcsetattr(port.get(), TCSANOW, &settings) != 0) return cannot_open(path, errno);
  ::tcflush(port.get(), TCIOFLUSH);
  return std::unique_ptr<Transport>(std::make_unique<StreamTransport>(std::move(port), path));
}

}  // namespace opentmcl::client
