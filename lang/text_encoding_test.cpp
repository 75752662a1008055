#include "lang/text_encoding.hpp"

#include <gtest/gtest.h>

#include <string>

namespace opentmcl::lang {
namespace {

TEST(TextEncoding, KnowsUtf16WithAndWithoutMark) {
  EXPECT_TRUE(is_utf16(std::string("\xFF\xFE\x4D\x00", 4)));
  EXPECT_TRUE(is_utf16(std::string("\xFE\xFF\x00\x4D", 4)));
  EXPECT_TRUE(is_utf16(std::string("M\0S\0T\0", 6)));
  EXPECT_TRUE(is_utf16(std::string("\0M\0S\0T", 6)));
}

TEST(TextEncoding, TakesNothingElseForUtf16) {
  for (const std::string& text : {std::string(), std::string("MST 0"), std::string("\xEF\xBB\xBFMST 0"),
                                  std::string("\xE4\xF6\xFC\xDF"), std::string(8, '\0'), std::string("M\0\0\0", 4)}) {
    EXPECT_FALSE(is_utf16(text)) << text;
  }
}

TEST(TextEncoding, FindsControlCharactersThatNoTextHas) {
  EXPECT_EQ(find_control_character("MST 0 \t\v\f\r\n\xC3\xA4"), std::nullopt);
  EXPECT_EQ(find_control_character(std::string("ab\0", 3)), 2U);
  EXPECT_EQ(find_control_character("\x1B[2J"), 0U);
}

}  // namespace
}  // namespace opentmcl::lang
