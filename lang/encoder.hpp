#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/diagnostic.hpp"
#include "lang/expression.hpp"
#include "lang/statement.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

enum class Pass : std::uint8_t {
  reading,   ///< names may be defined further down
  finishing  ///< all names are known
};

enum class Encoding : std::uint8_t {
  done,
  undefined_names,  ///< only while reading; nothing was reported
  failed            ///< reported
};

/// Writes the operands of a statement into the fields of an instruction, as the instruction table has them.
class InstructionEncoder {
 public:
  /// Both arguments must outlive the encoder.
  InstructionEncoder(const ModuleDescription& module, DiagnosticList& diagnostics)
      : module_(&module), diagnostics_(&diagnostics) {}

  Encoding encode(const InstructionSpec& instruction, const Statement& statement, const Scope& scope, Pass pass,
                  Command& command);

 private:
  Encoding encode_operand(const OperandSpec& operand, TokenRange range, const Scope& scope, Pass pass,
                          Command& command);
  Encoding check_surplus(const InstructionSpec& instruction, TokenRange range, const Scope& scope, Pass pass);
  Encoding find_value(TokenRange range, const Scope& scope, Pass pass, OperandKind kind, double& number);

  // Each of these reports a failure, which keeps that out of the way of what is encoded.
  [[gnu::cold]] Encoding report_count(const InstructionSpec& instruction, const Statement& statement,
                                      const Scope& scope);
  [[gnu::cold]] Encoding report_not_encodable(Field field, TokenRange range, const Scope& scope);
  [[gnu::cold]] Encoding report_no_word(OperandKind kind, std::int32_t value, TokenRange range, const Scope& scope);

  const ModuleDescription* module_;
  DiagnosticList* diagnostics_;
};

/// Reports a name that nothing defines, with the one the user may have meant: of `symbols` or of `words`, which could
/// stand in its place.
void report_undefined_name(Span span, std::string_view name, const SymbolTable& symbols, const KeywordSet& words,
                           DiagnosticList& diagnostics);

}  // namespace opentmcl::lang
