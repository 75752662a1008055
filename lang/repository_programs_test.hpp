// The programs the repository has: examples and test programs.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "lang/file_provider.hpp"

namespace opentmcl::lang {

struct RepositoryProgram {
  std::string path;
  std::string text;
};

/// All of them, in the order of their paths.
inline std::vector<RepositoryProgram> repository_programs() {
  std::vector<RepositoryProgram> programs;
  DiskFiles files;
  for (const char* const folder : {OPENTMCL_EXAMPLES, OPENTMCL_TEST_PROGRAMS}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".tmc") continue;
      FileContent content = files.read(entry.path().string());
      EXPECT_EQ(content.state, FileContent::State::found) << entry.path();
      programs.push_back({entry.path().string(), std::move(content.text)});
    }
  }
  std::sort(programs.begin(), programs.end(),
            [](const auto& left, const auto& right) { return left.path < right.path; });
  EXPECT_GT(programs.size(), 50U);
  return programs;
}

}  // namespace opentmcl::lang
