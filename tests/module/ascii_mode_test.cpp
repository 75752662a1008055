// The ASCII mode of the PD-1161 as a terminal sees it. Source: PD-1161 manual 3.4,
// docs/decisions/0017-ascii-mode.md.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr std::int32_t echo_characters = 0;

/// A module and somebody who types at its port.
struct Terminal : Bench {
  explicit Terminal(hal::PortKind kind = hal::PortKind::usb, const ModuleDescription& description = pd1161)
      : Bench(description, kind) {}

  /// Command 139, without echo unless told otherwise.
  void enter_ascii_mode(std::int32_t echo = no_echo) {
    set(GlobalParameter::ascii_mode, echo);
    EXPECT_EQ(command(Opcode::enter_ascii_mode).status, Status::ok);
  }

  /// @return everything that comes back
  std::string type(const std::string& text) {
    const std::vector<std::uint8_t> bytes = send({text.begin(), text.end()});
    return {bytes.begin(), bytes.end()};
  }
};

TEST(AsciiMode, IsEnteredBy139AndLeftByBin) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("AGAP 140, 0\r"), "BA 100 8\r");
  EXPECT_EQ(terminal.type("ABIN\r"), "BA 100 0\r");
  EXPECT_EQ(terminal.get(AxisParameter::microstep_resolution), 8);
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("ABIN\r"), "BA 100 0\r");
}

TEST(AsciiMode, IsEnteredOverRs232Too) {
  Terminal terminal(hal::PortKind::rs232);
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("A GAP 140, 0\r"), "BA 100 8\r");
}

TEST(AsciiMode, IsNotAvailableOverRs485) {
  Terminal bus(hal::PortKind::rs485);
  EXPECT_EQ(bus.command(Opcode::enter_ascii_mode).status, Status::command_not_available);
  EXPECT_EQ(bus.get(AxisParameter::microstep_resolution), 8) << "still binary";
}

TEST(AsciiMode, IsUnknownToTheTmcm1110) {
  Terminal terminal(hal::PortKind::usb, tmcm1110);
  EXPECT_EQ(terminal.command(Opcode::enter_ascii_mode).status, Status::invalid_command);
  EXPECT_EQ(terminal.get(AxisParameter::microstep_resolution), 8) << "still binary";
}

TEST(AsciiMode, TakesLinesThatComeWith139InOneGo) {
  Terminal terminal;
  terminal.set(GlobalParameter::ascii_mode, no_echo);
  const Datagram enter = encode(Request{1, {static_cast<std::uint8_t>(Opcode::enter_ascii_mode), 0, 0, 0}});
  const Datagram get = encode(Request{1, {static_cast<std::uint8_t>(Opcode::gap), 140, 0, 0}});
  const std::string all = std::string(enter.bytes, enter.bytes + datagram_size) + "AGAP 140, 0\rABIN\r" +
                          std::string(get.bytes, get.bytes + datagram_size);
  const std::string replies = terminal.type(all);
  ASSERT_EQ(replies.size(), datagram_size + 9 + 9 + datagram_size);
  EXPECT_EQ(replies.substr(datagram_size, 18), "BA 100 8\rBA 100 0\r");
  EXPECT_EQ(replies[replies.size() - 2], 8) << "the value of the last, binary reply";
}

TEST(AsciiMode, MovesTheMotor) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("AMVP ABS, 0, 1000\r"), "BA 100 1000\r");
  terminal.wait(1000 * one_millisecond);
  EXPECT_EQ(terminal.type("AGAP 1, 0\r"), "BA 100 1000\r");
  EXPECT_EQ(terminal.type("AROL 0, 500\r"), "BA 100 500\r");
  EXPECT_EQ(terminal.type("AGAP 2, 0\r"), "BA 100 -500\r");
  EXPECT_EQ(terminal.type("AMST 0\r"), "BA 100 0\r");
  EXPECT_EQ(terminal.type("AGAP 2, 0\r"), "BA 100 0\r");
}

TEST(AsciiMode, AnswersWithTheStatusOfTheModule) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("AMVP ABS, 1, 50000\r"), "BA 4 50000\r") << "motor 1 (E-58)";
  EXPECT_EQ(terminal.type("AGAP 99, 0\r"), "BA 3 0\r");
  EXPECT_EQ(terminal.type("AROR 0, 51200\r"), "BA 4 51200\r");
  EXPECT_EQ(terminal.type("AUF0 0, 0, 0\r"), "BA 2 0\r");
}

