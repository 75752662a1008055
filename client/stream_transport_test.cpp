#include "client/stream_transport.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

namespace opentmcl::client {
namespace {

struct StreamTransportTest : testing::Test {
  StreamTransportTest() {
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("no socket pair");
    far_end = FileDescriptor(ends[1]);
    near_end = std::make_unique<StreamTransport>(FileDescriptor(ends[0]), "pair");
  }

  FileDescriptor far_end;
  std::unique_ptr<StreamTransport> near_end;
  std::uint8_t buffer[9] = {};
};

TEST_F(StreamTransportTest, CarriesBytesBothWays) {
  const std::uint8_t sent[] = {1, 2, 3};
  ASSERT_TRUE(near_end->send(sent).ok());
  ASSERT_EQ(3, ::read(far_end.get(), buffer, sizeof buffer));
  EXPECT_EQ(2, buffer[1]);
  ASSERT_EQ(3, ::write(far_end.get(), sent, sizeof sent));
  const Result<std::size_t> count = near_end->receive(buffer, std::chrono::seconds(10));
  ASSERT_TRUE(count.ok());
  EXPECT_EQ(3u, *count);
}

TEST_F(StreamTransportTest, ReturnsNothingWhenTheTimeIsUp) {
  const Result<std::size_t> count = near_end->receive(buffer, std::chrono::milliseconds(1));
  ASSERT_TRUE(count.ok());
  EXPECT_EQ(0u, *count);
}

TEST_F(StreamTransportTest, DropsWhatNobodyAskedFor) {
  ASSERT_EQ(9, ::write(far_end.get(), buffer, 9));
  near_end->drain();
  const Result<std::size_t> count = near_end->receive(buffer, Duration(0));
  ASSERT_TRUE(count.ok());
  EXPECT_EQ(0u, *count);
}

TEST_F(StreamTransportTest, SaysThatTheOtherEndIsGone) {
  far_end.close();
  const Result<std::size_t> count = near_end->receive(buffer, std::chrono::seconds(10));
  ASSERT_FALSE(count.ok());
  EXPECT_EQ(ErrorKind::input_output, count.error().kind);
  EXPECT_NE(std::string::npos, count.error().message.find("pair is gone"));
}

}  // namespace
}  // namespace opentmcl::client
