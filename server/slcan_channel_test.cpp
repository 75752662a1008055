#include "server/slcan_channel.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

namespace opentmcl::server {
namespace {

struct Adapter {
  Adapter() { bus.join(1'000'000); }

  /// @return what the host gets for it
  std::string type(std::string_view text) {
    heard.clear();
    channel.take({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return heard;
  }
  /// What the module sends to the one who spoke last.
  std::string module_sends(const hal::CanFrame& frame) {
    heard.clear();
    bus.write(frame);
    return heard;
  }
  hal::CanFrame read() {
    hal::CanFrame frame;
    EXPECT_TRUE(bus.read(frame));
    return frame;
  }

  SharedCanPort bus;
  std::string heard;
  WallTime now{};
  SlcanChannel channel{bus, [this](std::string_view text) { heard += text; }, [this] { return now; }};
};

TEST(Slcan, OpensAsPythonCanOpensIt) {
  Adapter adapter;
  EXPECT_EQ(adapter.type("C\r"), "\a") << "was not open";
  EXPECT_EQ(adapter.type("S8\r"), "\r");
  EXPECT_EQ(adapter.type("O\r"), "\r");
  EXPECT_EQ(adapter.type("O\r"), "\a") << "is open already";
  EXPECT_EQ(adapter.type("t001706010000000000\r"), "z\r");
  EXPECT_EQ(adapter.read().data[0], 6);
}

TEST(Slcan, PutsFramesOfBothKindsOnTheBus) {
  Adapter adapter;
  adapter.type("S8\rO\r");
  EXPECT_EQ(adapter.type("t7FF3a1B2c3\r"), "z\r");
  EXPECT_EQ(adapter.type("T1FFFFFFF10f\r"), "Z\r");
  const hal::CanFrame standard = adapter.read();
  EXPECT_EQ(standard.id, 0x7FFU);
  EXPECT_FALSE(standard.is_extended);
  ASSERT_EQ(standard.length, 3);
  EXPECT_EQ(standard.data[0], 0xA1);
  EXPECT_EQ(standard.data[1], 0xB2);
  EXPECT_EQ(standard.data[2], 0xC3);
  const hal::CanFrame extended = adapter.read();
  EXPECT_EQ(extended.id, 0x1FFF'FFFFU);
  EXPECT_TRUE(extended.is_extended);
  ASSERT_EQ(extended.length, 1);
  EXPECT_EQ(extended.data[0], 0x0F);
  EXPECT_EQ(adapter.bus.size(), 0U);
}

TEST(Slcan, GivesTheHostWhatTheModuleSends) {
  Adapter adapter;
  adapter.type("S8\rO\rt0010\r");
  adapter.read();
  EXPECT_EQ(adapter.module_sends({2, false, 7, {1, 100, 6, 0, 0, 0, 8}}), "t002701640600000008\r");
  EXPECT_EQ(adapter.module_sends({2, true, 1, {0xAB}}), "T000000021AB\r");
}

TEST(Slcan, AcceptsRemoteFramesThatNobodyAnswers) {
  Adapter adapter;
  adapter.type("S8\rO\r");
  EXPECT_EQ(adapter.type("r0017\r"), "z\r");
  EXPECT_EQ(adapter.type("R000000010\r"), "Z\r");
  EXPECT_EQ(adapter.bus.size(), 0U);
}

TEST(Slcan, RingsTheBellForWhatItDoesNotUnderstand) {
  Adapter adapter;
  adapter.type("S8\rO\r");
  for (const char* line :
       {"t",        "t00",    "t001",       "t0019",  "t0011",     "t00111",
        "t0011123", "t8000",  "T200000000", "t0x10",  "t-110",     "t001/",
        "r",        "r00111", "X1",         "?",      "OO",        "Cx",
        "Vx",       "Nx",     "F0",         "t001 0", "T00000001", "tttttttttttttttttttttttttttttttttttt"}) {
    EXPECT_EQ(adapter.type(std::string(line) + "\r"), "\a") << line;
  }
  EXPECT_EQ(adapter.bus.size(), 0U);
}

TEST(Slcan, TakesFramesOnlyWhileItIsOpen) {
  Adapter adapter;
  EXPECT_EQ(adapter.type("t0010\r"), "\a");
  adapter.type("O\r");
  EXPECT_EQ(adapter.type("t0010\r"), "z\r");
  adapter.read();
  EXPECT_EQ(adapter.type("C\r"), "\r");
  EXPECT_EQ(adapter.type("t0010\r"), "\a");
  EXPECT_EQ(adapter.module_sends({2, false, 0, {}}), "");
}

TEST(Slcan, OnlyListensWhenTold) {
  Adapter adapter;
  EXPECT_EQ(adapter.type("L\r"), "\r");
  EXPECT_EQ(adapter.type("t0010\r"), "\a");
  EXPECT_EQ(adapter.bus.size(), 0U);
}

TEST(Slcan, IsConfiguredOnlyWhileItIsClosed) {
  Adapter adapter;
  adapter.type("O\r");
  for (const char* line : {"S6\r", "s0014\r", "Z1\r"}) EXPECT_EQ(adapter.type(line), "\a") << line;
  adapter.type("C\r");
  for (const char* line : {"S6\r", "s0014\r", "Z1\r"}) EXPECT_EQ(adapter.type(line), "\r") << line;
  for (const char* line : {"S\r", "SA\r", "S10\r", "s001\r", "s00zz\r", "Z\r", "Z2\r"}) {
    EXPECT_EQ(adapter.type(line), "\a") << line;
  }
}

TEST(Slcan, HearsTheModuleOnlyAtItsBitRate) {
  for (int digit = 0; digit <= 9; ++digit) {
    Adapter adapter;
    adapter.type("S" + std::to_string(digit) + "\rO\r");
    EXPECT_EQ(adapter.type("t0010\r"), "z\r") << "the adapter takes it all the same";
    EXPECT_EQ(adapter.bus.size(), digit == 8 ? 1U : 0U) << digit;
    EXPECT_EQ(adapter.type("F\r"), digit == 8 ? "F00\r" : "FA4\r") << "nobody acknowledged it";
    EXPECT_EQ(adapter.type("F\r"), "F00\r") << "reading clears the flags";
  }
}

TEST(Slcan, FollowsTheModuleToAnotherBitRateOnlyWhenTold) {
  Adapter adapter;
  adapter.type("S8\rO\r");
  adapter.bus.join(250'000);
  adapter.type("t0010\r");
  EXPECT_EQ(adapter.bus.size(), 0U);
  adapter.type("C\rS5\rO\rt0010\r");
  EXPECT_EQ(adapter.bus.size(), 1U);
}

TEST(Slcan, TakesTheModulesBitRateWhenToldNone) {
  Adapter adapter;
  adapter.bus.join(20'000);
  adapter.type("O\rt0010\r");
  EXPECT_EQ(adapter.bus.size(), 1U);
}

TEST(Slcan, ReadsBitTimingRegisters) {
  // Register values as the adapter's manual prints them for its standard rates.
  for (const auto& [registers, rate] : {std::pair("s0014", 1'000'000U), std::pair("s001C", 500'000U),
                                        std::pair("s011C", 250'000U), std::pair("s031C", 125'000U)}) {
    Adapter adapter;
    adapter.bus.join(rate);
    adapter.type(std::string(registers) + "\rO\rt0010\r");
    EXPECT_EQ(adapter.bus.size(), 1U) << registers;
  }
}

TEST(Slcan, StampsFramesWithMillisecondsOfAMinute) {
  Adapter adapter;
  adapter.type("Z1\rO\rt0010\r");
  adapter.read();
  adapter.now += std::chrono::milliseconds(59'999);
  EXPECT_EQ(adapter.module_sends({2, false, 1, {7}}), "t002107EA5F\r");
  adapter.now += std::chrono::milliseconds(1);
  EXPECT_EQ(adapter.module_sends({2, false, 1, {7}}), "t0021070000\r");
}

TEST(Slcan, SaysWhatItIs) {
  Adapter adapter;
  EXPECT_EQ(adapter.type("V\r"), "V1010\r");
  EXPECT_EQ(adapter.type("N\r"), "NTMCL\r");
  EXPECT_EQ(adapter.type("F\r"), "\a") << "closed";
}

TEST(Slcan, UnderstandsLinesThatComeInPieces) {
  const std::string session = "\r\r\rC\rS8\rO\rt00123456\rT0000000280102030405060708\rV\r";
  Adapter whole;
  const std::string expected = whole.type(session);
  EXPECT_TRUE(rc::check("any division into pieces", [&] {
    Adapter adapter;
    std::string heard;
    for (std::size_t begin = 0; begin < session.size();) {
      const auto length = *rc::gen::inRange<std::size_t>(1, 9);
      heard += adapter.type(session.substr(begin, length));
      begin += length;
    }
    RC_ASSERT(heard == expected);
    RC_ASSERT(adapter.bus.size() == whole.bus.size());
  }));
}

TEST(Slcan, AnswersEveryLineOnce) {
  EXPECT_TRUE(rc::check("any bytes", [] {
    Adapter adapter;
    adapter.type("S8\rO\r");
    const auto text = *rc::gen::container<std::string>(
        rc::gen::weightedOneOf<char>({{3, rc::gen::elementOf(std::string("tTrRSOCLFVNZ0123456789abcdef"))},
                                      {1, rc::gen::just('\r')},
                                      {1, rc::gen::arbitrary<char>()}}));
    const std::string heard = adapter.type(text);
    const auto ends = std::count(text.begin(), text.end(), '\r');
    RC_ASSERT(std::count(heard.begin(), heard.end(), '\r') + std::count(heard.begin(), heard.end(), '\a') == ends);
  }));
}

}  // namespace
}  // namespace opentmcl::server
