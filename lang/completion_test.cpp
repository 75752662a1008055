#include "lang/completion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using Kind = CursorPlace::Kind;

/// The cursor is where the text has a '|'.
struct Typed {
  explicit Typed(const std::string& with_cursor) : offset(with_cursor.find('|')), text(with_cursor) {
    text.erase(offset, 1);
  }
  std::size_t offset;
  std::string text;
};

CursorPlace place_in(const std::string& with_cursor) {
  const Typed typed(with_cursor);
  return place_of_cursor(typed.text, typed.offset);
}

/// What is being written at the cursor.
std::string written_in(const std::string& with_cursor) {
  const Typed typed(with_cursor);
  const CursorPlace place = place_of_cursor(typed.text, typed.offset);
  return typed.text.substr(place.start, typed.offset - place.start);
}

std::vector<std::string> labels_in(const std::string& with_cursor, const ModuleDescription& module = pd1161) {
  const Typed typed(with_cursor);
  const AssemblyResult result = assemble_text(typed.text, module);
  std::vector<std::string> labels;
  const CursorPlace place = place_of_cursor(typed.text, typed.offset);
  const std::string_view written = std::string_view(typed.text).substr(place.start, typed.offset - place.start);
  for (const Completion& completion : completions(place, written, 0, typed.offset, result.symbols, module).items) {
    labels.push_back(completion.label);
  }
  return labels;
}

TEST(CursorPlace, IsAStatementWhereOneCanBegin) {
  for (const char* text : {"|", "  |", "M|", "A: |", "A: B:M|VP", "STOP\n|", "\r\n|\r\n", "\xEF\xBB\xBF|"}) {
    EXPECT_EQ(place_in(text).kind, Kind::statement) << text;
  }
  EXPECT_EQ(written_in("A: MV|P"), "MV");
}

TEST(CursorPlace, IsAnOperand) {
  const CursorPlace third = place_in("A: SAP 4, 0, 1|0, 0");
  EXPECT_EQ(third.kind, Kind::operand);
  EXPECT_EQ(third.spec()->kind, OperandKind::value);
  EXPECT_TRUE(third.is_alone);
  EXPECT_EQ(place_in("SAP |").spec()->kind, OperandKind::axis_parameter);
  EXPECT_EQ(place_in("SAP 4,|").spec()->kind, OperandKind::motor);
  EXPECT_FALSE(place_in("SAP 4, 0, (1 + Sp|").is_alone);
  EXPECT_EQ(written_in("SAP 4, 0, (1 + Sp|eed"), "Sp");
  EXPECT_EQ(place_in("SAP 4, 0, 1, |").spec(), nullptr);
  EXPECT_EQ(place_in("NOSUCH |").spec(), nullptr);
}

TEST(CursorPlace, IsAnExpressionInAConstant) {
  EXPECT_EQ(place_in("A = |").kind, Kind::expression);
  EXPECT_EQ(place_in("A = 2 * B|").kind, Kind::expression);
}

TEST(CursorPlace, IsNothingWhereASignHasToComeOrInAComment) {
  for (const char* text : {"SAP 4 |", "MVP ABS, 0, (1) |", "1|", "// MV|", "SAP 4, // 0|", "; |", "STOP // a, |"}) {
    EXPECT_EQ(place_in(text).kind, Kind::nothing) << text;
  }
}

TEST(CursorPlace, IsAFileName) {
  EXPECT_EQ(place_in("#inc|").kind, Kind::directive);
  EXPECT_EQ(place_in("#include|").kind, Kind::directive);
  EXPECT_EQ(place_in("#include |").kind, Kind::file_name);
  EXPECT_EQ(written_in("#include TMCL|"), "TMCL");
  EXPECT_EQ(written_in("#include \"a/b|"), "a/b");
  EXPECT_EQ(written_in("  #include \"|"), "");
}

