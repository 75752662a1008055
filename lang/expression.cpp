#include "lang/expression.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "lang/names.hpp"
#include "lang/suggestion.hpp"

namespace opentmcl::lang {

const FunctionSpec functions[] = {
    {"SIN", "sine of an angle in radians", [](double x) { return std::sin(x); }},
    {"COS", "cosine of an angle in radians", [](double x) { return std::cos(x); }},
    {"TAN", "tangent of an angle in radians", [](double x) { return std::tan(x); }},
    {"ASIN", "arc sine in radians", [](double x) { return std::asin(x); }},
    {"ACOS", "arc cosine in radians", [](double x) { return std::acos(x); }},
    {"ATAN", "arc tangent in radians", [](double x) { return std::atan(x); }},
    {"LOG", "logarithm to base 10", [](double x) { return std::log10(x); }},
    {"LN", "natural logarithm", [](double x) { return std::log(x); }},
    {"EXP", "e to the power of", [](double x) { return std::exp(x); }},
    {"SQRT", "square root", [](double x) { return std::sqrt(x); }},
    {"ABS", "absolute value", [](double x) { return std::fabs(x); }},
    {"INT", "integer part, towards zero", [](double x) { return std::trunc(x); }},
    {"ROUND", "nearest integer, halves away from zero", [](double x) { return std::round(x); }},
    {"SIGN", "-1, 0 or 1", [](double x) { return static_cast<double>((x > 0) - (x < 0)); }},
    {"DEG", "radians to degrees", [](double x) { return x * 180.0 / std::numbers::pi; }},
    {"RAD", "degrees to radians", [](double x) { return x * std::numbers::pi / 180.0; }},
};
const std::size_t function_count = sizeof functions / sizeof functions[0];

namespace {

using State = Evaluation::State;

/// Deeper nesting is an error and no stack overflow.
constexpr int maximum_depth = 256;

const FunctionSpec* find_function(std::string_view name) {
  for (const FunctionSpec& function : functions) {
    if (equal_ignoring_case(function.name, name)) return &function;
  }
  return nullptr;
}

class Evaluator {
 public:
  Evaluator(TokenRange range, const Scope& scope, DiagnosticList& diagnostics)
      : first_(range.first), token_(range.first), last_(range.last), scope_(&scope), diagnostics_(&diagnostics) {}

  Evaluation run() {
    // Most expressions are the name of a label or a constant.
    if (last_ - first_ == 1 && first_->kind == TokenKind::name) {
      const double value = named(*first_);
      return {state_, value};
    }
    const double value = sum();
    if (state_ == State::value && token_ != last_) {
      fail(DiagnosticKind::unexpected_token, *token_, "expected an operator before " + quoted_text(*token_));
    }
    return {state_, checked(value, *first_, "this expression")};
  }

 private:
  double sum() {
    double value = product();
    while (at(TokenKind::plus) || at(TokenKind::minus)) {
      const bool add = (token_++)->kind == TokenKind::plus;
      const double right = product();
      value = add ? value + right : value - right;
    }
    return value;
  }

  double product() {
    double value = unary();
    while (at(TokenKind::star) || at(TokenKind::slash)) {
      const Token& sign = *token_++;
      const double right = unary();
      if (sign.kind == TokenKind::slash && right == 0) {
        fail(DiagnosticKind::division_by_zero, sign, "division by zero");
        return 0;
      }
      value = sign.kind == TokenKind::star ? value * right : value / right;
    }
    return value;
  }

  double unary() {
    bool negative = false;
    for (; at(TokenKind::plus) || at(TokenKind::minus); ++token_) {
      if (token_->kind == TokenKind::minus) negative = !negative;
    }
    const double value = power();
    return negative ? -value : value;
  }

  double power() {
    const double base = primary();
    if (!at(TokenKind::caret)) return base;
    const Token& sign = *token_++;
    if (!enter(sign)) return 0;
    const double exponent = unary();
    --depth_;
    return checked(std::pow(base, exponent), sign, "this power");
  }

