#include "lang/source_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "lang/source.hpp"

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;
using Role = TokenRole;

SourceLine line_of(std::string_view text) {
  SourceLine line;
  Lexer lexer(text);
  read_source_line(lexer, text, line);
  return line;
}

std::vector<Role> roles_of(std::string_view text) {
  return line_of(text).roles;
}

TEST(SourceLine, KnowsWhatEachWordIs) {
  EXPECT_THAT(roles_of("Again: MVP ABS, 0, SIN(Angle) * 2 // there"),
              ElementsAre(Role::label, Role::sign, Role::mnemonic, Role::word, Role::sign, Role::number, Role::sign,
                          Role::function, Role::sign, Role::name, Role::sign, Role::sign, Role::number));
  EXPECT_THAT(roles_of("Speed = Top / 2"),
              ElementsAre(Role::constant, Role::sign, Role::name, Role::sign, Role::number));
  EXPECT_THAT(roles_of("#include x.tmc"), ElementsAre(Role::directive));
  EXPECT_THAT(roles_of("MPV 1"), ElementsAre(Role::mnemonic, Role::number));
}

TEST(SourceLine, TakesAWordForOneWhereItStandsForAnOperandOnly) {
  EXPECT_THAT(roles_of("SAP ABS, 0, ABS"),
              ElementsAre(Role::mnemonic, Role::name, Role::sign, Role::number, Role::sign, Role::name));
  EXPECT_THAT(roles_of("MVP ABS + 1"), ElementsAre(Role::mnemonic, Role::name, Role::sign, Role::number));
  EXPECT_THAT(roles_of("CALC add, abs(1)"), ElementsAre(Role::mnemonic, Role::word, Role::sign, Role::function,
                                                        Role::sign, Role::number, Role::sign));
  EXPECT_THAT(roles_of("CALC COMP, 1"), ElementsAre(Role::mnemonic, Role::name, Role::sign, Role::number))
      << "CALC has no COMP";
}

TEST(SourceLine, ReadsWrongLinesAsFarAsTheyGo) {
  EXPECT_THAT(roles_of("JC GE, ! Loop"),
              ElementsAre(Role::mnemonic, Role::word, Role::sign, Role::invalid, Role::name));
  EXPECT_THAT(roles_of("SAP , , 1,,"),
              ElementsAre(Role::mnemonic, Role::sign, Role::sign, Role::number, Role::sign, Role::sign));
  EXPECT_THAT(roles_of("A: B: 1x"), ElementsAre(Role::label, Role::sign, Role::label, Role::sign, Role::invalid));
}

TEST(SourceLine, KnowsTheOperandOfAToken) {
  const SourceLine line = line_of("SAP 4, 0, (1 + 2), 0");
  EXPECT_EQ(line.operand_of(0), nullptr);
  EXPECT_EQ(line.operand_of(1)->kind, OperandKind::axis_parameter);
  EXPECT_EQ(line.operand_of(3)->kind, OperandKind::motor);
  EXPECT_EQ(line.operand_of(6)->kind, OperandKind::value);
  EXPECT_EQ(line.operand_of(11), nullptr) << "a surplus one";
}

TEST(SourceLine, FindsTheTokenAtAPlace) {
  const SourceLine line = line_of("A: JA A+1 ");
  const auto at = [&](std::size_t offset) { return token_at(line, offset); };
  EXPECT_EQ(at(0), 0U);
  EXPECT_EQ(at(1), 0U) << "directly behind a name";
  EXPECT_EQ(at(2), 1U);
  EXPECT_EQ(at(5), 2U);
  EXPECT_EQ(at(7), 3U);
  EXPECT_EQ(at(8), 5U) << "a number rather than the sign before it";
  EXPECT_EQ(at(9), 5U);
  EXPECT_EQ(at(10), line.token_count());
}

RC_GTEST_PROP(SourceLine, BeginsBehindTheEndOfTheLineBefore, ()) {
  const auto text = *rc::gen::container<std::string>(rc::gen::element('a', '\n', '\r', ' '));
  const auto offset = *rc::gen::inRange<std::size_t>(0, text.size() + 1);
  const LineIndex lines(text);
  RC_ASSERT(start_of_line(text, offset) == lines.start_of(lines.position_of(offset).line));
}

RC_GTEST_PROP(SourceLine, GivesEachTokenARole, (const std::string& text)) {
  Lexer lexer(text);
  SourceLine line;
  while (!lexer.at_end()) {
    read_source_line(lexer, text, line);
    RC_ASSERT(line.roles.size() + 1 == line.statement.tokens.size());
    RC_ASSERT(line.first_operand_token + line.operands.size() == line.roles.size());
  }
}

}  // namespace
}  // namespace opentmcl::lang
