#include "server/session_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "server/session_log_reader.hpp"
#include "server/temporary_folder_test.hpp"

namespace opentmcl::server {
namespace {

SessionSetup some_setup() {
  SessionSetup setup;
  setup.module = &tmcm1110;
  setup.machine = "free";
  setup.turn = 250;
  setup.ports = {{hal::PortKind::rs485, 9600}, {hal::PortKind::usb}};
  setup.has_can = true;
  setup.eeprom[64] = 0x12;
  setup.eeprom[16383] = 0x34;
  return setup;
}

struct SessionLogTest : testing::Test {
  TemporaryFolder folder;
  std::string path = folder.path("log");

  void log(std::initializer_list<SessionEvent> events) {
    auto log = SessionLog::create(path, some_setup());
    ASSERT_TRUE(log);
    for (const SessionEvent& event : events) log->write(event);
    log->flush();
    ASSERT_TRUE(log->publish());
  }
  std::string refusal() {
    auto reader = SessionLogReader::open(path);
    if (!reader) return reader.error().message;
    while (reader->next()) reader->take();
    return reader->failure() ? reader->failure()->message : "";
  }
};

TEST_F(SessionLogTest, HoldsTheSetup) {
  log({});
  const auto reader = SessionLogReader::open(path);
  ASSERT_TRUE(reader);
  const SessionSetup& setup = reader->setup();
  const SessionSetup expected = some_setup();
  EXPECT_EQ(expected.module, setup.module);
  EXPECT_EQ(expected.machine, setup.machine);
  EXPECT_EQ(expected.turn, setup.turn);
  EXPECT_EQ(expected.ports, setup.ports);
  EXPECT_EQ(expected.has_can, setup.has_can);
  EXPECT_EQ(expected.eeprom, setup.eeprom);
}

TEST_F(SessionLogTest, HoldsTheScenarioInOneLineOfAscii) {
  SessionSetup setup = some_setup();
  setup.scenario_name = "b\xC3\xBCro.toml";
  setup.scenario = "module = \"tmcm1110\"\nduration = \"1 s\" # \xC3\xA4\n";
  auto log = SessionLog::create(path, setup);
  ASSERT_TRUE(log);
  ASSERT_TRUE(log->publish());
  const std::string text = folder.read("log");
  EXPECT_EQ(3, std::count(text.begin(), text.end(), '\n'));
  EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char letter) { return letter == '\n' || letter >= ' '; }));
  const auto reader = SessionLogReader::open(path);
  ASSERT_TRUE(reader);
  EXPECT_EQ(setup.scenario, reader->setup().scenario);
  EXPECT_EQ(setup.scenario_name, reader->setup().scenario_name);
}

TEST_F(SessionLogTest, HoldsANameThatIsNoText) {
  SessionSetup setup = some_setup();
  setup.scenario_name = "\xFF.toml";
  setup.scenario = "module = \"tmcm1110\"\nduration = \"1 s\"\n";
  EXPECT_TRUE(SessionLog::create(path, setup));
}

TEST_F(SessionLogTest, HoldsTheEventsInTheirOrder) {
  const SessionEvent first{5, ExtraTurn{}};
  const SessionEvent second{5, BytesRead{0, {1, 2}}};
  log({first, second});
  auto reader = SessionLogReader::open(path);
  ASSERT_TRUE(reader);
  EXPECT_EQ(first, reader->next());
  reader->take();
  EXPECT_EQ(second, reader->next());
  EXPECT_EQ(5u, reader->line());
  reader->take();
  EXPECT_EQ(std::nullopt, reader->next());
  EXPECT_FALSE(reader->failure());
}

TEST_F(SessionLogTest, LeavesTheOldFileUntilItIsPublished) {
  folder.write("log", "old");
  auto log = SessionLog::create(path, some_setup());
  ASSERT_TRUE(log);
  EXPECT_EQ("old", folder.read("log"));
  ASSERT_TRUE(log->publish());
  EXPECT_EQ(0u, folder.read("log").rfind(SessionLog::magic, 0));
}

