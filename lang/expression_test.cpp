#include "lang/expression.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

using State = Evaluation::State;

struct Evaluated {
  Evaluation evaluation;
  std::vector<Problem> problems;
};

Evaluated evaluate_text(const std::string& text) {
  Sources sources;
  const FileId file = sources.add("test", text);
  SymbolTable symbols;
  symbols.insert({"Half", SymbolKind::constant, 0.5, {}});
  symbols.insert({"Sin", SymbolKind::constant, 77, {}});
  Lexer lexer(text);
  Tokens tokens;
  lexer.read_line(tokens);
  DiagnosticList diagnostics;
  const Scope scope{file, sources[file].text, &symbols, symbols.symbols().size()};
  const Evaluation evaluation = evaluate({tokens.data(), tokens.data() + tokens.size() - 1}, scope, diagnostics);
  return {evaluation, problems_of(diagnostics.take_sorted(), sources)};
}

double value_of(const std::string& text) {
  const Evaluated evaluated = evaluate_text(text);
  EXPECT_EQ(evaluated.evaluation.state, State::value) << text;
  return evaluated.evaluation.value;
}

void expect_problem(const std::string& text, DiagnosticKind kind, std::size_t column, const std::string& marked) {
  EXPECT_THAT(evaluate_text(text).problems, testing::ElementsAre(Problem{kind, {1, column}, marked})) << text;
}

TEST(Expression, FollowsTheUsualPrecedence) {
  EXPECT_EQ(value_of("2 + 3 * 4"), 14);
  EXPECT_EQ(value_of("(2 + 3) * 4"), 20);
  EXPECT_EQ(value_of("10 - 4 - 3"), 3);
  EXPECT_EQ(value_of("100 / 5 / 2"), 10);
  EXPECT_EQ(value_of("2 * 3 ^ 2"), 18);
  EXPECT_EQ(value_of("2 ^ 3 ^ 2"), 512);
  EXPECT_EQ(value_of("-2 ^ 2"), -4);
  EXPECT_EQ(value_of("2 ^ -1"), 0.5);
  EXPECT_EQ(value_of("--3 - -+2"), 5);
}

TEST(Expression, CalculatesInFloatingPoint) {
  EXPECT_EQ(value_of("1 / 4"), 0.25);
  EXPECT_EQ(value_of("$10 + %11 + 0.5"), 19.5);
  EXPECT_EQ(value_of("HALF * 3"), 1.5);
}

TEST(Expression, KnowsAllFunctionsInAnyCase) {
  EXPECT_DOUBLE_EQ(value_of("sin(1)"), std::sin(1.0));
  EXPECT_DOUBLE_EQ(value_of("Cos(1)"), std::cos(1.0));
  EXPECT_DOUBLE_EQ(value_of("TAN(1)"), std::tan(1.0));
  EXPECT_DOUBLE_EQ(value_of("ASIN(0.5)"), std::asin(0.5));
  EXPECT_DOUBLE_EQ(value_of("ACOS(0.5)"), std::acos(0.5));
  EXPECT_DOUBLE_EQ(value_of("ATAN(0.5)"), std::atan(0.5));
  EXPECT_DOUBLE_EQ(value_of("LOG(1000)"), 3);
  EXPECT_DOUBLE_EQ(value_of("LN(EXP(2))"), 2);
  EXPECT_DOUBLE_EQ(value_of("SQRT(49)"), 7);
  EXPECT_EQ(value_of("ABS(-3)"), 3);
  EXPECT_EQ(value_of("INT(-2.7)"), -2);
  EXPECT_EQ(value_of("ROUND(-2.5)"), -3);
  EXPECT_EQ(value_of("ROUND(2.5)"), 3);
  EXPECT_EQ(value_of("SIGN(-9) + SIGN(0) + 10 * SIGN(0.1)"), 9);
  EXPECT_DOUBLE_EQ(value_of("DEG(ACOS(-1))"), 180);
  EXPECT_DOUBLE_EQ(value_of("SIN(RAD(30))"), 0.5);
}

TEST(Expression, TellsANameFromAFunctionByTheParenthesis) {
  EXPECT_EQ(value_of("Sin + SIN(0)"), 77);
}

TEST(Expression, LeavesUndefinedNamesToTheCaller) {
  const Evaluated evaluated = evaluate_text("1 + Later");
  EXPECT_EQ(evaluated.evaluation.state, State::undefined);
  EXPECT_TRUE(evaluated.problems.empty());
}

TEST(Expression, ReportsWhatIsWrongAndWhere) {
  expect_problem("1 + ", DiagnosticKind::expected_expression, 5, "");
  expect_problem("1 + * 2", DiagnosticKind::expected_expression, 5, "*");
  expect_problem("()", DiagnosticKind::expected_expression, 2, ")");
  expect_problem("1 2", DiagnosticKind::unexpected_token, 3, "2");
  expect_problem("(1 + 2", DiagnosticKind::missing_parenthesis, 1, "(");
  expect_problem("3 * SIN(1", DiagnosticKind::missing_parenthesis, 8, "(");
  expect_problem("1)", DiagnosticKind::unexpected_token, 2, ")");
  expect_problem("2 * SINE(1)", DiagnosticKind::unknown_function, 5, "SINE");
  expect_problem("1 / (2 - 2)", DiagnosticKind::division_by_zero, 3, "/");
  expect_problem("1 + SQRT(-1)", DiagnosticKind::undefined_result, 5, "SQRT");
  expect_problem("LN(0)", DiagnosticKind::undefined_result, 1, "LN");
  expect_problem("(-1) ^ 0.5", DiagnosticKind::undefined_result, 6, "^");
  expect_problem("1e308 * 10", DiagnosticKind::undefined_result, 1, "1e308");
}

TEST(Expression, RefusesToNestWithoutEnd) {
  const std::string deep(30000, '(');
  EXPECT_EQ(evaluate_text(deep).problems.at(0).kind, DiagnosticKind::expression_too_deep);
  std::string powers = "2";
  for (int i = 0; i < 30000; ++i) powers += "^1";
  EXPECT_EQ(evaluate_text(powers).problems.at(0).kind, DiagnosticKind::expression_too_deep);
}

TEST(Expression, IsAsLongAsItLikes) {
  std::string text = "0";
  for (int i = 0; i < 30000; ++i) text += "+1";
  EXPECT_EQ(value_of(text), 30000);
}

RC_GTEST_PROP(Expression, AgreesWithTheMachineOnSumsAndProducts, (std::int16_t a, std::int16_t b, std::int16_t c)) {
  const double expected = static_cast<double>(a) + static_cast<double>(b) * static_cast<double>(c) - 7.0;
  RC_ASSERT(value_of(std::to_string(a) + "+" + std::to_string(b) + "*" + std::to_string(c) + "-7") == expected);
}

}  // namespace
}  // namespace opentmcl::lang
