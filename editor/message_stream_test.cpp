#include "editor/message_stream.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace opentmcl::editor {
namespace {

using nlohmann::json;
using State = ReadOutcome::State;

constexpr std::chrono::milliseconds at_once{0};
/// Only a hang reaches it.
constexpr std::chrono::milliseconds long_enough{60'000};

/// Two ends of a socket.
class Sockets {
 public:
  Sockets() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_), 0); }
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;
  ~Sockets() {
    close(0);
    close(1);
  }

  int operator[](int end) const { return ends_[end]; }
  void close(int end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }
  void write(int end, const std::string& bytes) const {
    EXPECT_EQ(::write(ends_[end], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

 private:
  int ends_[2] = {-1, -1};
};

TEST(DescriptorStream, CarriesMessagesBothWays) {
  const Sockets sockets;
  DescriptorStream left(sockets[0], sockets[0]);
  DescriptorStream right(sockets[1], sockets[1]);
  ASSERT_TRUE(left.write({{"text", "Grüße"}}));
  ASSERT_TRUE(left.write({1, 2}));
  EXPECT_EQ(right.read(long_enough).message, json({{"text", "Grüße"}}));
  EXPECT_TRUE(right.has_message()) << "arrived together with the first";
  EXPECT_EQ(right.read(at_once).message, json({1, 2}));
  ASSERT_TRUE(right.write(nullptr));
  const ReadOutcome answer = left.read({});
  EXPECT_EQ(answer.state, State::message);
  EXPECT_EQ(answer.message, nullptr);
}

TEST(DescriptorStream, DoesNotWaitLongerThanItMay) {
  const Sockets sockets;
  DescriptorStream stream(sockets[0], sockets[0]);
  EXPECT_EQ(stream.read(at_once).state, State::nothing_yet);
  EXPECT_EQ(stream.read(std::chrono::milliseconds(1)).state, State::nothing_yet);
  sockets.write(1, "Content-Length: 2\r\n\r\n{");
  EXPECT_EQ(stream.read(at_once).state, State::nothing_yet) << "half a message";
  sockets.write(1, "}");
  EXPECT_EQ(stream.read(at_once).state, State::message);
}

TEST(DescriptorStream, WaitsForAMessageThatComesLater) {
  const Sockets sockets;
  DescriptorStream stream(sockets[0], sockets[0]);
  std::thread editor([&] {
    sockets.write(1, "Content-Length: 4\r\n");
    sockets.write(1, "\r\ntrue");
  });
  EXPECT_EQ(stream.read(long_enough).message, true);
  editor.join();
}

TEST(DescriptorStream, SendsAMessageThatIsLargerThanThePipe) {
  const Sockets sockets;
  DescriptorStream left(sockets[0], sockets[0]);
  DescriptorStream right(sockets[1], sockets[1]);
  const json large = std::string(4 << 20, 'x');
  std::thread editor([&] { EXPECT_TRUE(right.write(large)); });
  EXPECT_EQ(left.read(long_enough).message, large);
  editor.join();
}

TEST(DescriptorStream, GoesOnAfterABodyThatIsNoJson) {
  const Sockets sockets;
  DescriptorStream stream(sockets[0], sockets[0]);
  sockets.write(1, "Content-Length: 3\r\n\r\n{\"aContent-Length: 2\r\n\r\n{}");
  const ReadOutcome bad = stream.read(at_once);
  EXPECT_EQ(bad.state, State::not_json);
  EXPECT_EQ(bad.error, "the body of a message is not JSON");
  EXPECT_EQ(stream.read(at_once).message, json::object());
}

TEST(DescriptorStream, EndsWithABadHeader) {
  const Sockets sockets;
  DescriptorStream stream(sockets[0], sockets[0]);
  sockets.write(1, "hello\r\n\r\n");
  const ReadOutcome bad = stream.read(at_once);
  EXPECT_EQ(bad.state, State::broken);
  EXPECT_EQ(bad.error, "expected a header field such as 'Content-Length: 100', not 'hello'");
  EXPECT_EQ(stream.read(at_once).state, State::broken);
}

TEST(DescriptorStream, KnowsAnEndFromACut) {
  Sockets sockets;
  DescriptorStream stream(sockets[0], sockets[0]);
  sockets.write(1, "Content-Length: 2\r\n\r\n{}");
  sockets.close(1);
  EXPECT_EQ(stream.read({}).state, State::message);
  EXPECT_EQ(stream.read({}).state, State::closed);

  Sockets others;
  DescriptorStream cut(others[0], others[0]);
  others.write(1, "Content-Length: 2\r\n\r\n{");
  others.close(1);
  const ReadOutcome outcome = cut.read({});
  EXPECT_EQ(outcome.state, State::broken);
  EXPECT_EQ(outcome.error, "the input ends within a message");
}

TEST(DescriptorStream, SaysThatNobodyReads) {
  Sockets sockets;
  std::signal(SIGPIPE, SIG_IGN);
  DescriptorStream stream(sockets[0], sockets[0]);
  sockets.close(1);
  EXPECT_FALSE(stream.write(json::object()));
}

TEST(DescriptorStream, SendsTextThatIsNotUtf8WithReplacements) {
  const Sockets sockets;
  DescriptorStream left(sockets[0], sockets[0]);
  DescriptorStream right(sockets[1], sockets[1]);
  ASSERT_TRUE(left.write("\xE4"));
  EXPECT_EQ(right.read(long_enough).message, "\xEF\xBF\xBD");
}

TEST(MemoryStream, IsAPairOfEnds) {
  auto [left, right] = MemoryStream::make_pair();
  EXPECT_EQ(left->read({}).state, State::nothing_yet);
  ASSERT_TRUE(left->write({1}));
  ASSERT_TRUE(left->write_text("{"));
  EXPECT_TRUE(right->has_message());
  EXPECT_EQ(right->read({}).message, json({1}));
  EXPECT_EQ(right->read({}).state, State::not_json);
  left.reset();
  EXPECT_EQ(right->read({}).state, State::closed);
  EXPECT_FALSE(right->write(nullptr));
}

}  // namespace
}  // namespace opentmcl::editor