TEST(AsciiMode, AnswersWhatIsNoCommandAndGoesOn) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  for (const char* line : {"A\r", "AX\r", "ACALC ADD, 1\r", "AGAP 1\r", "AGAP 1, 0, 0, 0\r", "Hello?\r"}) {
    EXPECT_EQ(terminal.type(line), "BA 2 0\r") << line;
    EXPECT_EQ(terminal.type("AGAP 140, 0\r"), "BA 100 8\r");
  }
  EXPECT_EQ(terminal.type("AGAP x, 0\r"), "BA 3 0\r");
  EXPECT_EQ(terminal.type("AROR 0, fast\r"), "BA 4 0\r");
}

TEST(AsciiMode, KeepsLinesThatComeTogether) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("ASGP 1, 2, 11\rnonsense\rAGGP 1, 2\r\r\nAGGP 1, 2\r\n"),
            "BA 100 11\rBA 2 0\rBA 100 11\rBA 100 11\r");
}

TEST(AsciiMode, WaitsForTheEndOfALineHoweverLongItTakes) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  std::string received;
  for (const char character : std::string("AGAP 140, 0\r")) {
    EXPECT_EQ(received, "");
    terminal.wait(1000 * one_millisecond);
    received = terminal.type(std::string(1, character));
  }
  EXPECT_EQ(received, "BA 100 8\r");
}

TEST(AsciiMode, RefusesALineThatIsTooLongAndLosesNothingBehindIt) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  const std::string line = "AGAP 140, 0";
  EXPECT_EQ(terminal.type(line + std::string(64 - line.size(), ' ') + "\r"), "BA 100 8\r");
  EXPECT_EQ(terminal.type(line + std::string(65 - line.size(), ' ') + "\r"), "BA 2 0\r");
  EXPECT_EQ(terminal.type(line + std::string(100'000, ' ') + "\r" + line + "\r"), "BA 2 0\rBA 100 8\r");
}

TEST(AsciiMode, ErasesWithBackspace) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("ASAP\b\b\bGAP 41\b\x7F"
                          "140, 0\r"),
            "BA 100 8\r");
  EXPECT_EQ(terminal.type("X\b\b\bAGAP 140, 0\r"), "BA 100 8\r") << "more than there is";
  const std::string line = "AGAP 140, 0";
  EXPECT_EQ(terminal.type(line + std::string(300, 'x') + std::string(300, '\b') + "\r"), "BA 100 8\r") << "a long line";
}

TEST(AsciiEcho, RepeatsEachCharacterAtOnce) {
  Terminal terminal;
  terminal.enter_ascii_mode(echo_characters);
  for (const char character : std::string("AGAP 140, 0")) {
    EXPECT_EQ(terminal.type(std::string(1, character)), std::string(1, character));
  }
  EXPECT_EQ(terminal.type("\b"), "\b \b");
  EXPECT_EQ(terminal.type("0"), "0");
  EXPECT_EQ(terminal.type("\r"), "\rBA 100 8\r");
}

TEST(AsciiEcho, RepeatsTheLineWhenItEnds) {
  Terminal terminal;
  terminal.enter_ascii_mode(echo_lines);
  EXPECT_EQ(terminal.type("AGAP 141\b0, 0"), "");
  EXPECT_EQ(terminal.type("\r"), "AGAP 140, 0\rBA 100 8\r");
  EXPECT_EQ(terminal.type("A?\r"), "A?\rBA 2 0\r");
}

TEST(AsciiEcho, CanBeTurnedOff) {
  for (const std::int32_t setting : {no_echo, no_echo | echo_lines}) {
    Terminal terminal;
    terminal.enter_ascii_mode(setting);
    EXPECT_EQ(terminal.type("AGAP 140, 0\r"), "BA 100 8\r");
  }
}

TEST(AsciiEcho, IsInForceAsSoonAsItIsSet) {
  Terminal terminal;
  terminal.enter_ascii_mode(echo_characters);
  EXPECT_EQ(terminal.type("ASGP 67, 0, 32\r"), "ASGP 67, 0, 32\rBA 100 32\r");
  EXPECT_EQ(terminal.type("AGGP 67, 0\r"), "BA 100 32\r");
}

