// What conversations cannot show: transfers that are ended, clients that vanish, messages that are none.

#include "editor/dap/adapter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "editor/dap/debugging_client_test.hpp"

namespace opentmcl::editor::dap {
namespace {

constexpr const char* endless = "Loop: CALC ADD, 1\n JA Loop\n";

std::vector<json> events_of(const std::vector<json>& messages, const std::string& name) {
  std::vector<json> events;
  std::copy_if(messages.begin(), messages.end(), std::back_inserter(events),
               [&](const json& message) { return member(message, "event") == name; });
  return events;
}

/// The answer to a command; null if there is none.
json answer_in(const std::vector<json>& messages, const std::string& command) {
  for (const json& message : messages) {
    if (message["type"] == "response" && message["command"] == command) return message;
  }
  return nullptr;
}

struct Bench {
  TestFolder folder;
  DebuggingClient client;
  std::string program = folder.write("my.tmc", endless);

  explicit Bench(OpenSession open_session = TwinSession::open) : client(std::move(open_session)) {
    client.ask("initialize", {{"supportsProgressReporting", true}});
  }
  std::vector<json> launch() { return client.ask("launch", {{"program", program}}); }
  void start() {
    launch();
    client.ask("configurationDone");
  }
};

// ---- Transfers

TEST(DebugAdapter, ShowsHowFarATransferIs) {
  Bench bench;
  const std::vector<json> said = bench.launch();
  const std::vector<json> starts = events_of(said, "progressStart");
  ASSERT_FALSE(starts.empty());
  EXPECT_EQ(starts.front()["body"]["percentage"], 33) << "three instructions, with the STOP behind them";
  EXPECT_EQ(starts.front()["body"]["cancellable"], true);
  EXPECT_EQ(starts.size(), events_of(said, "progressEnd").size());
}

TEST(DebugAdapter, EndsATransferThatIsCancelled) {
  Bench bench;
  bench.client.put("launch", {{"program", bench.program}});  // the second request
  bench.client.put("cancel", {{"requestId", 2}});
  const std::vector<json> said = bench.client.listen();
  EXPECT_EQ(answer_in(said, "launch")["success"], false);
  EXPECT_EQ(answer_in(said, "launch")["message"], "interrupted");
  EXPECT_EQ(answer_in(said, "cancel")["success"], true);
  EXPECT_TRUE(events_of(said, "initialized").empty());
  EXPECT_EQ(answer_in(bench.launch(), "launch")["success"], true) << "and a new one can begin";
}

TEST(DebugAdapter, KeepsRequestsThatComeDuringATransfer) {
  Bench bench;
  bench.client.put("launch", {{"program", bench.program}});
  bench.client.put("setFunctionBreakpoints", {{"breakpoints", {{{"name", "Loop"}}}}});
  bench.client.put("cancel", {{"requestId", 77}});
  const std::vector<json> said = bench.client.listen();
  EXPECT_EQ(answer_in(said, "launch")["success"], true);
  EXPECT_EQ(answer_in(said, "setFunctionBreakpoints")["body"]["breakpoints"][0]["verified"], true);
}

TEST(DebugAdapter, LeavesDuringATransfer) {
  Bench bench;
  bench.client.put("launch", {{"program", bench.program}});
  bench.client.put("disconnect");
  const std::vector<json> said = bench.client.listen();
  EXPECT_EQ(answer_in(said, "launch")["success"], false);
  EXPECT_EQ(answer_in(said, "disconnect")["success"], true);
  EXPECT_TRUE(bench.client.adapter().is_over());
}

// ---- Exceptions

/// Turns the motor for two seconds from "Turning" on: fast enough for stallGuard2, and with an encoder that may be 2000
/// off. @param stall_speed from which on a stall stops the motor; 0: none does
std::string turning(const std::string& stall_speed) {
  return R"(
#include TMCLParam.tmc
        SAP APPulseDivisor, 0, 0
        SAP APMaxCurrent, 0, 128
        SAP APStallGuardFilter, 0, 0
        SAP APStallGuardThreshold, 0, -18
        SAP 212, 0, 2000
        ROL 0, 524
        WAIT TICKS, 0, 20
        SAP APStopOnStall, 0, )" +
         stall_speed + R"(
Turning: WAIT TICKS, 0, 200
        STOP
)";
}

