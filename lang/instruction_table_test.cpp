#include "lang/instruction_table.hpp"

#include <gtest/gtest.h>

#include <string>

namespace opentmcl::lang {
namespace {

TEST(InstructionTable, FindsEveryMnemonicInAnyCase) {
  for (const InstructionSpec& row : instructions) {
    if (row.mnemonic == nullptr) continue;
    EXPECT_EQ(find_mnemonic(row.mnemonic), &row);
    std::string lower;
    for (const char* c = row.mnemonic; *c != '\0'; ++c) lower += static_cast<char>(*c | 0x20);
    EXPECT_EQ(find_mnemonic(lower), &row);
  }
}

TEST(InstructionTable, FindsNothingElse) {
  for (const char* name : {"", "M", "MVPX", "CALCVVX", "UF8", "ANAMETHATISLONG", "_"}) {
    EXPECT_EQ(find_mnemonic(name), nullptr) << name;
  }
}

TEST(InstructionTable, TurnsWordsIntoValuesAndBack) {
  EXPECT_EQ(find_word(OperandKind::mvp_mode, "coord"), 2);
  EXPECT_EQ(find_word(OperandKind::condition, "ESD"), 12);
  EXPECT_EQ(find_word(OperandKind::calc_operation, "SWAP"), -1);
  EXPECT_EQ(find_word(OperandKind::variable_value_operation, "SWAP"), -1);
  EXPECT_EQ(find_word(OperandKind::variable_value_operation, "COMP"), 11);
  EXPECT_EQ(find_word(OperandKind::motor, "ABS"), -1);
  EXPECT_STREQ(word_of(OperandKind::wait_event, 4), "RFS");
  EXPECT_EQ(word_of(OperandKind::wait_event, 5), nullptr);
  EXPECT_EQ(word_of(OperandKind::variable_value_operation, 10), nullptr);
}

TEST(InstructionTable, DescribesModules) {
  EXPECT_EQ(describe(tmcm1110), "TMCM-1110 (firmware V1.08)");
  EXPECT_EQ(describe(pd1161), "PD-1161 (firmware V1.47)");
}

}  // namespace
}  // namespace opentmcl::lang