TEST(AsciiAddress, OfAnotherModuleGetsNeitherEchoNorReply) {
  Terminal terminal(hal::PortKind::rs232);
  terminal.enter_ascii_mode(echo_characters);
  EXPECT_EQ(terminal.type("BGAP 140, 0\r"), "");
  EXPECT_EQ(terminal.type("Bnonsense\r"), "");
  EXPECT_EQ(terminal.type("AGAP 140, 0\r"), "AGAP 140, 0\rBA 100 8\r");
}

TEST(AsciiAddress, MayBeTypedSmallAndFollowsTheSetting) {
  Terminal terminal(hal::PortKind::rs232);
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("agap 140, 0\r"), "BA 100 8\r");
  EXPECT_EQ(terminal.type("ASGP 66, 0, 3\r"), "BC 100 3\r");
  EXPECT_EQ(terminal.type("AGAP 140, 0\r"), "");
  EXPECT_EQ(terminal.type("CGAP 140, 0\r"), "BC 100 8\r");
  EXPECT_EQ(terminal.type("CSGP 76, 0, 26\r"), "ZC 100 26\r");
  EXPECT_EQ(terminal.type("CSGP 66, 0, 200\r"), "Z? 100 200\r");
  EXPECT_EQ(terminal.type("?GAP 140, 0\r"), "Z? 100 8\r");
}

TEST(AsciiAddress, IsNotLookedAtOverUsb) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  for (const char* line : {"AGAP 140, 0\r", "BGAP 140, 0\r", "?GAP 140, 0\r"}) {
    EXPECT_EQ(terminal.type(line), "BA 100 8\r") << line;
  }
}

TEST(AsciiAddress, TheSecondaryOneIsObeyedInSilence) {
  Terminal terminal(hal::PortKind::rs232);
  terminal.set(GlobalParameter::serial_secondary_address, 7);
  terminal.enter_ascii_mode(echo_characters);
  EXPECT_EQ(terminal.type("GSGP 1, 2, 5\r"), "");
  EXPECT_EQ(terminal.type("Gnonsense\r"), "");
  EXPECT_EQ(terminal.type("AGGP 1, 2\r"), "AGGP 1, 2\rBA 100 5\r");
}

TEST(AsciiMode, SuppressesRepliesAsInBinaryMode) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  terminal.type("ASGP 255, 0, 1\r");
  EXPECT_EQ(terminal.type("ASGP 1, 2, 5\r"), "");
  EXPECT_EQ(terminal.type("Anonsense\r"), "");
  EXPECT_EQ(terminal.type("AGGP 1, 2\r"), "BA 100 5\r");
}

TEST(AsciiMode, StartsAndStopsAProgram) {
  Terminal terminal;
  terminal.download("SGP 0, 2, 5\nLoop: CALC ADD, 1\nAGP 1, 2\nWAIT TICKS, 0, 1\nJA Loop\n");
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("ARUN\r").substr(0, 6), "BA 100");
  terminal.wait(100 * one_millisecond);
  EXPECT_EQ(terminal.type("AGGP 128, 0\r"), "BA 100 1\r");
  EXPECT_EQ(terminal.type("AGGP 0, 2\r"), "BA 100 5\r");
  EXPECT_EQ(terminal.type("ASTOP\r"), "BA 100 0\r");
  EXPECT_EQ(terminal.type("AGGP 128, 0\r"), "BA 100 0\r");
  terminal.type("ASGP 0, 2, 0\r");
  terminal.type("ARUN\r");
  terminal.wait(100 * one_millisecond);
  EXPECT_EQ(terminal.type("AGGP 0, 2\r"), "BA 100 5\r") << "from its begin again";
}

TEST(AsciiMode, ReportsTheEndOfAMoveThatWasAskedForInBinaryMode) {
  Terminal terminal;
  ASSERT_EQ(terminal.command(Opcode::request_position_reached, 0, 0, 1).status, Status::ok);
  terminal.enter_ascii_mode();
  EXPECT_EQ(terminal.type("AMVP ABS, 0, 1000\r"), "BA 100 1000\r");
  terminal.port.received.clear();
  terminal.wait(1000 * one_millisecond);
  EXPECT_EQ(std::string(terminal.port.received.begin(), terminal.port.received.end()), "BA 128 1\r");
}

