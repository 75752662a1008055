#include "server/session_event.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace opentmcl::server {
namespace {

hal::CanFrame frame_of(std::uint32_t id, bool is_extended, std::initializer_list<std::uint8_t> bytes) {
  hal::CanFrame frame;
  frame.id = id;
  frame.is_extended = is_extended;
  for (const std::uint8_t byte : bytes) frame.data[frame.length++] = byte;
  return frame;
}

const SessionEvent events[] = {
    {0, ExtraTurn{}},
    {1'000'000, BytesRead{2, {0x01, 0xAB, 0x00}}},
    {7, FrameRead{frame_of(0x7FF, false, {})}},
    {7, FrameRead{frame_of(0x12345, true, {1, 2, 3, 4, 5, 6, 7, 0xFF})}},
    {8, QuantitiesSet{{{"supply_voltage", 23.5}, {"left_switch.held_open", 1}}}},
    {8, ScenarioBegun{}},
    {8, ScenarioBegun{3'000'000}},
    {9, PowerCycled{}},
    {10, Check{0, 0xFFFFFFFFFFFFFFFF}},
    {18'446'744'073'709'551'614U, SessionEnd{{0x1234, 0xABCD}}},
};

TEST(SessionEvent, IsALineOfText) {
  const char* const lines[] = {
      "0 turn",
      "1000000 read 2 01AB00",
      "7 can_read 7ff",
      "7 can_read x12345 01020304050607FF",
      "8 set supply_voltage=23.5 left_switch.held_open=1",
      "8 begin 0",
      "8 begin 3000000",
      "9 power_cycle",
      "10 check 0 ffffffffffffffff",
      "18446744073709551614 end 1234 abcd",
  };
  for (std::size_t i = 0; i < std::size(events); ++i) {
    EXPECT_EQ(lines[i], text_of(events[i]));
    EXPECT_EQ(events[i], session_event_from(lines[i])) << lines[i];
  }
}

TEST(SessionEvent, IsNothingElse) {
  for (const char* line : {"",
                           "turn",
                           "5",
                           "5 ",
                           "x turn",
                           "-1 turn",
                           "5 turn 1",
                           "5 turns",
                           "5 begin",
                           "5 begin -1",
                           "5 begin 1 2",
                           "5 read",
                           "5 read 0",
                           "5 read 0 ",
                           "5 read 0 1",
                           "5 read 0 0G",
                           "5 read x 00",
                           "5 can_read",
                           "5 can_read x",
                           "5 can_read 1 010203040506070809",
                           "5 set",
                           "5 set a",
                           "5 set a=",
                           "5 set a=1 b",
                           "5 set a=nan",
                           "5 set a=inf",
                           "5 set a=1x",
                           "5 power_cycle 1",
                           "5 check",
                           "5 check 1",
                           "5 check 1 2 3",
                           "5 end",
                           "99999999999999999999 turn"}) {
    EXPECT_EQ(std::nullopt, session_event_from(line)) << line;
  }
}

RC_GTEST_PROP(SessionEvent, ReadsBackWhatItWrites, (Microseconds time, unsigned port)) {
  const auto bytes = *rc::gen::nonEmpty<std::vector<std::uint8_t>>();
  const SessionEvent read{time, BytesRead{port, bytes}};
  RC_ASSERT(session_event_from(text_of(read)) == read);
  const auto value = *rc::gen::suchThat<double>([](double number) { return std::isfinite(number); });
  const SessionEvent set{time, QuantitiesSet{{{"a.b", value}}}};
  RC_ASSERT(session_event_from(text_of(set)) == set);
}

RC_GTEST_PROP(SessionEvent, TakesAnyTextWithoutHarm, (const std::string& text)) {
  const std::string line = "5 " + *rc::gen::element<std::string>("read 0 ", "can_read ", "set ", "check ") + text;
  if (const auto event = session_event_from(line)) {
    RC_ASSERT(session_event_from(text_of(*event)) == event);
  }
}

}  // namespace
}  // namespace opentmcl::server
