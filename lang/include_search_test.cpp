#include "lang/include_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A disk on which one file may not be read.
class LockedFiles final : public FileProvider {
 public:
  FileContent read(const std::string& path) override {
    return {path == "locked.tmc" ? FileContent::State::unreadable : FileContent::State::missing, {}};
  }
};

AssemblyResult assemble_with(MemoryFiles& files, std::string_view name, std::string_view text,
                             std::vector<std::string> include_path = {}) {
  AssemblerOptions options;
  options.append_stop = false;
  options.include_path = std::move(include_path);
  return assemble(name, std::string(text), options, files);
}

TEST(Include, TakesTheTextOfTheFileInItsPlace) {
  MemoryFiles files;
  files.set("routines.tmc", "Wait: WAIT POS, 0, 0\nRSUB\n");
  const AssemblyResult result =
      assemble_with(files, "main.tmc", "CSUB Wait\nSTOP\n#include routines.tmc // both\nMST 0");
  ASSERT_TRUE(result.program.has_value()) << format(result.diagnostics, result.sources);
  EXPECT_THAT(result.program->commands,
              ElementsAre(command(Opcode::csub, 0, 0, 2), command(Opcode::stop), command(Opcode::wait, 1),
                          command(Opcode::rsub), command(Opcode::mst)));
  EXPECT_EQ(result.sources[result.program->source_map[2].file].name, "routines.tmc");
}

TEST(Include, LooksInTheFolderOfTheIncludingFileFirst) {
  MemoryFiles files;
  files.set("project/parts/a.tmc", "#include b.tmc");
  files.set("project/parts/b.tmc", "Value = 1");
  files.set("library/b.tmc", "Value = 2");
  files.set("library/c.tmc", "#include \"TMCLParam.tmc\"\nOther = 3");
  const AssemblyResult result = assemble_with(files, "project/main.tmc",
                                              "#include parts\\a.tmc\n#INCLUDE c.tmc\nCOMP Value + Other", {"library"});
  ASSERT_TRUE(result.program.has_value()) << format(result.diagnostics, result.sources);
  EXPECT_THAT(result.program->commands, ElementsAre(command(Opcode::comp, 0, 0, 4)));
}

TEST(Include, PrefersAFileOfTheUserToTheBuiltInOne) {
  MemoryFiles files;
  files.set("TMCLParam.tmc", "Motor0 = 7");
  const AssemblyResult result = assemble_with(files, "main.tmc", "#include TMCLParam.tmc\nCOMP Motor0");
  ASSERT_TRUE(result.program.has_value());
  EXPECT_EQ(result.program->commands[0].value, 7);
}

TEST(Include, ReportsAMissingFileAtTheDirectiveWithThePlacesLookedAt) {
  MemoryFiles files;
  const AssemblyResult result = assemble_with(files, "project/main.tmc", "  #include none.inc", {"library"});
  EXPECT_THAT(problems_of(result.diagnostics, result.sources),
              ElementsAre(Problem{DiagnosticKind::file_not_found, {1, 12}, "none.inc"}));
  EXPECT_THAT(result.diagnostics[0].note, HasSubstr("'project', 'library'"));
}

TEST(Include, ReportsAFileThatCannotBeRead) {
  LockedFiles files;
  const AssemblyResult result = assemble("main.tmc", "#include locked.tmc", {}, files);
  EXPECT_THAT(problems_of(result.diagnostics, result.sources),
              ElementsAre(Problem{DiagnosticKind::file_not_readable, {1, 10}, "locked.tmc"}));
}

TEST(Include, RefusesCyclesWhereTheyClose) {
  MemoryFiles files;
  files.set("a.tmc", "#include ./b.tmc");
  files.set("b.tmc", "\n#include folder/../a.tmc");
  const AssemblyResult result = assemble_with(files, "main.tmc", "#include a.tmc\nFOO");
  ASSERT_EQ(result.diagnostics.size(), 2U);
  EXPECT_THAT(problems_of(result.diagnostics, result.sources),
              ElementsAre(Problem{DiagnosticKind::unknown_instruction, {2, 1}, "FOO"},
                          Problem{DiagnosticKind::include_cycle, {2, 10}, "folder/../a.tmc"}));
  EXPECT_EQ(result.sources[result.diagnostics[1].span.file].name, "b.tmc");
  files.set("self.tmc", "#include self.tmc");
  EXPECT_EQ(assemble_with(files, "self.tmc", "#include self.tmc").diagnostics.at(0).kind,
            DiagnosticKind::include_cycle);
}

TEST(Include, LetsTwoFilesIncludeAThirdOne) {
  MemoryFiles files;
  files.set("a.tmc", "#include c.tmc");
  files.set("b.tmc", "#include c.tmc");
  files.set("c.tmc", "Value = 5");
  EXPECT_TRUE(assemble_with(files, "main.tmc", "#include a.tmc\n#include b.tmc\nCOMP Value").program.has_value());
}

TEST(Include, IsBoundedInNumber) {
  MemoryFiles files;
  for (int i = 0; i < 20; ++i) {
    const std::string next = "#include f" + std::to_string(i + 1) + ".tmc\n";
    files.set("f" + std::to_string(i) + ".tmc", next + next);
  }
  files.set("f20.tmc", "");
  const AssemblyResult result = assemble_with(files, "main.tmc", "#include f0.tmc");
  EXPECT_FALSE(result.program.has_value());
  EXPECT_LE(result.sources.size(), 1000U);
  EXPECT_EQ(result.diagnostics.at(0).kind, DiagnosticKind::too_many_includes);
}

TEST(Include, ReportsErrorsOfAllFiles) {
  MemoryFiles files;
  files.set("a.tmc", "BAR");
  const AssemblyResult result = assemble_with(files, "main.tmc", "FOO\n#include a.tmc\nBAZ");
  ASSERT_EQ(result.diagnostics.size(), 3U);
  EXPECT_EQ(format(result.diagnostics[2], result.sources).substr(0, 17), "a.tmc:1:1: error:");
}

}  // namespace
}  // namespace opentmcl::lang
