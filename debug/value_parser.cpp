// From the text of an expression to its tree.

#include <optional>
#include <string>
#include <utility>

#include "debug/mistake.hpp"
#include "debug/value_node.hpp"
#include "lang/assembler.hpp"
#include "lang/diagnostic.hpp"
#include "lang/instruction_table.hpp"
#include "lang/lexer.hpp"
#include "lang/names.hpp"

namespace opentmcl::debug {

using client::Error;
using client::Result;
using lang::Token;
using lang::TokenKind;
using Node = ValueExpression::Node;
using NodePointer = std::unique_ptr<Node>;

namespace {

/// Deeper nesting is an error and no stack overflow.
constexpr int maximum_depth = 200;

constexpr std::string_view variable_read = "VAR";

const lang::FunctionSpec* find_function(std::string_view name) {
  for (std::size_t i = 0; i < lang::function_count; ++i) {
    if (lang::equal_ignoring_case(lang::functions[i].name, name)) return &lang::functions[i];
  }
  return nullptr;
}

/// The instructions that can be called like functions: those that read and whose operands are numbers.
const InstructionSpec* find_read(std::string_view name) {
  const InstructionSpec* const row = lang::find_mnemonic(name);
  if (row == nullptr || !row->reads || lang::operand_count(*row) == 0) return nullptr;
  for (std::size_t i = 0; i < lang::operand_count(*row); ++i) {
    if (lang::takes_words(row->operands[i].kind)) return nullptr;
  }
  return row;
}

NodePointer leaf(Operation operation, double number = 0) {
  auto node = std::make_unique<Node>();
  node->operation = operation;
  node->number = number;
  return node;
}

NodePointer join(Operation operation, NodePointer left, NodePointer right) {
  auto node = leaf(operation);
  node->operands.push_back(std::move(left));
  node->operands.push_back(std::move(right));
  return node;
}

/// Each function returns nullptr when it fails and leaves the error behind.
class Parser {
 public:
  Parser(std::string_view text, const Program& program) : text_(text), program_(program) {
    lang::Lexer lexer(text);
    lexer.read_line(tokens_);
    is_one_line_ = lexer.at_end();
    token_ = tokens_.data();
  }

  Result<NodePointer> parse() {
    if (!is_one_line_) return mistake("an expression is one line");
    NodePointer root = condition();
    if (root != nullptr && token_->kind != TokenKind::end_of_line) fail("expected an operator");
    if (error_) return *std::move(error_);
    return root;
  }

 private:
  NodePointer condition() {
    NodePointer left = conjunction();
    while (left != nullptr && at_sign("||")) {
      token_ += 2;
      left = with_right(Operation::either, std::move(left), conjunction());
    }
    return left;
  }

  NodePointer conjunction() {
    NodePointer left = comparison();
    while (left != nullptr && at_sign("&&")) {
      token_ += 2;
      left = with_right(Operation::both, std::move(left), comparison());
    }
    return left;
  }

  NodePointer comparison() {
    NodePointer left = sum();
    if (left == nullptr) return nullptr;
    struct Relation {
      std::string_view sign;
      Operation operation;
    };
    // A sign that begins with another one stands before it.
    constexpr Relation relations[] = {
        {"<=", Operation::at_most}, {">=", Operation::at_least}, {"==", Operation::equal}, {"!=", Operation::unequal},
        {"<", Operation::less},     {">", Operation::greater},   {"=", Operation::equal}};
    for (const Relation& relation : relations) {
      if (!at_sign(relation.sign)) continue;
      token_ += relation.sign.size();
      return with_right(relation.operation, std::move(left), sum());
    }
    return left;
  }

  NodePointer sum() {
    NodePointer left = product();
    while (left != nullptr && (token_->kind == TokenKind::plus || token_->kind == TokenKind::minus)) {
      const Operation operation = (token_++)->kind == TokenKind::plus ? Operation::add : Operation::subtract;
      left = with_right(operation, std::move(left), product());
    }
    return left;
  }

  NodePointer product() {
    NodePointer left = unary();
    while (left != nullptr && (token_->kind == TokenKind::star || token_->kind == TokenKind::slash)) {
      const Operation operation = (token_++)->kind == TokenKind::star ? Operation::multiply : Operation::divide;
      left = with_right(operation, std::move(left), unary());
    }
    return left;
  }

  NodePointer unary() {
    bool negative = false;
    for (; token_->kind == TokenKind::plus || token_->kind == TokenKind::minus; ++token_) {
      if (token_->kind == TokenKind::minus) negative = !negative;
    }
    NodePointer value = power();
    if (!negative || value == nullptr) return value;
    auto node = leaf(Operation::negate);
    node->operands.push_back(std::move(value));
    return node;
  }

  NodePointer power() {
    NodePointer base = primary();
    if (base == nullptr || token_->kind != TokenKind::caret) return base;
    ++token_;
    if (!enter()) return nullptr;
    NodePointer exponent = unary();
    --depth_;
    return with_right(Operation::power, std::move(base), std::move(exponent));
  }

