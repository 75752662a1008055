#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/modules.hpp"
#include "lang/explanation.hpp"
#include "lang/source.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

/// What can be written where a text cursor is.
struct CursorPlace {
  enum class Kind : std::uint8_t {
    nothing,     ///< in a comment, say, or where a sign has to come
    statement,   ///< a mnemonic, or the name of a constant
    directive,   ///< behind a #
    file_name,   ///< to include
    expression,  ///< the value of a constant
    operand,
  };

  Kind kind = Kind::nothing;
  const InstructionSpec* instruction = nullptr;  ///< of an operand; none if there is no such instruction
  std::size_t operand = 0;                       ///< counts from 0
  bool is_alone = false;    ///< nothing but the word being written stands in the operand before the cursor
  std::uint32_t start = 0;  ///< where the word, number or file name begins that is being written

  /// The row of the operand; nullptr if there is none.
  const OperandSpec* spec() const;
};

CursorPlace place_of_cursor(std::string_view text, std::size_t offset);

enum class CompletionKind : std::uint8_t { mnemonic, directive, word, number, constant, label, function };

struct Completion {
  CompletionKind kind;
  std::string text;         ///< what is written
  std::string label;        ///< what a list shows: "4 maximum positioning speed"
  Explanation explanation;  ///< empty title for none
};

/// A list with more items helps nobody.
inline constexpr std::size_t most_completions = 1000;

struct CompletionList {
  std::vector<Completion> items;
  bool is_complete = true;  ///< false where there are more than were wanted
};

/// What can be written at a place and has the letters of `written` in this order, as far as that says what is wanted;
/// nothing for file names.
/// @param file,offset where the cursor is: constants that are defined behind it are left out
/// @param symbols what the program defines
CompletionList completions(const CursorPlace& place, std::string_view written, FileId file, std::size_t offset,
                           const SymbolTable& symbols, const ModuleDescription& module);

}  // namespace opentmcl::lang
