#include "firmware/wire/ascii_command.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "firmware/spec/instructions.hpp"

namespace opentmcl {

// gtest prints failures with these, and gave them their name.
// NOLINTBEGIN(readability-identifier-naming)
static void PrintTo(const Command& command, std::ostream* stream) {
  *stream << int{command.opcode} << ' ' << int{command.type} << ' ' << int{command.motor} << ' ' << command.value;
}
static void PrintTo(Status status, std::ostream* stream) {
  *stream << "status " << static_cast<int>(status);
}
// NOLINTEND(readability-identifier-naming)

namespace {

constexpr Command command_of(Opcode opcode, std::uint8_t type = 0, std::uint8_t motor = 0, std::int32_t value = 0) {
  return {static_cast<std::uint8_t>(opcode), type, motor, value};
}

struct Line {
  const char* text;
  Command command;
};

constexpr Line lines[] = {
    // As the manual prints them in 3.4.2, behind the address character.
    {"MVP ABS, 1, 50000", command_of(Opcode::mvp, 0, 1, 50000)},
    {" MVP ABS, 1, 50000", command_of(Opcode::mvp, 0, 1, 50000)},
    {"ROL 2, 500", command_of(Opcode::rol, 0, 2, 500)},
    {" MST 1", command_of(Opcode::mst, 0, 1)},
    {"BIN", command_of(Opcode::enter_ascii_mode)},
    {"GAP 0, 1", command_of(Opcode::gap, 0, 1)},
    // The other commands of its list.
    {"ROR 0, -2047", command_of(Opcode::ror, 0, 0, -2047)},
    {"MVP REL, 0, -1000", command_of(Opcode::mvp, 1, 0, -1000)},
    {"MVP COORD, 0, 20", command_of(Opcode::mvp, 2, 0, 20)},
    {"SAP 4, 0, 1000", command_of(Opcode::sap, 4, 0, 1000)},
    {"STAP 4, 0", command_of(Opcode::stap, 4)},
    {"RSAP 4, 0", command_of(Opcode::rsap, 4)},
    {"SGP 66, 0, 3", command_of(Opcode::sgp, 66, 0, 3)},
    {"GGP 255, 2", command_of(Opcode::ggp, 255, 2)},
    {"STGP 42, 2", command_of(Opcode::stgp, 42, 2)},
    {"RSGP 42, 2", command_of(Opcode::rsgp, 42, 2)},
    {"RFS START, 0", command_of(Opcode::rfs, 0)},
    {"RFS STOP, 0", command_of(Opcode::rfs, 1)},
    {"RFS STATUS, 0", command_of(Opcode::rfs, 2)},
    {"SIO 1, 2, 1", command_of(Opcode::sio, 1, 2, 1)},
    {"GIO 9, 1", command_of(Opcode::gio, 9, 1)},
    {"SCO 1, 0, 1000", command_of(Opcode::sco, 1, 0, 1000)},
    {"GCO 1, 255", command_of(Opcode::gco, 1, 255)},
    {"CCO 3, 0", command_of(Opcode::cco, 3)},
    {"UF0 1, 2, 3", command_of(Opcode::uf0, 1, 2, 3)},
    {"UF7 0, 0, -1", command_of(Opcode::uf7, 0, 0, -1)},
    {"RUN", command_of(Opcode::run_application, 1)},
    {"STOP", command_of(Opcode::stop_application)},
    // Freedoms.
    {"mvp Abs,0,7", command_of(Opcode::mvp, 0, 0, 7)},
    {"\tMVP \t REL\t,0  ,  +7  ", command_of(Opcode::mvp, 1, 0, 7)},
    {"MVP 1, 0, 7", command_of(Opcode::mvp, 1, 0, 7)},
    {"SGP 0, 2, -2147483648", command_of(Opcode::sgp, 0, 2, int32_minimum)},
    {"SGP 0, 2, 2147483647", command_of(Opcode::sgp, 0, 2, int32_maximum)},
    {"SGP 0, 2, 000000000000007", command_of(Opcode::sgp, 0, 2, 7)},
    {"STAP 4, 0, 1000", command_of(Opcode::stap, 4)},  // E-16
    {"GAP 1, 0, 0", command_of(Opcode::gap, 1)},
};

TEST(AsciiCommand, ReadsEveryCommandThatCanBeTyped) {
  for (const Line& line : lines) {
    Command command;
    EXPECT_EQ(parse_ascii_command(line.text, command), Status::ok) << line.text;
    EXPECT_EQ(command, line.command) << line.text;
  }
}

TEST(AsciiCommand, TheLinesAboveHaveEveryTypedInstructionOfTheTable) {
  for (const InstructionSpec& row : instructions) {
    const bool is_one_of_six_more = row.opcode > Opcode::uf0 && row.opcode < Opcode::uf7;
    if (!row.ascii || is_one_of_six_more) continue;
    bool found = false;
    for (const Line& line : lines) found = found || line.command.opcode == static_cast<std::uint8_t>(row.opcode);
    EXPECT_TRUE(found) << row.mnemonic;
  }
}

TEST(AsciiCommand, RefusesWhatIsNoCommandForText) {
  for (const char* text :
       {"", " ", ",", "X", "GAPP 1, 0", "GA", "GAP1, 0", "CALC ADD, 1", "COMP 1", "WAIT TICKS, 0, 1", "JA 0", "136"}) {
    Command command;
    EXPECT_EQ(parse_ascii_command(text, command), Status::invalid_command) << text;
  }
}

TEST(AsciiCommand, WantsAsManyOperandsAsTheCommandHas) {
  for (const char* text : {"GAP", "GAP 1", "MVP ABS, 0", "MST", "MST 0, 1", "ROR 0, 1, 2", "SAP 1, 0, 2, 3", "BIN 1",
                           "RUN 0", "STOP,", "GAP 1, 0, 0, 0", "GAP 1, 0,", "GAP 1, 0, x"}) {
    Command command;
    EXPECT_EQ(parse_ascii_command(text, command), Status::invalid_command) << text;
  }
}

TEST(AsciiCommand, AnswersAnOperandThatDoesNotFitAsTheModuleAnswersItsField) {
  constexpr struct {
    const char* text;
    Status status;
  } cases[] = {
      {"GAP 256, 0", Status::wrong_type},
      {"GAP -1, 0", Status::wrong_type},
      {"GAP x, 0", Status::wrong_type},
      {"GAP , 0", Status::wrong_type},
      {"MVP FAST, 0, 1", Status::wrong_type},
      {"MVP ABS 0 1, 0, 1", Status::wrong_type},
      {"RFS ABS, 0", Status::wrong_type},
      {"GAP 1, 256", Status::invalid_value},
      {"GAP 1, 0x1", Status::invalid_value},
      {"SGP 0, 2, 2147483648", Status::invalid_value},
      {"SGP 0, 2, -2147483649", Status::invalid_value},
      {"SGP 0, 2, 99999999999999999999", Status::invalid_value},
      {"SGP 0, 2, 1.5", Status::invalid_value},
      {"SGP 0, 2, -", Status::invalid_value},
      {"SGP 0, 2, ", Status::invalid_value},
      {"ROR 0, ABS", Status::invalid_value},
  };
  for (const auto& line : cases) {
    Command command;
    EXPECT_EQ(parse_ascii_command(line.text, command), line.status) << line.text;
  }
}

RC_GTEST_PROP(AsciiCommand, ReadsEveryValue, (std::uint8_t type, std::uint8_t motor, std::int32_t value)) {
  const std::string text = "SAP " + std::to_string(type) + ", " + std::to_string(motor) + ", " + std::to_string(value);
  Command command;
  RC_ASSERT(parse_ascii_command(text, command) == Status::ok);
  RC_ASSERT(command == command_of(Opcode::sap, type, motor, value));
}

RC_GTEST_PROP(AsciiCommand, SurvivesAnyText, (const std::string& text)) {
  Command command;
  parse_ascii_command(text, command);
}

std::string reply_text(const Reply& reply) {
  char text[longest_ascii_reply];
  return {text, format_ascii_reply(reply, text)};
}

TEST(AsciiReply, LooksAsInTheManual) {
  EXPECT_EQ(reply_text({2, 1, Status::ok, 6, -5000}), "BA 100 -5000\r");
  EXPECT_EQ(reply_text({2, 1, Status::invalid_command, 0, 0}), "BA 2 0\r");
}

TEST(AsciiReply, FitsHoweverLongItIs) {
  EXPECT_EQ(reply_text({2, 1, Status::position_reached, 0, int32_minimum}), "BA 128 -2147483648\r");
  EXPECT_EQ(reply_text({2, 1, Status::position_reached, 0, int32_minimum}).size(), longest_ascii_reply);
}

RC_GTEST_PROP(AsciiReply, ShowsTheValueAsANumber, (std::int32_t value)) {
  RC_ASSERT(reply_text({2, 1, Status::ok, 0, value}) == "BA 100 " + std::to_string(value) + "\r");
}

TEST(AsciiAddress, FollowsTheAlphabetAndIsAlwaysPrinting) {
  EXPECT_EQ(ascii_address(1), 'A');
  EXPECT_EQ(ascii_address(2), 'B');
  EXPECT_EQ(ascii_address(26), 'Z');
  EXPECT_EQ(ascii_address(62), '~');
  EXPECT_EQ(ascii_address(63), '?');
  for (int address = 0; address < 256; ++address) {
    const char name = ascii_address(static_cast<std::uint8_t>(address));
    EXPECT_TRUE(name > ' ' && name <= '~') << address;
  }
}

}  // namespace
}  // namespace opentmcl
