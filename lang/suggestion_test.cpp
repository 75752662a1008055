#include "lang/suggestion.hpp"

#include <gtest/gtest.h>

namespace opentmcl::lang {
namespace {

TEST(EditDistance, CountsMissingSurplusWrongAndSwappedLetters) {
  EXPECT_EQ(edit_distance("WAIT", "wait", 9), 0U);
  EXPECT_EQ(edit_distance("WAT", "WAIT", 9), 1U);
  EXPECT_EQ(edit_distance("WAITT", "WAIT", 9), 1U);
  EXPECT_EQ(edit_distance("WAXT", "WAIT", 9), 1U);
  EXPECT_EQ(edit_distance("WIAT", "WAIT", 9), 1U);
  EXPECT_EQ(edit_distance("", "WAIT", 9), 4U);
}

TEST(EditDistance, StopsAboveTheLimit) {
  EXPECT_EQ(edit_distance("ABCDEF", "UVWXYZ", 2), 3U);
}

TEST(Suggestion, NamesTheClosestCandidate) {
  Suggestion suggestion("GPA");
  for (const char* name : {"SAP", "GAP", "GGP"}) suggestion.consider(name);
  EXPECT_EQ(suggestion.text(), "did you mean GAP?");
}

TEST(Suggestion, IsSilentIfNothingIsClose) {
  Suggestion suggestion("XYZZY");
  for (const char* name : {"SAP", "GAP", "GGP"}) suggestion.consider(name);
  EXPECT_EQ(suggestion.text(), "");
}

}  // namespace
}  // namespace opentmcl::lang
