#include "editor/dap/base64.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace opentmcl::editor::dap {
namespace {

std::string encoded(std::string_view text) {
  return base64({text.begin(), text.end()});
}

/// RFC 4648, section 10.
TEST(Base64, EncodesTheExamplesOfItsStandard) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Base64, HasASignForEachValue) {
  EXPECT_EQ(base64({0x00, 0x10, 0x83, 0xFB, 0xFF, 0xBF}), "ABCD+/+/");
}

}  // namespace
}  // namespace opentmcl::editor::dap
