#include "debug/value_expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "debug/debugging_test.hpp"

namespace opentmcl::debug {
namespace {

using testing::HasSubstr;

/// A module that answers reads from a table and counts them.
class Values final : public ValueSource {
 public:
  client::Result<std::int32_t> accumulator() override { return 7; }
  client::Result<std::int32_t> x_register() override { return -3; }
  client::Result<std::int32_t> program_counter() override { return 12; }
  client::Result<std::int32_t> read(const Command& command) override {
    ++reads;
    const auto found = answers.find({command.opcode, command.type, command.motor});
    if (found != answers.end()) return found->second;
    return client::Error{client::ErrorKind::refused, "no such parameter", {}};
  }

  std::map<std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>, std::int32_t> answers;
  int reads = 0;
};

const Program& program() {
  static const Program only = program_of("Speed = 2.5 * 100\nBegin: ROR 0, Speed\nLoop: JA Loop\n");
  return only;
}

double value_of_text(std::string_view text, Values& values) {
  return value_of(value_of(ValueExpression::parse(text, program())).evaluate(values));
}

std::string mistake_in(std::string_view text) {
  Values values;
  const auto expression = ValueExpression::parse(text, program());
  if (!expression) return expression.error().message;
  const auto value = expression->evaluate(values);
  return value ? "" : value.error().message;
}

TEST(ValueExpression, CalculatesAsTheAssemblerDoes) {
  Values values;
  const std::pair<const char*, double> expected[] = {
      {"1 + 2 * 3", 7},      {"-2^2", -4},          {"2^3^2", 512},      {"(1 + 2) * 3", 9}, {"7 / 2", 3.5},
      {"$FF", 255},          {"%101", 5},           {"SQRT(16) + 1", 5}, {"--1", 1},         {"round(2.5)", 3},
      {"1 < 2", 1},          {"2 <= 1", 0},         {"3 = 3", 1},        {"3 == 4", 0},      {"3 != 4", 1},
      {"1 < 2 && 2 < 1", 0}, {"1 < 2 || 2 < 1", 1}, {"!0", 1},           {"!(1 < 2)", 0},    {"2 >= 2 && !0 || 0", 1},
      {"1 + 1 > 1 * 1", 1},  {"0 || 0 && 1", 0}};
  for (const auto& [text, value] : expected) {
    EXPECT_EQ(value, value_of_text(text, values)) << text;
  }
  EXPECT_THAT(mistake_in("5 > 4 > 0"), HasSubstr("expected an operator"));
}

TEST(ValueExpression, KnowsRegistersLabelsAndBuiltInConstants) {
  Values values;
  EXPECT_EQ(7, value_of_text("A", values));
  EXPECT_EQ(-3, value_of_text("x", values));
  EXPECT_EQ(12, value_of_text("PC", values));
  EXPECT_EQ(1, value_of_text("loop", values));
  EXPECT_EQ(250, value_of_text("speed", values));
  EXPECT_EQ(1, value_of_text("APActualPosition", values));
  EXPECT_EQ(1, value_of_text("PC == Loop + 11", values));
}

TEST(ValueExpression, ReadsTheModule) {
  Values values;
  const auto opcode = [](Opcode code) { return static_cast<std::uint8_t>(code); };
  values.answers[{opcode(Opcode::gap), 1, 0}] = 1000;
  values.answers[{opcode(Opcode::gap), 1, 2}] = 2000;
  values.answers[{opcode(Opcode::ggp), 5, 2}] = 55;
  values.answers[{opcode(Opcode::gio), 0, 1}] = 3;
  EXPECT_EQ(1000, value_of_text("GAP(1, 0)", values));
  EXPECT_EQ(1000, value_of_text("GAP(APActualPosition)", values));
  EXPECT_EQ(2000, value_of_text("gap(1, 1 + 1)", values));
  EXPECT_EQ(55, value_of_text("VAR(5)", values));
  EXPECT_EQ(55, value_of_text("GGP(5, 2)", values));
  EXPECT_EQ(3, value_of_text("GIO(0, 1)", values));
  EXPECT_EQ(1, value_of_text("A > 5 && GAP(1, 0) < 1500", values));
}

TEST(ValueExpression, DoesNotReadWhatDoesNotMatter) {
  Values values;
  EXPECT_EQ(0, value_of_text("A < 5 && GAP(1, 0) > 3", values));
  EXPECT_EQ(1, value_of_text("A > 5 || GAP(1, 0) > 3", values));
  EXPECT_EQ(0, values.reads);
}

TEST(ValueExpression, SaysWhatIsWrong) {
  const std::pair<const char*, const char*> expected[] = {{"", "expected a number, a name or '(' at the end"},
                                                          {"1 +", "at the end"},
                                                          {"(1", "expected ')'"},
                                                          {"Nowhere", "neither a register"},
                                                          {"GAP", "expected '(' behind GAP"},
                                                          {"GAP()", "expected a number"},
                                                          {"GGP(1)", "another operand"},
                                                          {"GAP(1, 0, 0)", "expected ')'"},
                                                          {"SIN", "neither a register"},
                                                          {"NOSUCH(1)", "there is no such function"},
                                                          {"MVP(1)", "there is no such function"},
                                                          {"1 / 0", "division by zero"},
                                                          {"LN(0)", "no finite value"},
                                                          {"GAP(256)", "whole numbers from 0 to 255"},
                                                          {"GAP(1.5)", "not 1.5"},
                                                          {"VAR(-1)", "whole numbers from 0 to 255"},
                                                          {"1 2", "expected an operator"},
                                                          {"A & 1", "expected an operator"},
                                                          {"GAP(200)", "no such parameter"},
                                                          {"1\n2", "one line"}};
  for (const auto& [text, message] : expected) EXPECT_THAT(mistake_in(text), HasSubstr(message)) << text;
}

TEST(ValueExpression, DeepNestingIsAnErrorAndNoCrash) {
  for (const char* const opener : {"(", "-(", "!", "SIN(", "2^", "VAR("}) {
    std::string text;
    while (text.size() < 9'000) text += opener;
    EXPECT_THAT(mistake_in(text), HasSubstr("nested too deeply")) << opener;
  }
  EXPECT_THAT(mistake_in(std::string(20'000, '1')), HasSubstr("at most"));
}

TEST(HitCondition, IsWhatDebugAdaptersSend) {
  const auto hits_of = [](std::string_view text) {
    const HitCondition condition = value_of(HitCondition::parse(text));
    std::vector<int> hits;
    for (int hit = 1; hit <= 6; ++hit) {
      if (condition.holds(static_cast<std::uint64_t>(hit))) hits.push_back(hit);
    }
    return hits;
  };
  EXPECT_THAT(hits_of("3"), testing::ElementsAre(3));
  EXPECT_THAT(hits_of("== 2"), testing::ElementsAre(2));
  EXPECT_THAT(hits_of(">=4"), testing::ElementsAre(4, 5, 6));
  EXPECT_THAT(hits_of("> 4"), testing::ElementsAre(5, 6));
  EXPECT_THAT(hits_of(" % 2 "), testing::ElementsAre(2, 4, 6));
  for (const char* const wrong : {"", "0", "x", "< 3", "3 4", "-1", ">="})
    EXPECT_FALSE(HitCondition::parse(wrong)) << wrong;
}

TEST(LogMessage, FillsInValues) {
  Values values;
  const LogMessage message = value_of(LogMessage::parse("A is {A}, {{x}}, {GAP(9)}, {A / 2}", program()));
  EXPECT_EQ("A is 7, {x}, <no such parameter>, 3.5", message.fill_in(values));
  EXPECT_FALSE(LogMessage::parse("{A", program()));
  EXPECT_FALSE(LogMessage::parse("{}", program()));
}

}  // namespace
}  // namespace opentmcl::debug
