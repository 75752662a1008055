#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lang/name_index.hpp"
#include "lang/source.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

/// Why a name that the sources use cannot be given a new spelling, as a sentence without a full stop; none if it can.
/// @param defined what the program defines
std::optional<std::string> refusal_to_rename(std::string_view name, const SymbolTable& defined, const Sources& sources);

/// Why `new_name` cannot stand wherever `name` stands now; none if it can. A word of the language cannot: where an
/// operand may be a word, it would be taken for one.
std::optional<std::string> refusal_of_new_name(std::string_view name, std::string_view new_name,
                                               const NameIndex& names);

}  // namespace opentmcl::lang
