#include "tests/conformance/step.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace opentmcl::conformance {
namespace {

template <class Kind>
Kind parse(std::string_view line, const ModuleDescription& module = pd1161) {
  const std::vector<Step> steps = parse_steps(line, module);
  EXPECT_EQ(steps.size(), 1U);
  return std::get<Kind>(steps.at(0).action);
}

std::string error_of(std::string_view line, const ModuleDescription& module = pd1161) {
  try {
    parse_steps(line, module);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Steps, AreCommandsInMnemonicFormWithTheirReply) {
  const auto step = parse<SendCommand>("MVP ABS, 0, -5 -> 100");
  EXPECT_EQ(step.command, (Command{4, 0, 0, -5}));
  ASSERT_TRUE(step.reply.has_value());
  EXPECT_EQ(step.reply->status, 100);
  EXPECT_FALSE(step.reply->value.has_value());
}

TEST(Steps, AreCommandsAsFourNumbers) {
  EXPECT_EQ(parse<SendCommand>("135 2 0 -7 -> 100").command, (Command{135, 2, 0, -7}));
}

TEST(Steps, ExpectAValueOrARange) {
  const auto value_of = [](std::string_view line) { return *parse<SendCommand>(line).reply->value; };
  EXPECT_EQ(value_of("GAP 1, 0 -> 100, -5").minimum, -5);
  EXPECT_EQ(value_of("GAP 1, 0 -> 100, -5").maximum, -5);
  EXPECT_EQ(value_of("GAP 1, 0 -> 100, -5..7").maximum, 7);
  EXPECT_EQ(value_of("136 1 0 0 -> 100, $0489012F").minimum, 0x0489012F);
}

TEST(Steps, ExpectSilence) {
  EXPECT_FALSE(parse<SendCommand>("137 0 0 1234 -> nothing").reply.has_value());
  EXPECT_TRUE(parse<SendBytes>("bytes 01 02 -> nothing").reply.empty());
}

TEST(Steps, AreBytesOrTexts) {
  EXPECT_EQ(parse<SendBytes>("bytes 01 FF -> 02").bytes, (Bytes{1, 255}));
  EXPECT_EQ(parse<SendBytes>("bytes \"AB\\r\" -> \"C\\b\"").bytes, (Bytes{'A', 'B', '\r'}));
  EXPECT_EQ(parse<SendBytes>("bytes \"AB\\r\" -> \"C\\b\"").reply, (Bytes{'C', '\b'}));
}

TEST(Steps, AreFramesOfBothKinds) {
  const auto standard = parse<SendFrame>("frame 001 05 04 -> 7FF AA");
  EXPECT_EQ(standard.frame.id, 1U);
  EXPECT_FALSE(standard.frame.is_extended);
  EXPECT_EQ(standard.frame.length, 2);
  EXPECT_EQ(standard.frame.data[1], 4);
  ASSERT_TRUE(standard.reply.has_value());
  EXPECT_EQ(standard.reply->id, 0x7FFU);
  const auto extended = parse<SendFrame>("frame 00000001 05 -> nothing");
  EXPECT_TRUE(extended.frame.is_extended);
  EXPECT_FALSE(extended.reply.has_value());
  EXPECT_THAT(error_of("frame 1 05 -> nothing"), testing::HasSubstr("3 or 8 hexadecimal digits"));
  EXPECT_THAT(error_of("frame 001 01 02 03 04 05 06 07 08 09 -> nothing"), testing::HasSubstr("at most 8 bytes"));
}

TEST(Steps, KnowTimes) {
  EXPECT_EQ(parse<Wait>("wait 250 us").duration, 250U);
  EXPECT_EQ(parse<Wait>("wait 3 ms").duration, 3'000U);
  EXPECT_EQ(parse<Wait>("wait 2 s").duration, 2'000'000U);
}

TEST(Steps, WaitForAValue) {
  const auto step = parse<WaitUntil>("until GAP 8, 0 = 1 within 5 s");
  EXPECT_EQ(step.command.type, 8);
  EXPECT_EQ(step.value.minimum, 1);
  EXPECT_EQ(step.limit, 5'000'000U);
}

TEST(Steps, ChangeAndLookAtTheBench) {
  EXPECT_EQ(parse<SetWorld>("set left switch = 1").name, "left switch");
  EXPECT_EQ(parse<SetWorld>("set supply = 8400").value, 8400);
  EXPECT_EQ(parse<CheckWorld>("check rotor = -10..10").value.minimum, -10);
}

TEST(Steps, IgnoreCommentsAndEmptyLines) {
  EXPECT_EQ(parse_steps("\n// nothing\npower cycle // off and on\n\nrun 5\n", pd1161).size(), 2U);
  EXPECT_EQ(parse<RunProgram>("run 5").address, 5);
  EXPECT_EQ(parse<RunProgram>("run").address, 0);
}

TEST(Steps, NameTheLineThatIsWrong) {
  EXPECT_THAT(error_of("MST 0"), testing::HasSubstr("expected -> and what must come back"));
  EXPECT_THAT(error_of("MST 0 -> ok"), testing::HasSubstr("expected a number, found \"ok\""));
  EXPECT_THAT(error_of("135 2 0 -> 100"), testing::HasSubstr("expected opcode, type, motor or bank, and value"));
  EXPECT_THAT(error_of("wait 5"), testing::HasSubstr("expected a time in us, ms or s"));
  EXPECT_THAT(error_of("bytes 123 -> nothing"), testing::HasSubstr("two hexadecimal digits"));
  EXPECT_THAT(error_of("MVQ 0 -> 100"), testing::HasSubstr("step \"MVQ 0 -> 100\""));
  EXPECT_THAT(error_of("DJNZ 1, 2 -> 6", tmcm1110), testing::HasSubstr("TMCM-1110"));
}

}  // namespace
}  // namespace opentmcl::conformance
