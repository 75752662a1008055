#include "lang/diagnostic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <string>

namespace opentmcl::lang {
namespace {

std::string shown(const std::string& text, Span span, DiagnosticKind kind = DiagnosticKind::undefined_name,
                  const std::string& note = {}) {
  Sources sources;
  sources.add("file.tmc", text);
  return format(Diagnostic{kind, span, "message", note, {}}, sources);
}

TEST(Format, ShowsPlaceMessageLineAndCaret) {
  EXPECT_EQ(shown("STOP\nMVP ABS, 0, Nowhere\nSTOP", {0, 17, 7}),
            "file.tmc:2:13: error: message\n"
            "MVP ABS, 0, Nowhere\n"
            "            ^~~~~~~\n");
}

TEST(Format, NamesTheWarning) {
  EXPECT_EQ(shown("MST 1", {0, 4, 1}, DiagnosticKind::no_such_motor),
            "file.tmc:1:5: warning: message [no-such-motor]\n"
            "MST 1\n"
            "    ^\n");
}

TEST(Format, KeepsTabsSoThatTheCaretAligns) {
  EXPECT_EQ(shown("\tGAP\t99, 0\r\n", {0, 5, 2}),
            "file.tmc:1:6: error: message\n"
            "\tGAP\t99, 0\n"
            "\t   \t^~\n");
}

TEST(Format, CountsCharactersNotBytes) {
  EXPECT_EQ(shown("\xC3\xA4\xC3\xB6 x", {0, 5, 1}), "file.tmc:1:4: error: message\n\xC3\xA4\xC3\xB6 x\n   ^\n");
  EXPECT_EQ(shown("\xE4\xF6 x", {0, 3, 1}), "file.tmc:1:4: error: message\n\xC3\xA4\xC3\xB6 x\n   ^\n");
}

TEST(Format, MarksAnEmptySpanBehindTheLine) {
  EXPECT_EQ(shown("GAP 1,\nSTOP", {0, 6, 0}), "file.tmc:1:7: error: message\nGAP 1,\n      ^\n");
}

TEST(Format, HidesControlCharacters) {
  EXPECT_EQ(shown(std::string("a\0\x1B[2Jb", 7), {0, 1, 1}), "file.tmc:1:2: error: message\na??[2Jb\n ^\n");
}

TEST(Format, ShowsALongLineInPart) {
  const std::string text = shown(std::string(100000, ' ') + "x" + std::string(100000, ' '), {0, 100000, 1});
  EXPECT_LT(text.size(), 1000U);
  EXPECT_NE(text.find("..."), std::string::npos);
}

TEST(Format, AddsTheNoteAndTheRelatedPlace) {
  Sources sources;
  sources.add("file.tmc", "A = 1\nA = 2");
  const Diagnostic duplicate{DiagnosticKind::duplicate_name, {0, 6, 1}, "again", "first defined here", Span{0, 0, 1}};
  EXPECT_EQ(format(duplicate, sources),
            "file.tmc:2:1: error: again\nA = 2\n^\nfile.tmc:1:1: note: first defined here\nA = 1\n^\n");
  EXPECT_EQ(shown("x", {0, 0, 1}, DiagnosticKind::undefined_name, "hint"),
            "file.tmc:1:1: error: message\nx\n^\nnote: hint\n");
}

TEST(Format, ColoursForATerminalWhatItSaysInPlainText) {
  Sources sources;
  sources.add("file.tmc", "MST 1");
  const Diagnostic warning{DiagnosticKind::no_such_motor, {0, 4, 1}, "message", "hint", {}};
  EXPECT_EQ(format(warning, sources, {true}),
            "\033[1mfile.tmc:1:5: \033[0m\033[1;35mwarning: \033[0m\033[1mmessage\033[0m [no-such-motor]\n"
            "MST 1\n"
            "    \033[1;32m^\033[0m\n"
            "\033[1;36mnote: \033[0mhint\n");
}

TEST(Format, ShowsWarningsThatAreErrors) {
  Sources sources;
  sources.add("file.tmc", "MST 1");
  Diagnostic warning{DiagnosticKind::no_such_motor, {0, 4, 1}, "message", {}, {}};
  warning.is_warning_as_error = true;
  EXPECT_EQ(format(warning, sources), "file.tmc:1:5: error: message [no-such-motor]\nMST 1\n    ^\n");
}

TEST(Summary, CountsErrorsAndWarnings) {
  EXPECT_EQ(summary({0, 0}), "");
  EXPECT_EQ(summary({1, 0}), "1 error");
  EXPECT_EQ(summary({0, 2}), "2 warnings");
  EXPECT_EQ(summary({2, 1}), "2 errors, 1 warning");
}

TEST(DiagnosticKinds, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const DiagnosticKindSpec& row : diagnostic_kinds) names.insert(row.name);
  EXPECT_EQ(names.size(), diagnostic_kind_count);
  EXPECT_EQ(names.count(std::string(all_warnings_name)), 0U);
}

TEST(DiagnosticKinds, AreFoundByNameIfTheyAreWarnings) {
  EXPECT_EQ(find_warning("unused-label"), DiagnosticKind::unused_label);
  EXPECT_EQ(find_warning("undefined-name"), std::nullopt);
  EXPECT_EQ(all_warnings().count(),
            static_cast<std::size_t>(std::count_if(std::begin(diagnostic_kinds), std::end(diagnostic_kinds),
                                                   [](const auto& row) { return row.severity == Severity::warning; })));
}

TEST(DiagnosticList, LeavesOutWhatIsSwitchedOff) {
  DiagnosticKinds off;
  off.set(index_of(DiagnosticKind::no_such_motor));
  DiagnosticList list(off);
  list.add(DiagnosticKind::no_such_motor, {}, "off");
  list.add(DiagnosticKind::unused_label, {}, "on");
  EXPECT_EQ(list.size(), 1U);
}

TEST(InQuotes, ShortensLongText) {
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(60, 'x') + "...'");
}

TEST(DiagnosticList, ForgetsWhatIsRewound) {
  DiagnosticList list;
  list.add(DiagnosticKind::no_such_motor, {}, "warning");
  const std::size_t size = list.size();
  list.add(DiagnosticKind::undefined_name, {}, "error");
  EXPECT_TRUE(list.has_errors());
  list.rewind(size);
  EXPECT_FALSE(list.has_errors());
  EXPECT_EQ(list.take_sorted().size(), 1U);
}

}  // namespace
}  // namespace opentmcl::lang