  double primary() {
    if (state_ != State::value) return 0;
    const Token& token = *token_;
    if (token_ == last_ ||
        (token.kind != TokenKind::number && token.kind != TokenKind::name && token.kind != TokenKind::open)) {
      return missing();
    }
    ++token_;
    if (token.kind == TokenKind::number) return token.number;
    if (token.kind == TokenKind::open) return parenthesised(token);
    return at(TokenKind::open) ? call(token) : named(token);
  }

  double named(const Token& token) {
    const Symbol* const symbol = scope_->symbols->use(token.text(scope_->text));
    if (symbol == nullptr) {
      state_ = State::undefined;
      return 0;
    }
    const auto index = static_cast<std::size_t>(symbol - scope_->symbols->symbols().data());
    if (symbol->kind == SymbolKind::constant && index >= scope_->visible_constants) {
      fail(DiagnosticKind::used_before_definition, token,
           "the constant " + quoted_text(token) + " is used before its definition", "defined here", symbol->span);
    }
    return symbol->value;
  }

  double call(const Token& name) {
    const FunctionSpec* const function = find_function(name.text(scope_->text));
    if (function == nullptr) {
      Suggestion suggestion(name.text(scope_->text));
      for (std::size_t i = 0; i < function_count && diagnostics_->wants_suggestions(); ++i)
        suggestion.consider(functions[i].name);
      fail(DiagnosticKind::unknown_function, name, "there is no function " + quoted_text(name), suggestion.text(), {},
           fix_of(suggestion, scope_->span_of(name)));
      return 0;
    }
    const Token& open = *token_++;
    const double argument = parenthesised(open);
    return checked(function->apply(argument), name, function->name);
  }

  /// The rest of what `open` begins.
  double parenthesised(const Token& open) {
    if (!enter(open)) return 0;
    const double value = sum();
    --depth_;
    if (state_ != State::value) return 0;
    if (!at(TokenKind::close)) {
      fail(DiagnosticKind::missing_parenthesis, open, "this '(' is not closed");
      return 0;
    }
    ++token_;
    return value;
  }

  double missing() {
    const bool ends = token_ == last_;
    fail(DiagnosticKind::expected_expression, *token_,
         ends ? "expected a number or a name" : "expected a number or a name, not " + quoted_text(*token_));
    return 0;
  }

  double checked(double value, const Token& token, const char* what) {
    if (state_ == State::value && !std::isfinite(value)) {
      fail(DiagnosticKind::undefined_result, token, std::string(what) + " has no finite value here");
    }
    return value;
  }

  bool enter(const Token& token) {
    if (state_ != State::value) return false;
    if (++depth_ <= maximum_depth) return true;
    fail(DiagnosticKind::expression_too_deep, token,
         "the expression is nested more than " + std::to_string(maximum_depth) + " deep");
    return false;
  }

  bool at(TokenKind kind) const { return state_ == State::value && token_ != last_ && token_->kind == kind; }

  std::string quoted_text(const Token& token) const { return in_quotes(token.text(scope_->text)); }

  /// Only the first failure of an expression is reported.
  void fail(DiagnosticKind kind, const Token& token, std::string message, std::string note = {},
            std::optional<Span> related = {}, std::optional<Fix> fix = {}) {
    if (state_ != State::value) return;
    state_ = State::failed;
    diagnostics_->add(kind, scope_->span_of(token), std::move(message), std::move(note), related, std::move(fix));
  }

  const Token* first_;
  const Token* token_;
  const Token* last_;
  const Scope* scope_;
  DiagnosticList* diagnostics_;
  State state_ = State::value;
  int depth_ = 0;
};

}  // namespace

Span Scope::span_of(TokenRange range) const {
  if (range.empty()) return span_of(*range.first);
  return {file, range.first->offset, range.last[-1].end() - range.first->offset};
}

Evaluation evaluate(TokenRange range, const Scope& scope, DiagnosticList& diagnostics) {
  return Evaluator(range, scope, diagnostics).run();
}

const Token* find_undefined_name(TokenRange range, const Scope& scope) {
  for (const Token* token = range.first; token != range.last; ++token) {
    if (token->kind != TokenKind::name) continue;
    const bool is_call = token + 1 != range.last && token[1].kind == TokenKind::open;
    if (!is_call && scope.symbols->find(token->text(scope.text)) == nullptr) return token;
  }
  return nullptr;
}

}  // namespace opentmcl::lang