/// What happens at the bench while the program runs, and the filter that is about it.
struct Mishap {
  const char* filter;
  const char* quantity;
  const char* value;
  const char* name;  ///< as the user reads it
  const char* stall_speed = "0";
};
constexpr Mishap mishaps[] = {
    {"stall", "load.jammed", "1", "stall", "500"},
    {"deviation", "load.jammed", "1", "deviation"},
    {"underVoltage", "supply_voltage", "5", "under-voltage"},
};

/// Lets the motor turn, and then the mishap happen while the program goes on. @return stops after it
std::vector<json> meet(Bench& bench, const Mishap& mishap) {
  const std::vector<json> turning_stops = events_of(bench.client.ask("continue"), "stopped");
  EXPECT_EQ(turning_stops.at(0)["body"]["reason"], "function breakpoint");
  bench.client.put("continue");
  bench.client.put("setExpression", {{"expression", mishap.quantity}, {"value", mishap.value}});
  return events_of(bench.client.listen(), "stopped");
}

/// The same for a program that has just been launched, with the filters of the client.
std::vector<json> run_into(Bench& bench, const Mishap& mishap, const json& filters) {
  bench.program = bench.folder.write("turning.tmc", turning(mishap.stall_speed));
  bench.launch();
  bench.client.ask("setFunctionBreakpoints", {{"breakpoints", {{{"name", "Turning"}}}}});
  const std::vector<json> said = bench.client.ask("setExceptionBreakpoints", {{"filters", filters}});
  EXPECT_EQ(answer_in(said, "setExceptionBreakpoints")["success"], true);
  bench.client.ask("configurationDone");
  return meet(bench, mishap);
}

TEST(DebugAdapter, StopsOnAnExceptionWhoseFilterIsSet) {
  for (const Mishap& mishap : mishaps) {
    SCOPED_TRACE(mishap.filter);
    Bench bench;
    const std::vector<json> stops = run_into(bench, mishap, {mishap.filter});
    ASSERT_EQ(stops.size(), 1U);
    const json& body = stops.front()["body"];
    EXPECT_EQ(body["reason"], "exception");
    EXPECT_EQ(body["description"], std::string("Paused on ") + mishap.name);
    EXPECT_EQ(body["text"], mishap.name);
    EXPECT_EQ(body["threadId"], 1);

    const json info = answer_in(bench.client.ask("exceptionInfo", {{"threadId", 1}}), "exceptionInfo");
    EXPECT_EQ(info["success"], true);
    EXPECT_EQ(info["body"]["exceptionId"], mishap.name);
    EXPECT_EQ(info["body"]["breakMode"], "always");
  }
}

TEST(DebugAdapter, DoesNotStopOnAnExceptionWhoseFilterIsNotSet) {
  for (const Mishap& mishap : mishaps) {
    SCOPED_TRACE(mishap.filter);
    json others = json::array();
    for (const Mishap& other : mishaps) {
      if (other.quantity != std::string_view(mishap.quantity)) others.push_back(other.filter);
    }
    Bench bench;
    const std::vector<json> stops = run_into(bench, mishap, others);
    ASSERT_EQ(stops.size(), 1U);
    EXPECT_EQ(stops.front()["body"]["reason"], "ended");
    const json info = answer_in(bench.client.ask("exceptionInfo", {{"threadId", 1}}), "exceptionInfo");
    EXPECT_EQ(info["success"], false);
    EXPECT_EQ(info["message"], "the program was not stopped by an exception");
  }
}

TEST(DebugAdapter, KeepsTheExceptionFiltersOverARestart) {
  Bench bench;
  const Mishap& mishap = mishaps[1];
  run_into(bench, mishap, {mishap.filter});
  bench.client.ask("restart");
  const std::vector<json> stops = meet(bench, mishap);
  ASSERT_EQ(stops.size(), 1U);
  EXPECT_EQ(stops.front()["body"]["reason"], "exception");
}

TEST(DebugAdapter, StopsOnNoExceptionWithoutDebugging) {
  Bench bench;
  bench.program = bench.folder.write("turning.tmc", turning("0"));
  bench.client.ask("launch", {{"program", bench.program}, {"noDebug", true}});
  bench.client.ask("setExceptionBreakpoints", {{"filters", {"stall", "deviation", "underVoltage"}}});
  bench.client.put("configurationDone");
  bench.client.put("setExpression", {{"expression", "load.jammed"}, {"value", "1"}});
  const std::vector<json> said = bench.client.listen();
  EXPECT_TRUE(events_of(said, "stopped").empty());
  EXPECT_EQ(events_of(said, "terminated").size(), 1U);
}

