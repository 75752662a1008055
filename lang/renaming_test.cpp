#include "lang/renaming.hpp"

#include <gtest/gtest.h>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

std::string refusal(std::string_view name, std::string_view new_name) {
  const AssemblyResult result = assemble_text("#include TMCLParam.tmc\nSpeed = 100\nLoop: ROR 0, Speed\nJA Lopp\n");
  if (auto refused = refusal_to_rename(name, result.symbols, result.sources)) return *refused;
  return refusal_of_new_name(name, new_name, NameIndex(result.sources)).value_or("");
}

TEST(Renaming, TakesAnyFreeName) {
  EXPECT_EQ(refusal("Speed", "Top_Speed2"), "");
  EXPECT_EQ(refusal("loop", "LOOP"), "") << "another spelling of the same name";
}

TEST(Renaming, RefusesWhatIsNoName) {
  for (const char* name : {"", "2nd", "a b", "a-b", "\xC3\xA4"}) {
    EXPECT_NE(refusal("Speed", name).find("is not a name"), std::string::npos) << name;
  }
}

TEST(Renaming, RefusesANameThatIsTaken) {
  EXPECT_EQ(refusal("Speed", "loop"), "'loop' is in use already");
  EXPECT_EQ(refusal("Speed", "lopp"), "'lopp' is in use already") << "although nothing defines it";
  EXPECT_EQ(refusal("Speed", "Motor0"), "'Motor0' is in use already") << "by a built-in file";
}

TEST(Renaming, RefusesWordsOfTheLanguage) {
  for (const char* word : {"mvp", "ABS", "GE", "sqrt", "TICKS"}) {
    EXPECT_EQ(refusal("Speed", word), std::string("'") + word + "' is a word of the language");
  }
}

TEST(Renaming, RefusesToChangeWhatNobodyCanEdit) {
  EXPECT_EQ(refusal("motor0", "First"),
            "'motor0' is defined in TMCLParam.tmc, which is built in and cannot be changed");
  EXPECT_EQ(refusal("Lopp", "First"), "'Lopp' is not defined");
}

}  // namespace
}  // namespace opentmcl::lang
