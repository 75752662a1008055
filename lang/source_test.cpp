#include "lang/source.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace opentmcl::lang {
namespace {

TEST(LineIndex, CountsLinesAtEveryKindOfLineEnd) {
  const LineIndex lines("one\ntwo\rthree\r\nfour");
  ASSERT_EQ(lines.line_count(), 4U);
  EXPECT_EQ(lines.line(1), "one");
  EXPECT_EQ(lines.line(2), "two");
  EXPECT_EQ(lines.line(3), "three");
  EXPECT_EQ(lines.line(4), "four");
}

TEST(LineIndex, HasAnEmptyLastLineAfterAFinalLineEnd) {
  const LineIndex lines("one\n");
  ASSERT_EQ(lines.line_count(), 2U);
  EXPECT_EQ(lines.line(2), "");
}

TEST(LineIndex, FindsLineAndColumnOfAnOffset) {
  const LineIndex lines("ab\r\ncd\n");
  EXPECT_EQ(lines.position_of(0), (Position{1, 1}));
  EXPECT_EQ(lines.position_of(1), (Position{1, 2}));
  EXPECT_EQ(lines.position_of(4), (Position{2, 1}));
  EXPECT_EQ(lines.position_of(5), (Position{2, 2}));
  EXPECT_EQ(lines.position_of(7), (Position{3, 1}));
}

TEST(LineIndex, CountsColumnsInCharactersOfUtf8AndOfLatin1) {
  EXPECT_EQ(LineIndex("\xC3\xA4x").position_of(2), (Position{1, 2}));
  EXPECT_EQ(LineIndex("\xE4x").position_of(1), (Position{1, 2}));
}

TEST(Sources, KeepsTextsInPlaceWhileFilesAreAddedAndTheWholeIsMoved) {
  Sources sources;
  sources.add("first", "short");
  const char* const place = sources[0].text.data();
  for (int i = 0; i < 1000; ++i) sources.add("other", std::string(100, 'x'));
  const Sources moved = std::move(sources);
  EXPECT_EQ(moved[0].text.data(), place);
  EXPECT_EQ(moved.text_of({0, 1, 3}), "hor");
}

TEST(ToUtf8, LeavesUtf8AndTurnsTheRestFromLatin1) {
  EXPECT_EQ(to_utf8("\xC3\xA4 \xE2\x82\xAC"), "\xC3\xA4 \xE2\x82\xAC");
  EXPECT_EQ(to_utf8("\xE4"), "\xC3\xA4");
  EXPECT_EQ(to_utf8("\xC3"), "\xC3\x83");
}

}  // namespace
}  // namespace opentmcl::lang