// ---- The end

/// A twin whose last state outlives its session.
struct Watched {
  int stops = 0;
  bool is_there = false;
};

class WatchedSession final : public Session {
 public:
  WatchedSession(std::unique_ptr<Session> session, Watched& watched) : session_(std::move(session)), watched_(watched) {
    watched_.is_there = true;
  }
  ~WatchedSession() override {  // NOLINT(bugprone-exception-escape): a test that throws here has failed
    const client::Result<client::ProgramStatus> status = session_->target().status();
    if (status.ok() && status->state == client::ProgramStatus::State::stopped) ++watched_.stops;
    watched_.is_there = false;
  }
  debug::Target& target() override { return session_->target(); }
  debug::Program take_program() override { return session_->take_program(); }
  client::Result<std::string> load(debug::Engine& engine, const client::Progress& progress) override {
    return session_->load(engine, progress);
  }

 private:
  std::unique_ptr<Session> session_;
  Watched& watched_;
};

OpenSession watched_by(Watched& watched) {
  return [&watched](const SessionRequest& request, const Say& say,
                    const client::Progress& progress) -> client::Result<std::unique_ptr<Session>> {
    client::Result<std::unique_ptr<Session>> session = TwinSession::open(request, say, progress);
    if (!session) return session;
    std::unique_ptr<Session> result = std::make_unique<WatchedSession>(std::move(*session), watched);
    return result;
  };
}

TEST(DebugAdapter, StopsTheModuleOfAClientThatVanishes) {
  Watched watched;
  Bench bench(watched_by(watched));
  bench.start();
  ASSERT_TRUE(watched.is_there);
  bench.client.put("continue");
  bench.client.vanish();
  bench.client.listen();
  EXPECT_TRUE(bench.client.adapter().is_over());
  EXPECT_FALSE(watched.is_there);
  EXPECT_EQ(watched.stops, 1);
  EXPECT_TRUE(bench.client.adapter().run().ok());
}

TEST(DebugAdapter, StopsWhatWasLaunchedAtADisconnect) {
  Watched watched;
  Bench bench(watched_by(watched));
  bench.start();
  bench.client.ask("disconnect");
  EXPECT_FALSE(watched.is_there);
  EXPECT_EQ(watched.stops, 1);
}

TEST(DebugAdapter, LeavesAProgramAloneThatTheClientWantsToGoOn) {
  Watched watched;
  Bench bench(watched_by(watched));
  bench.start();
  bench.client.ask("disconnect", {{"terminateDebuggee", false}});
  EXPECT_FALSE(watched.is_there);
  EXPECT_EQ(watched.stops, 0);
}

TEST(DebugAdapter, EndsWhenSomebodyElseWantsItTo) {
  auto [client, server] = MemoryStream::make_pair();
  Adapter adapter(*server, TwinSession::open, [] { return true; });
  EXPECT_TRUE(adapter.run().ok());
}

/// A session that says whether its program was let go for good.
class LetGoSession final : public Session, private debug::Target {
 public:
  LetGoSession(std::unique_ptr<Session> session, int& times) : session_(std::move(session)), times_(times) {}

  debug::Target& target() override { return *this; }
  debug::Program take_program() override { return session_->take_program(); }
  client::Result<std::string> load(debug::Engine& engine, const client::Progress& progress) override {
    return session_->load(engine, progress);
  }

 private:
  debug::Target& twin_target() const { return session_->target(); }

  client::Client& client() override { return twin_target().client(); }
  const ModuleDescription& module() const override { return twin_target().module(); }
  client::Result<client::ProgramStatus> status() override { return twin_target().status(); }
  client::Result<client::ProgramStatus> restart() override { return twin_target().restart(); }
  client::Result<client::ProgramStatus> step(std::uint16_t address, const Command& instruction) override {
    return twin_target().step(address, instruction);
  }
  void rest() override { twin_target().rest(); }
  client::Result<void> let_run() override {
    ++times_;
    return twin_target().let_run();
  }
  client::Result<client::ProgramStatus> halt() override { return twin_target().halt(); }
  client::Result<client::ProgramStatus> jump(std::uint16_t address) override { return twin_target().jump(address); }
  unsigned steps_a_slice() const override { return twin_target().steps_a_slice(); }
  debug::TwinPowers* twin() override { return twin_target().twin(); }

