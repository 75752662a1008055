#include "client/port_address.hpp"

#include <gtest/gtest.h>

namespace opentmcl::client {
namespace {

template <class Kind>
Kind parsed(const char* text) {
  const Result<PortAddress> address = parse_port_address(text);
  return std::get<Kind>(address.value());
}

TEST(PortAddress, IsAPath) {
  EXPECT_EQ("/dev/ttyACM0", parsed<SerialAddress>("/dev/ttyACM0").path);
  EXPECT_EQ("./link", parsed<SerialAddress>("./link").path);
}

TEST(PortAddress, IsAHostAndAPort) {
  EXPECT_EQ("127.0.0.1", parsed<TcpAddress>("tcp://127.0.0.1:5160").host);
  EXPECT_EQ(5160U, parsed<TcpAddress>("tcp://127.0.0.1:5160").port);
  EXPECT_EQ("gateway.example", parsed<TcpAddress>("tcp://gateway.example:1").host);
  EXPECT_EQ("::1", parsed<TcpAddress>("tcp://[::1]:65535").host);
}

TEST(PortAddress, IsAVirtualModule) {
  EXPECT_EQ("pd1161", parsed<SimulatedAddress>("sim:pd1161").module);
}

TEST(PortAddress, IsRefusedWithWhatWasExpected) {
  for (const char* text : {"", "ttyACM0", "tcp://host", "tcp://:1", "tcp://host:0", "tcp://host:65536", "tcp://host:1x",
                           "tcp://::1:5", "http://host/x", "can://can0"}) {
    const Result<PortAddress> address = parse_port_address(text);
    ASSERT_FALSE(address.ok()) << text;
    EXPECT_EQ(ErrorKind::usage, address.error().kind);
    EXPECT_NE(std::string::npos, address.error().message.find("expected")) << text;
  }
}

}  // namespace
}  // namespace opentmcl::client
