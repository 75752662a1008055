#include "lang/name_index.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "lang/assembler.hpp"

namespace opentmcl::lang {

// NOLINTNEXTLINE(readability-identifier-naming): the name is GoogleTest's
inline void PrintTo(const Span& span, std::ostream* out) {
  *out << "file " << span.file << ", " << span.offset << " + " << span.length;
}

namespace {

using testing::ElementsAre;

std::vector<Span> spans_of(const std::vector<NameUse>& uses) {
  std::vector<Span> spans;
  spans.reserve(uses.size());
  for (const NameUse& use : uses) spans.push_back(use.span);
  return spans;
}

Sources sources_of(const std::string& text) {
  Sources sources;
  sources.add("test.tmc", text);
  return sources;
}

TEST(NameIndex, FindsAllUsesOfANameWhateverItsCase) {
  const Sources sources = sources_of("Loop: SAP 4, 0, loop\n JC ZE, LOOP // Loop\n JA Loops\n");
  const NameIndex names(sources);
  EXPECT_THAT(spans_of(names.uses_of("lOOp")), ElementsAre(Span{0, 0, 4}, Span{0, 16, 4}, Span{0, 29, 4}));
  EXPECT_TRUE(names.uses_of("loop").front().is_definition);
  EXPECT_FALSE(names.uses_of("loop").back().is_definition);
  EXPECT_TRUE(names.uses_of("nobody").empty());
}

TEST(NameIndex, KnowsTheNameAtAPlace) {
  const Sources sources = sources_of("A = 1\nB = A + A1\n");
  const NameIndex names(sources);
  EXPECT_EQ(names.name(names.at(0, 0)->number), "A");
  EXPECT_EQ(names.name(names.at(0, 1)->number), "A") << "directly behind it";
  EXPECT_EQ(names.at(0, 2), nullptr);
  EXPECT_EQ(names.name(names.at(0, 10)->number), "A");
  EXPECT_EQ(names.name(names.at(0, 16)->number), "A1");
  EXPECT_EQ(names.at(0, 17), nullptr);
}

TEST(NameIndex, LooksAtAFileThatIsIncludedTwiceOnce) {
  MemoryFiles files;
  files.set("common.inc", "Speed = 100\n");
  files.set("other.inc", "#include common.inc\nDouble = 2 * Speed\n");
  AssemblyResult result = assemble("test.tmc", "#include common.inc\n#include other.inc\nROR 0, Speed\n", {}, files);
  ASSERT_TRUE(result.program);
  ASSERT_EQ(result.sources.size(), 4U);
  const NameIndex names(result.sources);
  EXPECT_THAT(spans_of(names.uses_of("speed")), ElementsAre(Span{0, 46, 5}, Span{1, 0, 5}, Span{2, 33, 5}));
  EXPECT_EQ(names.first_id_of(3), 1U);
  EXPECT_EQ(names.at(3, 2), names.at(1, 2));
}

TEST(NameIndex, TakesNoWordsAndFunctionsForNames) {
  const Sources sources = sources_of("MVP ABS, 0, ABS(-1)\nSAP ABS, 0, 0\n");
  const NameIndex names(sources);
  EXPECT_THAT(spans_of(names.uses_of("ABS")), ElementsAre(Span{0, 24, 3}));
}

}  // namespace
}  // namespace opentmcl::lang
