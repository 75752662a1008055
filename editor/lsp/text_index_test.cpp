#include "editor/lsp/text_index.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace opentmcl::editor::lsp {

// NOLINTNEXTLINE(readability-identifier-naming): the name is GoogleTest's
inline void PrintTo(const Position& position, std::ostream* out) {
  *out << position.line << ":" << position.character;
}

namespace {

constexpr PositionEncoding utf8 = PositionEncoding::utf8;
constexpr PositionEncoding utf16 = PositionEncoding::utf16;

TEST(TextIndex, CountsWhatTheClientCounts) {
  const std::string text = "a\n\xC3\xBC\xF0\x9F\x98\x80x\r\n";
  const TextIndex in_utf8(text, utf8);
  const TextIndex in_utf16(text, utf16);
  EXPECT_EQ(in_utf8.position_of(8), (Position{1, 6}));
  EXPECT_EQ(in_utf16.position_of(8), (Position{1, 3}));
  EXPECT_EQ(in_utf8.offset_of({1, 6}), 8U);
  EXPECT_EQ(in_utf16.offset_of({1, 3}), 8U);
}

TEST(TextIndex, TakesTheNearestPlaceWhereThereIsNone) {
  const std::string text = "\xF0\x9F\x98\x80\r\nab";
  const TextIndex index(text, utf16);
  EXPECT_EQ(index.offset_of({0, 1}), 0U) << "within a pair";
  EXPECT_EQ(index.offset_of({0, 7}), 4U) << "behind the line";
  EXPECT_EQ(index.offset_of({1, 7}), 8U);
  EXPECT_EQ(index.offset_of({9, 0}), 8U) << "behind the text";
  EXPECT_EQ(index.position_of(5), (Position{0, 2})) << "between CR and LF";
  EXPECT_EQ(index.position_of(99), (Position{1, 2}));
}

TEST(TextIndex, TakesBytesThatAreNotUtf8ForLatin1) {
  const std::string text = "\xFC\xE4x\n\xC3\xBC";
  EXPECT_EQ(TextIndex(text, utf16).position_of(2), (Position{0, 2}));
  EXPECT_EQ(TextIndex(text, utf8).position_of(2), (Position{0, 4})) << "as the editor sees the file";
  EXPECT_EQ(TextIndex(text, utf16).position_of(6), (Position{1, 1})) << "other lines may be UTF-8";
}

RC_GTEST_PROP(TextIndex, FindsTheOffsetOfThePositionOfEachCharacter, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(
      std::vector<std::string>{"a", "\n", "\r\n", "\r", "\xC3\xBC", "\xE2\x82\xAC", "\xF0\x9F\x98\x80"}));
  const PositionEncoding encoding = *rc::gen::element(utf8, utf16);
  std::string text;
  std::vector<std::size_t> offsets;
  for (const std::string& piece : pieces) {
    // CR and LF may meet, and there is no place between them.
    if (!(piece == "\n" && !text.empty() && text.back() == '\r')) offsets.push_back(text.size());
    text += piece;
  }
  offsets.push_back(text.size());
  const TextIndex index(text, encoding);
  for (const std::size_t offset : offsets) RC_ASSERT(index.offset_of(index.position_of(offset)) == offset);
  // In any order, not only rising.
  const auto chosen = *rc::gen::container<std::vector<std::size_t>>(rc::gen::elementOf(offsets));
  for (const std::size_t offset : chosen) {
    RC_ASSERT(index.position_of(offset) == TextIndex(text, encoding).position_of(offset));
  }
}

}  // namespace
}  // namespace opentmcl::editor::lsp
