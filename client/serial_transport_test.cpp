#include "client/serial_transport.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>

#include <cstdlib>

#include "client/file_descriptor.hpp"

namespace opentmcl::client {
namespace {

/// A pseudo terminal in place of a serial port; the test has its other end.
struct SerialTransportTest : testing::Test {
  SerialTransportTest() : other_end(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (!other_end.is_open() || ::grantpt(other_end.get()) != 0 || ::unlockpt(other_end.get()) != 0) {
      throw std::runtime_error("no pseudo terminal");
    }
    path = ::ptsname(other_end.get());
  }

  ErrorKind kind_of_error(const std::string& port, unsigned baud_rate = default_baud_rate) {
    const auto opened = open_serial(port, baud_rate);
    return opened.ok() ? ErrorKind::internal : opened.error().kind;
  }

  FileDescriptor other_end;
  std::string path;
};

TEST_F(SerialTransportTest, CarriesEveryByteUnchanged) {
  auto port = open_serial(path, 115200);
  ASSERT_TRUE(port.ok()) << port.error().message;
  std::uint8_t all[256];
  for (unsigned i = 0; i < 256; ++i) all[i] = static_cast<std::uint8_t>(i);
  ASSERT_TRUE((*port)->send(all).ok());
  std::uint8_t received[256] = {};
  std::size_t count = 0;
  while (count < sizeof received) {
    const ssize_t part = ::read(other_end.get(), received + count, sizeof received - count);
    ASSERT_GT(part, 0);
    count += static_cast<std::size_t>(part);
  }
  EXPECT_TRUE(std::equal(std::begin(all), std::end(all), received));
  termios settings{};
  ASSERT_EQ(0, ::tcgetattr(other_end.get(), &settings));
  EXPECT_EQ(B115200, ::cfgetospeed(&settings));
}

TEST_F(SerialTransportTest, IsClosedToASecondUser) {
  const auto first = open_serial(path);
  ASSERT_TRUE(first.ok()) << first.error().message;
  const auto second = open_serial(path);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(ErrorKind::no_such_device, second.error().kind);
  EXPECT_NE(std::string::npos, second.error().message.find("in use"));
}

TEST_F(SerialTransportTest, SaysWhatIsWrongWithThePort) {
  EXPECT_EQ(ErrorKind::no_such_device, kind_of_error("/dev/no_such_port"));
  EXPECT_EQ(ErrorKind::no_such_device, kind_of_error("/dev/null"));
  EXPECT_EQ(ErrorKind::usage, kind_of_error(path, 12345));
}

}  // namespace
}  // namespace opentmcl::client
