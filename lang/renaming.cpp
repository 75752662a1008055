#include "lang/renaming.hpp"

#include <algorithm>
#include <cstddef>

#include "firmware/spec/instructions.hpp"
#include "lang/diagnostic.hpp"
#include "lang/expression.hpp"
#include "lang/include_files.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

bool is_name(std::string_view text) {
  return !text.empty() && starts_name(text.front()) && std::all_of(text.begin(), text.end(), continues_name);
}

bool is_word_of_the_language(std::string_view name) {
  if (find_mnemonic(name) != nullptr) return true;
  const bool is_function = std::any_of(functions, functions + function_count, [&](const FunctionSpec& function) {
    return equal_ignoring_case(function.name, name);
  });
  if (is_function) return true;
  for (const InstructionSpec& instruction : instructions) {
    for (const OperandSpec& operand : instruction.operands) {
      if (takes_words(operand.kind) && find_word(operand.kind, name) >= 0) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<std::string> refusal_to_rename(std::string_view name, const SymbolTable& defined,
                                             const Sources& sources) {
  const Symbol* const symbol = defined.find(name);
  if (symbol == nullptr) return in_quotes(name) + " is not defined";
  const SourceFile& file = sources[symbol->span.file];
  if (file.is_built_in) {
    return in_quotes(name) + " is defined in " + file.name + ", which is built in and cannot be changed";
  }
  return std::nullopt;
}

std::optional<std::string> refusal_of_new_name(std::string_view name, std::string_view new_name,
                                               const NameIndex& names) {
  if (!is_name(new_name)) {
    return in_quotes(new_name) + " is not a name: letters, digits and underscores, a digit never first";
  }
  if (equal_ignoring_case(name, new_name)) return std::nullopt;
  if (is_word_of_the_language(new_name)) return in_quotes(new_name) + " is a word of the language";
  if (names.contains(new_name)) return in_quotes(new_name) + " is in use already";
  return std::nullopt;
}

}  // namespace opentmcl::lang
