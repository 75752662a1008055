// docs/diagnostics.md explains every error and warning, and its examples are true.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

constexpr const char* example_name = "example.tmc";

/// One ```tmcl block of the page.
struct Example {
  std::string kind;  ///< the heading it stands below
  std::string text;
  bool is_mended = false;
  bool append_stop = true;
  const ModuleDescription* module = &pd1161;
};

struct Page {
  std::vector<std::string> sections;
  std::vector<Example> examples;
};

Example example_of(const std::string& section, const std::string& attributes) {
  Example example;
  example.kind = section;
  std::istringstream words(attributes);
  for (std::string word; words >> word;) {
    if (word == "mended") {
      example.is_mended = true;
    } else if (word == "append-stop=no") {
      example.append_stop = false;
    } else if (word == "module=tmcm1110") {
      example.module = &tmcm1110;
    } else {
      ADD_FAILURE() << "unknown attribute " << word << " in section " << section;
    }
  }
  return example;
}

Page read_page() {
  DiskFiles files;
  const FileContent content = files.read(OPENTMCL_DIAGNOSTICS_PAGE);
  EXPECT_EQ(content.state, FileContent::State::found);
  const std::string section_mark = "### ";
  const std::string begin_mark = "```tmcl";
  Page page;
  std::istringstream text(content.text);
  std::optional<Example> open;
  for (std::string line; std::getline(text, line);) {
    if (line.compare(0, section_mark.size(), section_mark) == 0) {
      page.sections.push_back(line.substr(section_mark.size()));
    } else if (line.compare(0, begin_mark.size(), begin_mark) == 0) {
      open = example_of(page.sections.back(), line.substr(begin_mark.size()));
    } else if (open && line == "```") {
      page.examples.push_back(*open);
      open.reset();
    } else if (open) {
      open->text += line + "\n";
    }
  }
  return page;
}

AssemblyResult assembled(const std::string& text, const Example& example = {}) {
  MemoryFiles files;
  files.set(example_name, text);
  AssemblerOptions options;
  options.module = example.module;
  options.append_stop = example.append_stop;
  return assemble(example_name, text, options, files);
}

std::set<std::string> names_of(const std::vector<Diagnostic>& diagnostics) {
  std::set<std::string> names;
  for (const Diagnostic& diagnostic : diagnostics) names.insert(name_of(diagnostic.kind));
  return names;
}

std::string repeated(const std::string& piece, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += piece;
  return text;
}

class FilesThatAreNot : public FileProvider {
 public:
  explicit FilesThatAreNot(FileContent::State state) : state_(state) {}
  FileContent read(const std::string&) override { return {state_, {}}; }

 private:
  FileContent::State state_;
};

std::vector<Diagnostic> diagnostics_with_file(FileContent::State state) {
  FilesThatAreNot files(state);
  return assemble(example_name, "#include other.tmc\n", {}, files).diagnostics;
}

std::vector<Diagnostic> diagnostics_of_nested_files() {
  MemoryFiles files;
  for (int depth = 0; depth < 50; ++depth) {
    files.set("f" + std::to_string(depth), "#include f" + std::to_string(depth + 1) + "\n");
  }
  return assemble("f0", "#include f1\n", {}, files).diagnostics;
}

/// What needs more than a few lines to happen.
const std::map<std::string, std::function<std::vector<Diagnostic>()>> made_here = {
    {"not-text", [] { return assembled("MST 0\n\x02\n").diagnostics; }},
    {"line-too-long", [] { return assembled(repeated("MST 0 ", 20000)).diagnostics; }},
    {"not-one-instruction", [] { return parse_instruction("MST 0\nMST 0", pd1161).diagnostics; }},
    {"file-not-readable", [] { return diagnostics_with_file(FileContent::State::unreadable); }},
    {"file-too-large", [] { return diagnostics_with_file(FileContent::State::too_large); }},
    {"too-many-includes", diagnostics_of_nested_files},
    {"expression-too-deep", [] { return assembled("COMP " + repeated("(", 300)).diagnostics; }},
    {"program-too-large", [] { return assembled(repeated("MST 0\n", 2049)).diagnostics; }},
};

TEST(DiagnosticsPage, HasOneSectionForEveryKind) {
  const Page page = read_page();
  std::set<std::string> kinds;
  for (const DiagnosticKindSpec& row : diagnostic_kinds) kinds.insert(row.name);
  EXPECT_EQ(std::set<std::string>(page.sections.begin(), page.sections.end()), kinds);
  EXPECT_EQ(page.sections.size(), kinds.size()) << "a section stands there twice";
}

TEST(DiagnosticsPage, ShowsExamplesThatComplainOfJustThat) {
  for (const Example& example : read_page().examples) {
    if (example.is_mended) continue;
    const AssemblyResult result = assembled(example.text, example);
    EXPECT_EQ(names_of(result.diagnostics), std::set{example.kind}) << format(result.diagnostics, result.sources);
  }
}

TEST(DiagnosticsPage, ShowsMendedExamplesThatAreClean) {
  for (const Example& example : read_page().examples) {
    if (!example.is_mended) continue;
    const AssemblyResult result = assembled(example.text, example);
    EXPECT_EQ(format(result.diagnostics, result.sources), "") << example.kind;
    EXPECT_TRUE(result.program.has_value());
  }
}

TEST(DiagnosticsPage, OrThisTestHasAnExampleForEveryKind) {
  std::set<std::string> shown{"too-many-problems", "too-many-warnings"};  // of other kinds: assembler_test.cpp
  for (const Example& example : read_page().examples) shown.insert(example.kind);
  for (const auto& [name, make] : made_here) {
    EXPECT_EQ(names_of(make()), std::set{name});
    shown.insert(name);
  }
  for (const DiagnosticKindSpec& row : diagnostic_kinds) EXPECT_EQ(shown.count(row.name), 1U) << row.name;
}

TEST(DiagnosticsPage, ShowsWarningsThatCanBeSwitchedOff) {
  for (const Example& example : read_page().examples) {
    const std::optional<DiagnosticKind> kind = find_warning(example.kind);
    if (!kind || example.is_mended) continue;
    MemoryFiles files;
    AssemblerOptions options;
    options.module = example.module;
    options.append_stop = example.append_stop;
    EXPECT_TRUE(assemble(example_name, "// no-warning: " + example.kind + "\n" + example.text, options, files)
                    .diagnostics.empty())
        << example.kind;
    options.switched_off.set(index_of(*kind));
    EXPECT_TRUE(assemble(example_name, example.text, options, files).diagnostics.empty()) << example.kind;
    options.switched_off.reset();
    options.warnings_as_errors = true;
    EXPECT_FALSE(assemble(example_name, example.text, options, files).program.has_value()) << example.kind;
  }
}

}  // namespace
}  // namespace opentmcl::lang
