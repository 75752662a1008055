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

using testing::HasSubstr;

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
  ~WatchedSession() override {
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
  const rc::Gen<json> simple = rc::gen::oneOf(
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
