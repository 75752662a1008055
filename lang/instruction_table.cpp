#include "lang/instruction_table.hpp"

#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

// Mnemonics are found by a hash without collisions: the compiler looks for a multiplier that has none.
constexpr std::size_t slot_bits = 10;
constexpr std::uint8_t free_slot = 255;
static_assert(instruction_count < free_slot);

constexpr std::size_t slot_of(std::uint64_t packed_mnemonic, std::uint64_t multiplier) {
  return static_cast<std::size_t>(packed_mnemonic * multiplier >> (64 - slot_bits));
}

struct MnemonicTable {
  std::uint64_t multiplier = 0;
  std::uint64_t packed[instruction_count] = {};
  std::uint8_t rows[1U << slot_bits] = {};
};

consteval bool fill(MnemonicTable& table, std::uint64_t multiplier) {
  table.multiplier = multiplier;
  for (std::uint8_t& row : table.rows) row = free_slot;
  for (std::size_t i = 0; i < instruction_count; ++i) {
    if (instructions[i].mnemonic == nullptr) continue;
    table.packed[i] = packed_name(instructions[i].mnemonic);
    std::uint8_t& row = table.rows[slot_of(table.packed[i], multiplier)];
    if (table.packed[i] == 0 || row != free_slot) return false;
    row = static_cast<std::uint8_t>(i);
  }
  return true;
}

consteval MnemonicTable make_mnemonic_table() {
  MnemonicTable table;
  std::uint64_t multiplier = 0x9E3779B97F4A7C15U;  // odd, its bits well mixed: 2^64 divided by the golden ratio
  while (!fill(table, multiplier)) multiplier += 0x9E3779B97F4A7C16U;
  return table;
}

constexpr MnemonicTable mnemonics = make_mnemonic_table();

constexpr std::size_t kind_count = static_cast<std::size_t>(OperandKind::error_flag) + 1;
constexpr std::size_t maximum_words = 16;

consteval bool kinds_that_take_words_are_last() {
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    const auto operand_kind = static_cast<OperandKind>(kind);
    if (takes_words(operand_kind) != (keywords_of(operand_kind).count != 0)) return false;
  }
  return true;
}
static_assert(kinds_that_take_words_are_last());

struct WordTable {
  std::uint64_t packed[kind_count][maximum_words] = {};
};

consteval WordTable make_word_table() {
  WordTable table;
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    const KeywordSet set = keywords_of(static_cast<OperandKind>(kind));
    for (std::size_t i = 0; i < set.count; ++i) table.packed[kind][i] = packed_name(set.words[i].word);
  }
  return table;
}

consteval bool all_words_are_packed() {
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    const KeywordSet set = keywords_of(static_cast<OperandKind>(kind));
    for (std::size_t i = 0; i < set.count; ++i) {
      if (packed_name(set.words[i].word) == 0) return false;
    }
  }
  return true;
}
static_assert(all_words_are_packed());

constexpr WordTable words = make_word_table();

}  // namespace

const InstructionSpec* find_mnemonic(std::string_view mnemonic) {
  return find_packed_mnemonic(packed_name(mnemonic));
}

const InstructionSpec* find_packed_mnemonic(std::uint64_t packed) {
  const std::uint8_t row = mnemonics.rows[slot_of(packed, mnemonics.multiplier)];
  return row != free_slot && mnemonics.packed[row] == packed ? &instructions[row] : nullptr;
}

int find_word(OperandKind kind, std::string_view word) {
  return find_packed_word(kind, packed_name(word));
}

int find_packed_word(OperandKind kind, std::uint64_t packed) {
  const KeywordSet set = keywords_of(kind);
  for (std::size_t i = 0; i < set.count; ++i) {
    if (words.packed[static_cast<std::size_t>(kind)][i] != packed) continue;
    return set.words[i].value == set.excluded ? -1 : set.words[i].value;
  }
  return -1;
}

const char* word_of(OperandKind kind, std::int32_t value) {
  const KeywordSet set = keywords_of(kind);
  for (std::size_t i = 0; i < set.count; ++i) {
    if (set.words[i].value == value && value != set.excluded) return set.words[i].word;
  }
  return nullptr;
}

std::string describe(const ModuleDescription& module) {
  const std::string minor = std::to_string(module.firmware_minor);
  return std::string(module.name) + " (firmware V" + std::to_string(module.firmware_major) + "." +
         std::string(minor.size() < 2 ? "0" : "") + minor + ")";
}

}  // namespace opentmcl::lang
