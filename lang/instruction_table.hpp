// The instruction table of the firmware, arranged for looking up what a source says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::lang {

/// The row with this mnemonic, whatever module has it, or nullptr. Case does not matter.
const InstructionSpec* find_mnemonic(std::string_view mnemonic);
/// The same for a `packed_name`.
const InstructionSpec* find_packed_mnemonic(std::uint64_t packed);

struct OperandCounts {
  std::uint8_t of_row[instruction_count];
};

consteval OperandCounts count_operands() {
  OperandCounts counts{};
  for (std::size_t row = 0; row < instruction_count; ++row) {
    std::uint8_t& count = counts.of_row[row];
    while (count < maximum_operands && instructions[row].operands[count].kind != OperandKind::none) ++count;
  }
  return counts;
}

inline constexpr OperandCounts operand_counts = count_operands();

/// Number of operands in the mnemonic form. `instruction` is a row of `instructions`.
constexpr std::size_t operand_count(const InstructionSpec& instruction) {
  return operand_counts.of_row[&instruction - instructions];
}

/// Operands nobody has to write; they are 0 then. Only the user functions, whose meaning the customer defines, have
/// any.
constexpr bool operands_are_optional(const InstructionSpec& instruction) {
  return instruction.opcode >= Opcode::uf0 && instruction.opcode <= Opcode::uf7;
}

/// The value `word` stands for as an operand of this kind, or -1. Case does not matter.
int find_word(OperandKind kind, std::string_view word);
/// The same for a `packed_name`.
int find_packed_word(OperandKind kind, std::uint64_t packed);

/// The same for constants of the program, in capital letters.
consteval int value_of_word(OperandKind kind, std::string_view word) {
  const KeywordSet set = keywords_of(kind);
  for (std::size_t i = 0; i < set.count; ++i) {
    if (set.words[i].word == word) return set.words[i].value;
  }
  return -1;
}

/// The word for a value of an operand of this kind, or nullptr if there is none.
const char* word_of(OperandKind kind, std::int32_t value);

/// Whether operands of this kind are written as words, so that no other values have a meaning.
constexpr bool takes_words(OperandKind kind) {
  return kind >= OperandKind::mvp_mode;
}

/// "TMCM-1110 (firmware V1.08)"
std::string describe(const ModuleDescription& module);

}  // namespace opentmcl::lang