  std::unique_ptr<Session> session_;
  int& times_;
};

/// How often the program was let go by a disconnect. @param moves it was stepped before
int times_let_go(bool moves, const json& arguments) {
  int times = 0;
  {
    Bench bench([&times](const SessionRequest& request, const Say& say,
                         const client::Progress& progress) -> client::Result<std::unique_ptr<Session>> {
      client::Result<std::unique_ptr<Session>> session = TwinSession::open(request, say, progress);
      if (!session) return session;
      std::unique_ptr<Session> result = std::make_unique<LetGoSession>(std::move(*session), times);
      return result;
    });
    bench.start();
    if (moves) bench.client.ask("next");
    bench.client.ask("disconnect", arguments);
  }
  return times;
}

TEST(DebugAdapter, LetsAProgramGoOnThatWasLetGoBefore) {
  const json stays = {{"terminateDebuggee", false}};
  EXPECT_EQ(times_let_go(true, stays), 1);
  EXPECT_EQ(times_let_go(false, stays), 0) << "it has never moved";
  EXPECT_EQ(times_let_go(true, {{"terminateDebuggee", false}, {"suspendDebuggee", true}}), 0);
  EXPECT_EQ(times_let_go(true, {{"terminateDebuggee", true}}), 0);
}

TEST(DebugAdapter, SaysOnceForEachRunThatItIsOver) {
  Bench bench;
  bench.program = bench.folder.write("short.tmc", "CALC ADD, 1\nSTOP\n");
  bench.start();
  for (int run = 0; run < 2; ++run) {
    EXPECT_EQ(events_of(bench.client.ask("continue"), "stopped").at(0)["body"]["reason"], "ended");
    EXPECT_EQ(events_of(bench.client.ask("continue"), "terminated").size(), 1U);
    EXPECT_TRUE(events_of(bench.client.ask("continue"), "terminated").empty());
    bench.client.ask("restart");
  }
}

// ---- Where the program is

/// The line where it stands, and how many frames are open.
std::pair<int, int> place_of(Bench& bench) {
  const json body = answer_in(bench.client.ask("stackTrace", {{"levels", 1}}), "stackTrace")["body"];
  EXPECT_EQ(body["stackFrames"].size(), 1U) << "no more than were asked for";
  return {body["stackFrames"][0]["line"], body["totalFrames"]};
}

TEST(DebugAdapter, StepsBackOverASubroutineOrByInstructionsIntoIt) {
  Bench bench;
  bench.program = bench.folder.write("calls.tmc", "CSUB Sub\nSTOP\nSub: CALC ADD, 1\nRSUB\n");
  bench.start();
  bench.client.ask("next");
  EXPECT_EQ(place_of(bench), std::pair(2, 1));
  bench.client.ask("stepBack");
  EXPECT_EQ(place_of(bench), std::pair(1, 1));
  bench.client.ask("next");
  bench.client.ask("stepBack", {{"granularity", "instruction"}});
  EXPECT_EQ(place_of(bench), std::pair(4, 2));
}

TEST(DebugAdapter, GoesToInstructionsOfTheProgramOnly) {
  Bench bench;
  bench.program = bench.folder.write("three.tmc", "CALC ADD, 1\nCALC ADD, 2\nSTOP\n");
  bench.start();
  EXPECT_EQ(answer_in(bench.client.ask("goto", {{"targetId", 2}}), "goto")["success"], true);
  EXPECT_EQ(place_of(bench).first, 3);
  for (const int nowhere : {-1, 3}) {
    EXPECT_EQ(answer_in(bench.client.ask("goto", {{"targetId", nowhere}}), "goto")["success"], false) << nowhere;
  }
}

// ---- Messages that are none

