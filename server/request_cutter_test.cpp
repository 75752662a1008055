#include "server/request_cutter.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace opentmcl::server {
namespace {

struct Nobody final : ReplySink {
  void reply(std::span<const std::uint8_t>) override {}
};

struct RequestCutterTest : testing::Test {
  bool take(const std::string& bytes, Microseconds now = 0) {
    const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    return cutter.take(copy, now, port, sender);
  }
  /// All that the firmware can read.
  std::string read() {
    std::string all;
    std::uint8_t buffer[datagram_size];
    for (std::size_t count = 1; count > 0; all.append(buffer, buffer + count)) count = port.read(buffer, sizeof buffer);
    return all;
  }

  RequestPort port;
  Nobody sender;
  RequestCutter cutter;
};

TEST_F(RequestCutterTest, HandsOverWholeRequestsOnly) {
  EXPECT_FALSE(take("12345678"));
  EXPECT_EQ(0u, port.size());
  EXPECT_TRUE(take("9123456789"));
  EXPECT_EQ(2u, port.size());
  EXPECT_EQ("123456789123456789", read());
  EXPECT_FALSE(take("1"));
}

TEST_F(RequestCutterTest, DropsHalfARequestAfterSilence) {
  EXPECT_FALSE(take("1234"));
  EXPECT_TRUE(take("abcdefghi", Framer::gap + 1));
  EXPECT_EQ("abcdefghi", read());
}

TEST_F(RequestCutterTest, PassesTextAsItComes) {
  port.set_text_mode(true);
  EXPECT_TRUE(take("A"));
  EXPECT_EQ("A", read());
  EXPECT_TRUE(take("GAP 1, 0\r"));
  EXPECT_EQ(9u, port.size());
  EXPECT_EQ("GAP 1, 0\r", read());
}

TEST_F(RequestCutterTest, LosesNothingThatCameWithTheCommandThatEntersTheAsciiMode) {
  EXPECT_TRUE(take("139139139AGAP 1, 0\rABIN\r"));
  EXPECT_FALSE(cutter.take_rest(port, sender)) << "not before the firmware has read the command";
  EXPECT_EQ("139139139AGAP 1, 0", read().substr(0, 18));
  port.set_text_mode(true);
  EXPECT_TRUE(cutter.take_rest(port, sender));
  EXPECT_EQ("\rABIN\r", read());
  EXPECT_FALSE(cutter.take_rest(port, sender));
}

TEST_F(RequestCutterTest, LosesNoRequestThatCameInOnePieceWithTextAndBothChanges) {
  EXPECT_TRUE(take("139139139ABIN\r1234"));
  EXPECT_EQ("139139139ABIN\r1234", read());
  EXPECT_FALSE(take("5678"));
  port.set_text_mode(true);
  port.set_text_mode(false);
  EXPECT_TRUE(cutter.take_rest(port, sender));
  EXPECT_EQ("5678", read());
}

TEST_F(RequestCutterTest, CutsRequestsAgainAfterText) {
  port.set_text_mode(true);
  EXPECT_TRUE(take("ABIN\r"));
  read();
  port.set_text_mode(false);
  EXPECT_FALSE(take("1234"));
  EXPECT_TRUE(take("56789"));
  EXPECT_EQ("123456789", read());
}

}  // namespace
}  // namespace opentmcl::server
