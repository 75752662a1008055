#include "lang/symbol_table.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

TEST(SymbolTable, FindsNamesIgnoringCase) {
  SymbolTable table;
  EXPECT_EQ(table.find("MaxSpeed"), nullptr);
  EXPECT_EQ(table.insert({"MaxSpeed", SymbolKind::constant, 5, {}}), nullptr);
  ASSERT_NE(table.find("MAXspeed"), nullptr);
  EXPECT_EQ(table.find("MAXspeed")->value, 5);
  EXPECT_EQ(table.find("MaxSpeed1"), nullptr);
}

TEST(SymbolTable, KeepsTheFirstOfTwoSymbolsWithOneName) {
  SymbolTable table;
  table.insert({"a", SymbolKind::constant, 1, {}});
  const Symbol* const taken = table.insert({"A", SymbolKind::label, 2, {}});
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->value, 1);
  EXPECT_EQ(table.symbols().size(), 1U);
}

RC_GTEST_PROP(SymbolTable, HoldsWhatAMapHolds, ()) {
  const auto names = *rc::gen::container<std::vector<std::string>>(
      rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::elementOf(std::string("aAbB_1")))));
  SymbolTable table;
  std::map<std::string, double> expected;
  double value = 0;
  for (const std::string& name : names) {
    std::string upper;
    for (const char c : name) upper += to_upper(c);
    const bool is_new = expected.emplace(upper, value).second;
    RC_ASSERT((table.insert({name, SymbolKind::constant, value, {}}) == nullptr) == is_new);
    value += 1;
  }
  for (const auto& [name, number] : expected) {
    const Symbol* const symbol = table.find(name);
    RC_ASSERT(symbol != nullptr);
    RC_ASSERT(symbol->value == number);
  }
}

RC_GTEST_PROP(Names, DifferByAnyCharacterAndNotByCase, ()) {
  const auto length = *rc::gen::inRange<std::size_t>(1, 40);
  const auto name = *rc::gen::container<std::string>(length, rc::gen::elementOf(std::string("azAZ_059")));
  const auto at = *rc::gen::inRange<std::size_t>(0, length);
  std::string other_case = name;
  if (starts_name(name[at]) && name[at] != '_') other_case[at] = static_cast<char>(name[at] ^ 0x20);
  std::string other_name = name;
  other_name[at] = to_upper(name[at]) == 'M' ? 'N' : 'M';
  RC_ASSERT(is_same_name(name, other_case));
  RC_ASSERT(hash_of_name(name) == hash_of_name(other_case));
  RC_ASSERT(!is_same_name(name, other_name));
  RC_ASSERT(hash_of_name(name) != hash_of_name(other_name));
}

TEST(SymbolTable, GrowsWithoutLosingNames) {
  std::vector<std::string> names;
  names.reserve(5000);
  for (int i = 0; i < 5000; ++i) names.push_back("Name" + std::to_string(i));
  SymbolTable table;
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.insert({names[i], SymbolKind::label, static_cast<double>(i), {}});
  }
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(table.find(names[i])->value, static_cast<double>(i));
}

}  // namespace
}  // namespace opentmcl::lang
