#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lang/statement.hpp"

namespace opentmcl::lang {

/// A statement as the formatter writes it, without its labels: "MVP ABS, 0, -(A + 2) * B". `source` is the text the
/// tokens are of. The tokens stay the same but for the case of mnemonics, words and functions. Of a constant this is
/// the value alone, because names of constants are aligned. Nothing for a line the assembler would refuse whatever its
/// names mean: with an unknown mnemonic or directive, or with an operand missing.
std::optional<std::string> statement_text(const Statement& statement, std::string_view source);

}  // namespace opentmcl::lang
