// Expressions: floating point inside, rounded to an integer only where an instruction takes them as an operand.
//   sum     = product {("+" | "-") product}
//   product = unary {("*" | "/") unary}
//   unary   = {"+" | "-"} power
//   power   = primary ["^" unary]                  so -2^2 is -4, and 2^3^2 is 2^9
//   primary = number | name | function "(" sum ")" | "(" sum ")"
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lang/diagnostic.hpp"
#include "lang/statement.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

/// SIN, COS, TAN, ASIN, ACOS, ATAN (radians), LOG (base 10), LN, EXP, SQRT, ABS, INT (towards zero), ROUND (half away
/// from zero), SIGN (-1, 0, 1), DEG (radians to degrees), RAD (degrees to radians).
struct FunctionSpec {
  const char* name;
  const char* description;
  double (*apply)(double);
};

extern const FunctionSpec functions[];
extern const std::size_t function_count;

struct Evaluation {
  enum class State : std::uint8_t {
    value,
    undefined,  ///< a name is not defined; nothing was reported, because it may be a label further down
    failed,     ///< reported
  };

  State state = State::failed;
  double value = 0;
};

/// What names mean where an expression stands.
struct Scope {
  FileId file = 0;
  std::string_view text;           ///< of that file
  SymbolTable* symbols = nullptr;  ///< names that are used are marked in it
  /// Constants of this index and above are defined further down and cannot be used here; labels can.
  std::size_t visible_constants = 0;

  Span span_of(const Token& token) const { return {file, token.offset, token.length}; }
  /// From the first token to the last; where an expression is missing, the token that stands there instead.
  Span span_of(TokenRange range) const;
};

/// Evaluates all tokens of `range` as one expression.
Evaluation evaluate(TokenRange range, const Scope& scope, DiagnosticList& diagnostics);

/// The first name in `range` that is not defined, or nullptr.
const Token* find_undefined_name(TokenRange range, const Scope& scope);

}  // namespace opentmcl::lang