TEST(Completion, OffersTheMnemonicsOfTheModule) {
  EXPECT_THAT(labels_in("|", pd1161), Contains("CALL"));
  EXPECT_THAT(labels_in("|", tmcm1110), Not(Contains("CALL")));
  EXPECT_THAT(labels_in("|"), Contains("#include"));
}

TEST(Completion, OffersTheWordsOfAnOperand) {
  EXPECT_THAT(labels_in("Speed = 1\nMVP |"), ElementsAre("ABS", "REL", "COORD")) << "and no constants";
  EXPECT_THAT(labels_in("CALCV |"), Not(Contains("SWAP")));
}

TEST(Completion, OffersParametersByNumberAndName) {
  EXPECT_THAT(labels_in("SAP |"), Contains("4 maximum positioning speed"));
  EXPECT_THAT(labels_in("GGP |", pd1161), Contains("67 ASCII mode"));
  EXPECT_THAT(labels_in("GGP |", tmcm1110), Not(Contains("67 ASCII mode")));
  EXPECT_THAT(labels_in("#include TMCLParam.tmc\nSAP |"), Contains("APMaxPositioningSpeed"));
  EXPECT_THAT(labels_in("EI |"), Contains("255 global interrupts"));
  EXPECT_THAT(labels_in("GIO |"), Contains("8 bank 1: supply voltage"));
}

TEST(Completion, OffersLabelsWhereAnAddressIsExpectedAndConstantsThatAreDefinedAbove) {
  const std::string source = "Start: STOP\nSpeed = 1\n";
  EXPECT_THAT(labels_in(source + "JA |\nLast = 1\nEnd: STOP"), ElementsAre("Start", "Speed", "End"));
  EXPECT_THAT(labels_in(source + "SAP 4, 0, |"), Contains("Speed"));
  EXPECT_THAT(labels_in(source + "SAP 4, 0, |"), Contains("SIN"));
  EXPECT_THAT(labels_in(source + "SAP 4, 0, |"), Not(Contains("Start")));
  EXPECT_THAT(labels_in("// |"), IsEmpty());
}

TEST(Completion, LeavesOutWhatHasOtherLetters) {
  EXPECT_THAT(labels_in("WAIT r|"), ElementsAre("REFSW", "RFS"));
  EXPECT_THAT(labels_in("SAP 17|"), Contains("174 stallGuard2 threshold"));
  EXPECT_THAT(labels_in("SAP speed|"), Contains("4 maximum positioning speed"));
  EXPECT_THAT(labels_in("SAP speed|"), Not(Contains("174 stallGuard2 threshold")));
}

TEST(Completion, OffersNoMoreThanHelps) {
  std::string source;
  for (int i = 0; i < 2000; ++i) source += "Name" + std::to_string(i) + " = 1\n";
  const AssemblyResult result = assemble_text(source + "ROR 0, ");
  const CursorPlace place = place_of_cursor(result.sources[0].text, result.sources[0].text.size());
  const auto offered = [&](std::string_view written) {
    return completions(place, written, 0, result.sources[0].text.size(), result.symbols, pd1161);
  };
  EXPECT_EQ(offered("").items.size(), most_completions);
  EXPECT_FALSE(offered("").is_complete);
  EXPECT_EQ(offered("name1999").items.size(), 1U);
  EXPECT_TRUE(offered("name1999").is_complete);
}

RC_GTEST_PROP(Completion, WorksAnywhereInAnyText, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::string>>(
      rc::gen::elementOf(std::vector<std::string>{"SAP", "MVP ", "ABS", ",", " ", ":", "=", "(", "#include ", "\"",
                                                  "//", "\n", "\r", "Loop", "1", "$", "!", "\xC3"}));
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  const auto offset = *rc::gen::inRange<std::size_t>(0, text.size() + 1);
  const CursorPlace place = place_of_cursor(text, offset);
  RC_ASSERT(place.start <= offset);
  RC_ASSERT(text.substr(place.start, offset - place.start).find('\n') == std::string::npos);
}

}  // namespace
}  // namespace opentmcl::lang
