// Every program in examples/ is one for both modules and assembles without a complaint.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

TEST(Examples, AssembleWithoutComplaintForEveryModule) {
  DiskFiles files;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(OPENTMCL_EXAMPLES)) {
    if (entry.path().extension() != ".tmc") continue;
    ++count;
    const FileContent content = files.read(entry.path().string());
    ASSERT_EQ(content.state, FileContent::State::found) << entry.path();
    for (const ModuleDescription& module : modules) {
      AssemblerOptions options;
      options.module = &module;
      const AssemblyResult result = assemble(entry.path().string(), content.text, options, files);
      EXPECT_EQ(format(result.diagnostics, result.sources), "");
      EXPECT_TRUE(result.program.has_value());
    }
  }
  EXPECT_GT(count, 0);
}

TEST(DiskFiles, TellsMissingFilesFromUnreadableOnes) {
  DiskFiles files;
  EXPECT_EQ(files.read(OPENTMCL_EXAMPLES "/none.tmc").state, FileContent::State::missing);
  EXPECT_EQ(files.read(OPENTMCL_EXAMPLES).state, FileContent::State::unreadable);
}

}  // namespace
}  // namespace opentmcl::lang
