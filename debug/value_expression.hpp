// What a person asks a module while its program stands, and what a breakpoint's condition says.
//   condition  = conjunction {"||" conjunction}
//   conjunction = comparison {"&&" comparison}
//   comparison = sum [("<" | "<=" | "==" | "=" | "!=" | ">=" | ">") sum]
//   sum, product, unary, power as in lang/expression.hpp; "!" before a primary: 1 if it is 0, else 0
//   primary    = number | register | label | constant | "(" condition ")" | function "(" condition ")"
//              | read "(" condition ["," condition] ")"
// Registers are A, X and PC. Reads are those of TMCL: GAP(parameter [, motor]), GGP(parameter, bank), GIO(port, bank),
// GCO(coordinate [, motor]), and VAR(number) for a user variable, GGP(number, 2). A parameter can be its number or its
// symbol of the built-in include files, such as APActualPosition.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "client/error.hpp"
#include "debug/program.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::debug {

/// Where an expression gets its values. Real: Engine. For tests: a table.
class ValueSource {
 public:
  virtual client::Result<std::int32_t> accumulator() = 0;
  virtual client::Result<std::int32_t> x_register() = 0;
  virtual client::Result<std::int32_t> program_counter() = 0;
  /// The answer to a command that reads.
  virtual client::Result<std::int32_t> read(const Command& command) = 0;

 protected:
  ~ValueSource() = default;
};

/// An expression that was understood.
class ValueExpression {
 public:
  /// Error: usage, one line that shows the place in the text.
  /// @param program whose labels and constants the text may name; its numbers are put in here, so it need not live on
  static client::Result<ValueExpression> parse(std::string_view text, const Program& program);

  ValueExpression(ValueExpression&&) noexcept;
  ValueExpression& operator=(ValueExpression&&) noexcept;
  ~ValueExpression();

  const std::string& text() const { return text_; }

  /// Floating point inside, as in the assembler; a truth is 1 or 0. What need not be read is not read: the right side
  /// of && and || only if the left one does not decide. Errors: those of `source`; usage (division by zero, no finite
  /// value, a parameter that is no whole number 0…255).
  client::Result<double> evaluate(ValueSource& source) const;

  struct Node;

 private:
  ValueExpression(std::string text, std::unique_ptr<Node> root);

  std::string text_;
  std::unique_ptr<Node> root_;
};

/// "5", "0.25": as people write numbers.
std::string value_text(double value);

}  // namespace opentmcl::debug
