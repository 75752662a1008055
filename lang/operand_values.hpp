#pragma once

#include <cstddef>
#include <string_view>

#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/source.hpp"
#include "lang/source_line.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

/// The instruction of a line as far as it is known: names that nobody defines, expressions that have no value and
/// operands that are still missing leave a 0.
struct OperandValues {
  Command command{};
  bool is_known[maximum_operands] = {};
};

/// `line` is of `text`, which is file `file` of the sources `symbols` are of, and has an instruction. Definitions
/// further down count, too.
OperandValues operand_values(const SourceLine& line, std::string_view text, FileId file, SymbolTable& symbols);

}  // namespace opentmcl::lang
