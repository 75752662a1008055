#include "debug/value_expression.hpp"

#include <charconv>
#include <utility>

#include "debug/mistake.hpp"
#include "debug/value_node.hpp"

namespace opentmcl::debug {

using client::Result;

ValueExpression::ValueExpression(std::string text, std::unique_ptr<Node> root)
    : text_(std::move(text)), root_(std::move(root)) {}
ValueExpression::ValueExpression(ValueExpression&&) noexcept = default;
ValueExpression& ValueExpression::operator=(ValueExpression&&) noexcept = default;
ValueExpression::~ValueExpression() = default;

Result<ValueExpression> ValueExpression::parse(std::string_view text, const Program& program) {
  constexpr std::size_t longest = 10'000;
  if (text.size() > longest) return mistake("an expression has at most " + std::to_string(longest) + " characters");
  Result<std::unique_ptr<Node>> root = parse_value(text, program);
  if (!root) return root.error();
  return ValueExpression(std::string(text), std::move(*root));
}

Result<double> ValueExpression::evaluate(ValueSource& source) const {
  return root_->evaluate(source);
}

std::string value_text(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

}  // namespace opentmcl::debug
