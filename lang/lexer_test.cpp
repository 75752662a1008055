#include "lang/lexer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;

std::vector<TokenKind> kinds_of_line(std::string_view text) {
  Lexer lexer(text);
  Tokens tokens;
  lexer.read_line(tokens);
  std::vector<TokenKind> kinds;
  for (const Token& token : tokens) kinds.push_back(token.kind);
  return kinds;
}

Token first_token(std::string_view text) {
  Lexer lexer(text);
  Tokens tokens;
  lexer.read_line(tokens);
  return tokens.front();
}

/// Each line as its tokens, between | and |.
std::vector<std::string> lines_of(std::string_view text) {
  Lexer lexer(text);
  std::vector<std::string> lines;
  Tokens tokens;
  while (!lexer.at_end()) {
    lexer.read_line(tokens);
    std::string line;
    for (const Token& token : tokens) line += "|" + std::string(token.text(text));
    lines.push_back(line);
  }
  return lines;
}

TEST(Lexer, KnowsAllSigns) {
  EXPECT_THAT(kinds_of_line("a,:=+-*/^()"),
              ElementsAre(TokenKind::name, TokenKind::comma, TokenKind::colon, TokenKind::equals, TokenKind::plus,
                          TokenKind::minus, TokenKind::star, TokenKind::slash, TokenKind::caret, TokenKind::open,
                          TokenKind::close, TokenKind::end_of_line));
}

TEST(Lexer, ReadsNumbers) {
  struct Case {
    const char* text;
    double number;
  };
  const Case cases[] = {{"0", 0},
                        {"1000", 1000},
                        {"2147483648", 2147483648.0},
                        {"007", 7},
                        {"1.5", 1.5},
                        {".25", 0.25},
                        {"2.", 2},
                        {"1e3", 1000},
                        {"2.5E-1", 0.25},
                        {"$FF", 255},
                        {"$7fffffff", 2147483647},
                        {"$FFFFFFFF", -1},
                        {"$80000000", -2147483648.0},
                        {"%1010", 10},
                        {"%0", 0},
                        {"%11111111111111111111111111111110", -2},
                        {"$000000000001", 1},
                        {"12345678901234567890", 12345678901234567890.0}};
  for (const Case& row : cases) {
    const Token token = first_token(row.text);
    EXPECT_EQ(token.kind, TokenKind::number) << row.text;
    EXPECT_EQ(token.number, row.number) << row.text;
    EXPECT_EQ(token.length, std::string_view(row.text).size()) << row.text;
  }
}

TEST(Lexer, MarksNumbersThatAreNone) {
  for (const char* text : {"$", "%", "%2", "$xyz", "12abc", "0x10", "1.2.3", ".", "$FG", "%102", "1e", "5_"}) {
    const Token token = first_token(text);
    EXPECT_EQ(token.kind, TokenKind::malformed_number) << text;
    EXPECT_EQ(token.length, std::string_view(text).size()) << text;
  }
}

TEST(Lexer, MarksNumbersThatAreTooLarge) {
  for (const char* text : {"$100000000", "%100000000000000000000000000000000", "1e999"}) {
    EXPECT_EQ(first_token(text).kind, TokenKind::number_too_large) << text;
  }
}

TEST(Lexer, EndsLinesAtLineFeedCarriageReturnAndBoth) {
  EXPECT_THAT(lines_of("a\nb\rc\r\nd"), ElementsAre("|a|", "|b|", "|c|", "|d|"));
  EXPECT_THAT(lines_of("a\n\n\r\rb\n"), ElementsAre("|a|", "|", "|", "|", "|b|"));
}

TEST(Lexer, IgnoresCommentsOfBothKinds) {
  EXPECT_THAT(lines_of("MST 0//stop\nMST 0;stop // twice\n// only\r;only"),
              ElementsAre("|MST|0|", "|MST|0|", "|", "|"));
  EXPECT_THAT(lines_of("4/2 / / 3"), ElementsAre("|4|/|2|/|/|3|"));
}

TEST(Lexer, TakesADirectiveAsAWholeWithoutItsComment) {
  EXPECT_THAT(lines_of("  #include my file.tmc \t// comment\n"), ElementsAre("|#include my file.tmc|"));
}

TEST(Lexer, TakesACharacterOfSeveralBytesAsOne) {
  EXPECT_THAT(lines_of("\xC3\xA4\xC3\xB6"), ElementsAre("|\xC3\xA4|\xC3\xB6|"));
  EXPECT_THAT(lines_of("\xE4 \xF6"), ElementsAre("|\xE4|\xF6|"));
}

TEST(Lexer, SkipsAByteOrderMark) {
  EXPECT_THAT(lines_of("\xEF\xBB\xBFSTOP"), ElementsAre("|STOP|"));
}

TEST(Lexer, BeginsInTheMiddleOfALineWhenAsked) {
  Lexer lexer("Loop: MST 0", 6);
  Tokens tokens;
  lexer.read_line(tokens);
  EXPECT_EQ(tokens.front().text("Loop: MST 0"), "MST");
}

RC_GTEST_PROP(Lexer, FindsTokensInOrderWithinTheTextWhateverTheBytes, ()) {
  const auto text = *rc::gen::container<std::string>(
      rc::gen::oneOf(rc::gen::arbitrary<char>(), rc::gen::elementOf(std::string("aZ_09.$%#,:=+-*/^();\r\n\t \"e"))));
  Lexer lexer(text);
  Tokens tokens;
  std::size_t previous_end = 0;
  while (!lexer.at_end()) {
    lexer.read_line(tokens);
    RC_ASSERT(!tokens.empty());
    RC_ASSERT(tokens.back().kind == TokenKind::end_of_line);
    for (const Token& token : tokens) {
      RC_ASSERT(token.offset >= previous_end);
      RC_ASSERT(token.end() <= text.size());
      RC_ASSERT(token.length > 0 || token.kind == TokenKind::end_of_line);
      previous_end = token.end();
    }
  }
}

}  // namespace
}  // namespace opentmcl::lang