  NodePointer primary() {
    if (at_sign("!")) {
      ++token_;
      if (!enter()) return nullptr;
      NodePointer value = primary();
      --depth_;
      if (value == nullptr) return nullptr;
      auto node = leaf(Operation::invert);
      node->operands.push_back(std::move(value));
      return node;
    }
    const Token& token = *token_;
    switch (token.kind) {
      case TokenKind::number:
        ++token_;
        return leaf(Operation::number, token.number);
      case TokenKind::open:
        ++token_;
        return parenthesised();
      case TokenKind::name:
        ++token_;
        return token_->kind == TokenKind::open ? call(token.text(text_)) : named(token);
      default:
        return fail("expected a number, a name or '('");
    }
  }

  NodePointer parenthesised() {
    if (!enter()) return nullptr;
    NodePointer value = condition();
    --depth_;
    if (value == nullptr) return nullptr;
    if (token_->kind != TokenKind::close) return fail("expected ')'");
    ++token_;
    return value;
  }

  NodePointer named(const Token& token) {
    const std::string_view name = token.text(text_);
    if (lang::is_same_name(name, "A")) return leaf(Operation::accumulator);
    if (lang::is_same_name(name, "X")) return leaf(Operation::x_register);
    if (lang::is_same_name(name, "PC")) return leaf(Operation::program_counter);
    if (const auto value = program_.value_of_name(name)) return leaf(Operation::number, *value);
    if (const auto constant = built_in_constant(name)) return leaf(Operation::number, *constant);
    --token_;
    if (lang::find_mnemonic(name) != nullptr) {
      return fail("expected '(' behind " + std::string(name) + ", as in GAP(1, 0)");
    }
    return fail("neither a register (A, X, PC) nor a label or constant of the program or the built-in include files");
  }

  /// Of the include files that every assembler has, such as APActualPosition.
  std::optional<double> built_in_constant(std::string_view name) const {
    const lang::InstructionResult loaded =
        lang::parse_instruction("CALC LOAD, " + std::string(name), program_.module());
    if (!loaded.command) return std::nullopt;
    return loaded.command->value;
  }

  NodePointer call(std::string_view name) {
    auto node = std::make_unique<Node>();
    std::size_t most = 1;
    std::size_t least = 1;
    if (lang::equal_ignoring_case(name, variable_read)) {
      node->operation = Operation::read;
    } else if (const lang::FunctionSpec* const function = find_function(name)) {
      node->operation = Operation::function;
      node->function = function;
    } else if (const InstructionSpec* const read = find_read(name)) {
      node->operation = Operation::read;
      node->read = read;
      most = lang::operand_count(*read);
      // The motor, which is 0 in most modules, may be left out.
      const OperandKind last = read->operands[most - 1].kind;
      const bool has_motor = last == OperandKind::motor || last == OperandKind::motor_or_all;
      least = has_motor ? most - 1 : most;
    } else {
      --token_;
      return fail("there is no such function; expected GAP, GGP, GIO, GCO, VAR or one of the assembler's");
    }
    ++token_;
    if (!enter()) return nullptr;
    do {
      NodePointer operand = condition();
      if (operand == nullptr) return nullptr;
      node->operands.push_back(std::move(operand));
    } while (node->operands.size() < most && token_->kind == TokenKind::comma && ++token_ != nullptr);
    --depth_;
    if (node->operands.size() < least) return fail("expected ',' and another operand");
    if (token_->kind != TokenKind::close) return fail("expected ')'");
    ++token_;
    return node;
  }

  static NodePointer with_right(Operation operation, NodePointer left, NodePointer right) {
    if (right == nullptr) return nullptr;
    return join(operation, std::move(left), std::move(right));
  }

  /// Whether these characters come next, without blanks between them. A sign is as many tokens as characters.
  bool at_sign(std::string_view sign) const {
    for (std::size_t i = 0; i < sign.size(); ++i) {
      const Token& token = token_[i];
      if (token.kind == TokenKind::end_of_line || token.length != 1 || text_[token.offset] != sign[i]) return false;
      if (token.offset != token_->offset + i) return false;
    }
    return true;
  }

  bool enter() {
    if (++depth_ <= maximum_depth) return true;
    fail("this expression is nested too deeply");
    return false;
  }

  NodePointer fail(const std::string& message) {
    if (error_) return nullptr;
    const bool ends = token_->kind == TokenKind::end_of_line;
    const std::string found = ends ? "the end" : lang::in_quotes(token_->text(text_));
    error_ = mistake(message + " at " + found + " in the expression " + lang::in_quotes(text_));
    return nullptr;
  }

  std::string_view text_;
  const Program& program_;
  lang::Tokens tokens_;
  bool is_one_line_ = true;
  const Token* token_ = nullptr;
  int depth_ = 0;
  std::optional<Error> error_;
};

}  // namespace

Result<NodePointer> parse_value(std::string_view text, const Program& program) {
  return Parser(text, program).parse();
}

}  // namespace opentmcl::debug