TEST(DebugAdapter, SaysWhatIsWrongWithAMessage) {
  Bench bench;
  bench.client.stream().write_text("{");
  const std::vector<json> not_json = bench.client.listen();
  ASSERT_EQ(events_of(not_json, "output").size(), 1U);
  EXPECT_EQ(not_json.front()["body"]["output"], "the body of a message is not JSON\n");
  bench.client.stream().write({{"type", "request"}, {"seq", 5}});
  const std::vector<json> no_command = bench.client.listen();
  ASSERT_EQ(no_command.size(), 1U);
  EXPECT_EQ(no_command.front()["request_seq"], 5);
  EXPECT_EQ(no_command.front()["success"], false);
  bench.client.stream().write(5);
  EXPECT_EQ(bench.client.listen().at(0)["success"], false);
  bench.client.stream().write({{"type", "response"}, {"request_seq", 1}});
  EXPECT_TRUE(bench.client.listen().empty()) << "answers are not answered";
}

/// Something JSON, small.
rc::Gen<json> any_json(int depth) {
  rc::Gen<json> simple = rc::gen::oneOf(
      rc::gen::just(json()), rc::gen::map(rc::gen::arbitrary<bool>(), [](bool value) { return json(value); }),
      rc::gen::map(rc::gen::arbitrary<std::int64_t>(), [](std::int64_t value) { return json(value); }),
      rc::gen::map(rc::gen::inRange(-2, 2049), [](int value) { return json(value); }),
      rc::gen::map(rc::gen::arbitrary<double>(), [](double value) { return json(value); }),
      rc::gen::map(
          rc::gen::elementOf(std::vector<std::string>{"A", "0x8", "Loop", "", "MVP ABS, 0, 1", "stall", "GAP("}),
          [](const std::string& value) { return json(value); }));
  if (depth == 0) return simple;
  return rc::gen::oneOf(simple, rc::gen::map(rc::gen::container<std::vector<json>>(any_json(depth - 1)),
                                             [](const std::vector<json>& values) { return json(values); }));
}

rc::Gen<json> any_arguments() {
  const std::vector<std::string> names = {
      "program", "source",          "breakpoints",        "filters",          "expression", "context",
      "count",   "memoryReference", "variablesReference", "instructionCount", "line",       "name",
      "value",   "offset",          "startFrame",         "levels",           "frameId",    "targetId",
      "start",   "endLine",         "granularity",        "sourceReference",  "port",       "instructionOffset"};
  return rc::gen::map(rc::gen::container<std::vector<std::pair<std::string, json>>>(
                          rc::gen::pair(rc::gen::elementOf(names), any_json(1))),
                      [](const std::vector<std::pair<std::string, json>>& members) {
                        json arguments = json::object();
                        for (const auto& [name, value] : members) arguments[name] = value;
                        return arguments;
                      });
}

TEST(DebugAdapter, AnswersEveryRequestOnceWhateverIsInIt) {
  const std::vector<std::string> commands = {"initialize",
                                             "launch",
                                             "attach",
                                             "configurationDone",
                                             "restart",
                                             "cancel",
                                             "threads",
                                             "next",
                                             "stepIn",
                                             "stepOut",
                                             "stepBack",
                                             "reverseContinue",
                                             "pause",
                                             "gotoTargets",
                                             "goto",
                                             "setBreakpoints",
                                             "setFunctionBreakpoints",
                                             "setInstructionBreakpoints",
                                             "setDataBreakpoints",
                                             "dataBreakpointInfo",
                                             "setExceptionBreakpoints",
                                             "exceptionInfo",
                                             "breakpointLocations",
                                             "stackTrace",
                                             "scopes",
                                             "variables",
                                             "setVariable",
                                             "setExpression",
                                             "evaluate",
                                             "source",
                                             "loadedSources",
                                             "readMemory",
                                             "disassemble",
                                             "nonsense"};
  rc::check([&] {
    Bench bench;
    bench.start();
    const int count = *rc::gen::inRange(1, 8);
    for (int i = 0; i < count; ++i) {
      const std::string command = *rc::gen::elementOf(commands);
      const std::vector<json> said = bench.client.ask(command, *any_arguments());
      const auto answers = std::count_if(said.begin(), said.end(), [&](const json& message) {
        return message["type"] == "response" && message["command"] == command;
      });
      RC_ASSERT(answers == 1);
    }
    RC_ASSERT(answer_in(bench.client.ask("disconnect"), "disconnect")["success"] == true);
  });
}

}  // namespace
}  // namespace opentmcl::editor::dap