TEST_F(SessionLogTest, CanBeSavedWithAnEndAndGoesOn) {
  auto log = SessionLog::create_nameless(some_setup());
  ASSERT_TRUE(log);
  log->write({1, ExtraTurn{}});
  ASSERT_TRUE(log->save(path, {2, SessionEnd{}}));
  log->write({3, PowerCycled{}});
  ASSERT_TRUE(log->save(folder.path("later"), {4, SessionEnd{}}));
  const std::string first = folder.read("log");
  EXPECT_EQ("1 turn\n2 end 0 0\n", first.substr(first.find("1 turn")));
  const std::string later = folder.read("later");
  EXPECT_EQ("1 turn\n3 power_cycle\n4 end 0 0\n", later.substr(later.find("1 turn")));
  EXPECT_FALSE(std::filesystem::exists(path + ".new"));
}

TEST_F(SessionLogTest, SaysWhyItCannotBeWritten) {
  const auto log = SessionLog::create(folder.path("missing/log"), some_setup());
  ASSERT_FALSE(log);
  EXPECT_EQ(client::ErrorKind::input_output, log.error().kind);
  EXPECT_NE(std::string::npos, log.error().message.find("missing/log.new: No such file"));
}

TEST_F(SessionLogTest, WithoutANameIsGivenUpWhenItIsTooLong) {
  auto log = SessionLog::create_nameless(some_setup());
  ASSERT_TRUE(log);
  const SessionEvent large{0, BytesRead{0, std::vector<std::uint8_t>(1 << 20)}};
  for (std::uint64_t size = 0; size < SessionLog::longest_nameless; size += 2 << 20) {
    EXPECT_FALSE(log->failure());
    log->write(large);
  }
  ASSERT_TRUE(log->failure());
  EXPECT_NE(std::string::npos, log->failure()->message.find("--log FILE"));
  EXPECT_FALSE(log->save(path, {1, SessionEnd{}}));
}

TEST_F(SessionLogTest, ReadsALogThatWasCutOffAsFarAsItGoes) {
  log({{1, ExtraTurn{}}});
  folder.write("log", folder.read("log") + "2 power_cy");
  EXPECT_EQ("", refusal());
}

TEST_F(SessionLogTest, RefusesWhatIsNoLogWithTheLine) {
  log({{1, ExtraTurn{}}});
  const std::string good = folder.read("log");
  const auto refusal_of = [&](const std::string& content) {
    folder.write("log", content);
    return refusal();
  };
  EXPECT_EQ(path + ":1: it is not a session log of OpenTMCL", refusal_of(""));
  EXPECT_EQ(path + ":1: it is not a session log of OpenTMCL", refusal_of("{}\n"));
  EXPECT_EQ(path + ":2: expected format 1, found format 99",
            refusal_of(std::string(SessionLog::magic) + "\nformat 99\n"));
  EXPECT_EQ(path + ":5: no event of a session: nonsense", refusal_of(good + "nonsense\n"));
  EXPECT_EQ(path + ":5: the event is earlier than the one before", refusal_of(good + "0 turn\n"));
  const std::string head = std::string(SessionLog::magic) + "\nformat 1\nsetup ";
  const std::string setup = good.substr(head.size(), good.find("\n1 turn") - head.size());
  for (const auto& [from, to] : std::initializer_list<std::pair<const char*, const char*>>{
           {"tmcm1110", "tmcm9999"},
           {"free", "moon"},
           {"rs485", "rs9"},
           {"rs485", "rs232"},
           {"9600", "299"},
           {"9600", "1000001"},
           {"9600", "0"},
           {R"({"kind":"usb"})", R"({"kind":"usb"},{"kind":"usb"},{"kind":"usb"},{"kind":"usb"})"},
           {"9600", "-1"},
           {"9600", "9600.5"},
           {"9600", "true"},
           {"tmcm1110", "pd1161"},
           {R"("can":true)", R"("can":3)"},
           {R"("turn":250)", R"("turn":0)"},
           {R"("16320")", R"("16321")"},
           {R"("64":"12)", R"("64":")"},
           {R"("machine")", R"("engine")"},
           {"QSH", "QHS"},
           {"{", "["}}) {
    std::string changed = setup;
    ASSERT_NE(std::string::npos, changed.find(from)) << from;
    changed.replace(changed.find(from), std::string(from).size(), to);
    EXPECT_EQ(0u, refusal_of(head + changed + "\n").find(path + ":3: ")) << from;
  }
}

}  // namespace
}  // namespace opentmcl::server