TEST(AsciiMode, IsThereFromTheStartWhenTheSettingSaysSo) {
  Terminal terminal;
  terminal.set(GlobalParameter::ascii_mode, start_in_ascii_mode | no_echo);
  EXPECT_EQ(terminal.get(AxisParameter::microstep_resolution), 8) << "not before a restart";
  terminal.wait(100 * one_millisecond);
  terminal.module.power_cycle();
  terminal.wait(100 * one_millisecond);
  EXPECT_EQ(terminal.type("AGAP 140, 0\r"), "BA 100 8\r");
  terminal.type("ABIN\r");
  EXPECT_EQ(terminal.get(AxisParameter::microstep_resolution), 8);
}

TEST(AsciiMode, ThatStartsWithTheModuleLeavesRs485Alone) {
  Terminal bus(hal::PortKind::rs485);
  bus.set(GlobalParameter::ascii_mode, start_in_ascii_mode);
  bus.wait(100 * one_millisecond);
  bus.module.power_cycle();
  bus.wait(100 * one_millisecond);
  EXPECT_EQ(bus.get(AxisParameter::microstep_resolution), 8);
}

TEST(AsciiMode, EndsWithARestart) {
  Terminal terminal;
  terminal.enter_ascii_mode();
  terminal.module.power_cycle();
  terminal.wait(100 * one_millisecond);
  EXPECT_EQ(terminal.get(AxisParameter::microstep_resolution), 8);
}

TEST(AsciiMode, IsTheModeOfOneLineOnly) {
  TestPort usb;
  TestPort rs232;
  VirtualModule module(pd1161, {{&usb, hal::PortKind::usb}, {&rs232, hal::PortKind::rs232}});
  const auto say = [&module](TestPort& port, const std::string& text) {
    port.received.clear();
    port.to_module.insert(port.to_module.end(), text.begin(), text.end());
    module.wake();
    module.advance_to(module.now() + 3 * one_millisecond);
    return std::string(port.received.begin(), port.received.end());
  };
  const auto binary = [&say](TestPort& port, Opcode opcode) {
    const Datagram request = encode(Request{1, {static_cast<std::uint8_t>(opcode), 1, 0, 0}});
    return say(port, {request.bytes, request.bytes + datagram_size});
  };
  module.advance_to(one_millisecond);
  ASSERT_EQ(binary(rs232, Opcode::enter_ascii_mode).size(), datagram_size);
  EXPECT_EQ(say(rs232, "AGAP"), "AGAP");
  EXPECT_EQ(binary(usb, Opcode::gap).size(), datagram_size) << "half a line at the other port does not matter";
  EXPECT_EQ(say(rs232, " 140, 0\r"), " 140, 0\rBA 100 8\r");
  ASSERT_EQ(binary(usb, Opcode::enter_ascii_mode).size(), datagram_size);
  EXPECT_EQ(say(usb, "AGAP 140, "), "AGAP 140, ");
  EXPECT_EQ(say(rs232, "ABIN\r"), "ABIN\rBA 100 0\r");
  EXPECT_EQ(say(usb, "0\r"), "0\rBA 100 8\r");
}

TEST(AsciiMode, AnswersWhatWaitsForTheEepromBeforeTheNextLine) {
  Terminal terminal;
  terminal.set(AxisParameter::maximum_current, 100);
  terminal.enter_ascii_mode();
  std::string lines;
  std::string replies;
  for (int i = 0; i < 20; ++i) {
    lines += "ASGP " + std::to_string(i) + ", 2, 5\rASTGP " + std::to_string(i) + ", 2\r";
    replies += "BA 100 5\rBA 100 0\r";
  }
  terminal.type(lines);
  terminal.wait(2000 * one_millisecond);
  EXPECT_EQ(std::string(terminal.port.received.begin(), terminal.port.received.end()), replies);
}

TEST(AsciiMode, SurvivesAnyBytesAndStillLeaves) {
  EXPECT_TRUE(rc::check("any bytes", [](const std::vector<std::string>& pieces) {
    Terminal terminal;
    terminal.enter_ascii_mode();
    for (const std::string& piece : pieces) terminal.type(piece);
    terminal.type("\r");
    terminal.type("ASGP 67, 0, 32\r");
    const std::string reply = terminal.type("AGGP 67, 0\r");
    RC_ASSERT(reply == "BA 100 32\r");
  }));
}

}  // namespace
}  // namespace opentmcl::tests
