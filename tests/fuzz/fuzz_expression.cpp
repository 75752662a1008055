#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

#include "lang/expression.hpp"
#include "lang/formatter.hpp"
#include "lang/lexer.hpp"
#include "lang/statement.hpp"
#include "tests/fuzz/fuzzed_program.hpp"
#include "tests/fuzz/property.hpp"

using namespace opentmcl;
using fuzz::require;

namespace {

/// The value of the constant that `line` defines.
lang::Evaluation value_of(const std::string& line) {
  lang::SymbolTable symbols;
  symbols.insert({"A", lang::SymbolKind::constant, 3.5, {}});
  symbols.insert({"Label", lang::SymbolKind::label, 7, {}});
  lang::Lexer lexer(line);
  lang::Statement statement;
  lang::read_statement(lexer, statement);
  if (statement.kind != lang::StatementKind::constant) return {};
  lang::DiagnosticList diagnostics;
  const lang::Evaluation evaluation = lang::evaluate(statement.operands.front(), {0, line, &symbols, 2}, diagnostics);
  require(diagnostics.has_errors() == (evaluation.state == lang::Evaluation::State::failed), "what fails is reported");
  return evaluation;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string line = "X = " + std::string(fuzz::text_of(data, size));
  const lang::Evaluation before = value_of(line);
  const lang::Evaluation after = value_of(lang::format_source(line));
  require(before.state == after.state, "a formatted expression means what it did");
  if (before.state == lang::Evaluation::State::value) {
    require(std::bit_cast<std::uint64_t>(before.value) == std::bit_cast<std::uint64_t>(after.value),
            "a formatted expression has the same value");
  }
  return 0;
}
