#include "apps/tmcl/unified_diff.hpp"

#include <gtest/gtest.h>

#include <string>

namespace opentmcl::app {

std::string diff_of(std::string_view source) {
  return unified_diff("p.tmc", source, lang::formatting_of(source).edits);
}

TEST(UnifiedDiff, IsEmptyWithoutChanges) {
  EXPECT_EQ("", diff_of("    STOP\n"));
}

TEST(UnifiedDiff, ShowsThreeLinesAroundAChange) {
  EXPECT_EQ(
      "--- a/p.tmc\n+++ b/p.tmc\n"
      "@@ -2,7 +2,8 @@\n"
      " // 2\n // 3\n // 4\n"
      "-L: stop\n+L:\n+    STOP\n"
      " // 6\n // 7\n // 8\n",
      diff_of("// 1\n// 2\n// 3\n// 4\nL: stop\n// 6\n// 7\n// 8\n// 9\n"));
}

TEST(UnifiedDiff, CountsLinesAddedBefore) {
  EXPECT_EQ(
      "--- a/p.tmc\n+++ b/p.tmc\n"
      "@@ -1,4 +1,5 @@\n"
      "-L: stop\n+L:\n+    STOP\n"
      " // 2\n // 3\n // 4\n"
      "@@ -7,4 +8,4 @@\n"
      " // 7\n // 8\n // 9\n"
      "-stop\n\\ No newline at end of file\n+    STOP\n",
      diff_of("L: stop\n// 2\n// 3\n// 4\n// 5\n// 6\n// 7\n// 8\n// 9\nstop"));
}

TEST(UnifiedDiff, JoinsChangesThatAreClose) {
  EXPECT_EQ(
      "--- a/p.tmc\n+++ b/p.tmc\n"
      "@@ -1,4 +1,3 @@\n"
      "-stop\n-stop\n+    STOP\n+    STOP\n"
      " // 3\n"
      "-\n",
      diff_of("stop\nstop\n// 3\n\n"));
}

TEST(UnifiedDiff, EmptiesAFile) {
  EXPECT_EQ("--- a/p.tmc\n+++ b/p.tmc\n@@ -1,2 +0,0 @@\n-\n-\n", diff_of("\n\n"));
}

}  // namespace opentmcl::app
