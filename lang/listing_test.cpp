#include "lang/listing.hpp"

#include <gtest/gtest.h>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

TEST(Listing, ShowsAddressBytesAndSourceLine) {
  const AssemblyResult result = assemble_text("// go\nLoop: MVP REL, 0, -10000\n\n  JA Loop\n", pd1161, true);
  ASSERT_TRUE(result.program.has_value());
  EXPECT_EQ(listing(*result.program, result.sources),
            "test.tmc\n"
            "                                   1  // go\n"
            "     0  04 01 00 FF FF D8 F0       2  Loop: MVP REL, 0, -10000\n"
            "                                   3  \n"
            "     1  16 00 00 00 00 00 00       4    JA Loop\n"
            "                                   5  \n"
            "     2  1C 00 00 00 00 00 00  (STOP appended)\n");
}

TEST(Listing, HasIncludedFilesOnlyIfTheyHaveInstructions) {
  MemoryFiles files;
  files.set("part.tmc", "MST 0");
  AssemblerOptions options;
  options.append_stop = false;
  const AssemblyResult result = assemble("main.tmc", "#include TMCLParam.tmc\n#include part.tmc\nSTOP", options, files);
  ASSERT_TRUE(result.program.has_value());
  EXPECT_EQ(listing(*result.program, result.sources),
            "main.tmc\n"
            "                                   1  #include TMCLParam.tmc\n"
            "                                   2  #include part.tmc\n"
            "     1  1C 00 00 00 00 00 00       3  STOP\n"
            "part.tmc\n"
            "     0  03 00 00 00 00 00 00       1  MST 0\n");
}

}  // namespace
}  // namespace opentmcl::lang
