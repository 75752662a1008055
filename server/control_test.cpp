#include "server/control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <optional>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/control_methods.hpp"
#include "server/memory_line.hpp"
#include "server/temporary_folder_test.hpp"

namespace opentmcl::server {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using nlohmann::ordered_json;
using testing::HasSubstr;

struct NotingClient final : ControlClient {
  std::vector<ordered_json> changes;
  void changed(const ordered_json& params) override { changes.push_back(params); }
};

/// A module with a host and a client of the control interface, and a wall clock that the test moves.
struct ControlTest : testing::Test {
  ControlTest() { simulation.start(); }
  ~ControlTest() override {
    control.forget(client);
    control.forget(other_client);
  }

  static std::unique_ptr<Session> start(MemoryLine& line) {
    SessionSetup setup;
    setup.ports = {{hal::PortKind::usb}};
    return std::move(*Session::start(setup, {{&line.port()}, nullptr},
                                     {[](const SessionSetup& made) { return SessionLog::create_nameless(made); }}));
  }
  WallTime now() { return wall += clock_cost; }
  /// Lets the event loop turn until there is an answer.
  RpcOutcome call(const std::string& method, const json& params = nullptr) {
    std::optional<RpcOutcome> outcome;
    control.call(client, method, params, [&outcome](const RpcOutcome& how) { outcome = how; });
    while (!outcome) simulation.advance(now());
    return *outcome;
  }
  ordered_json result(const std::string& method, const json& params = nullptr) {
    const RpcOutcome outcome = call(method, params);
    const auto* error = std::get_if<RpcError>(&outcome);
    EXPECT_EQ(nullptr, error) << method << ": " << error->message;
    return error == nullptr ? std::get<ordered_json>(outcome) : ordered_json();
  }
  RpcError error(const std::string& method, const json& params = nullptr) {
    const RpcOutcome outcome = call(method, params);
    const auto* error = std::get_if<RpcError>(&outcome);
    EXPECT_NE(nullptr, error) << method;
    return error == nullptr ? RpcError{} : *error;
  }
  ordered_json value(const std::string& name) { return result("get", {{"names", name}})["values"][name]; }
  void rotate(std::int32_t velocity) {
    line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::ror), 0, 0, velocity}}));
    simulation.serve(now());
  }
  void pass(WallTime::duration time) {
    const WallTime end = wall + time;
    while (wall < end) {
      wall = std::min(end, std::max(simulation.next_turn(), wall + 1ms));
      simulation.advance(now());
    }
  }

  boost::asio::io_context events;
  TemporaryFolder folder;
  WallTime wall{1h};
  WallTime::duration clock_cost{0};
  MemoryLine line;
  std::unique_ptr<Session> session = start(line);
  LiveSimulation simulation{events, session->module(), {&line.port()}, {}, [this] { return now(); }};
  Control control{*session, simulation, [this] { return now(); }};
  NotingClient client;
  NotingClient other_client;
};

TEST_F(ControlTest, DescribesWhatThereIs) {
  const ordered_json description = result("describe");
  EXPECT_EQ("pd1161", description["module"]);
  EXPECT_EQ("stage", description["machine"]);
  EXPECT_EQ(twin::motors().front().name, description["motor"].get<std::string>());
  EXPECT_EQ(control_methods().size(), description["methods"].size());
  const auto& quantities = description["quantities"];
  const auto supply = std::find_if(quantities.begin(), quantities.end(),
                                   [](const ordered_json& row) { return row["name"] == "supply_voltage"; });
  ASSERT_NE(quantities.end(), supply);
  EXPECT_EQ("V", (*supply)["unit"]);
  EXPECT_EQ(60, (*supply)["highest"]);
  EXPECT_TRUE((*supply)["writable"]);
}

TEST_F(ControlTest, LooksAtOneQuantityAtSomeOrAtAll) {
  EXPECT_EQ(ordered_json({{"supply_voltage", 24.0}}), result("get", {{"names", "supply_voltage"}})["values"]);
  EXPECT_EQ(ordered_json({{"temperature", 25}, {"left_switch", false}}),
            result("get", {{"names", {"temperature", "left_switch"}}})["values"]);
  EXPECT_EQ(result("describe")["quantities"].size(), result("get")["values"].size());
}

TEST_F(ControlTest, LooksAtTheTimeThatHasCome) {
  wall += 123'456us;
  EXPECT_EQ(123'456, result("get", {{"names", "temperature"}})["time"]);
}

TEST_F(ControlTest, TakesParametersByNameOrInTheirOrder) {
  EXPECT_EQ(result("get", {{"names", "temperature"}}), result("get", json::array({"temperature"})));
  EXPECT_EQ(0, result("get", json::array({json::array()}))["values"].size());
}

TEST_F(ControlTest, ChangesQuantitiesAllAtOnce) {
  result("set", {{"values", {{"supply_voltage", 12.5}, {"left_switch.held_open", true}}}});
  EXPECT_EQ(12.5, value("supply_voltage"));
  EXPECT_EQ(true, value("left_switch"));
}

TEST_F(ControlTest, ChangesNoneIfOneCannotBeChanged) {
  EXPECT_EQ("temperature goes from -40 to 200 degC",
            error("set", {{"values", {{"supply_voltage", 12}, {"temperature", 1000}}}}).message);
  EXPECT_EQ(24.0, value("supply_voltage"));
}

TEST_F(ControlTest, RefusesWhatMakesNoSense) {
  const auto expect = [this](const char* message, const char* method, const json& params) {
    const RpcError refused = error(method, params);
    EXPECT_EQ(RpcError::invalid_params, refused.code) << message;
    EXPECT_THAT(refused.message, HasSubstr(message));
  };
  expect("there is no quantity 'supply_voltag': did you mean supply_voltage?", "get", {{"names", "supply_voltag"}});
  expect("names of get has to be a name or an array of names", "get", {{"names", {1}}});
  expect("get has no parameter \"name\"", "get", {{"name", "temperature"}});
  expect("pause has 0 parameters", "pause", json::array({1}));
  expect("set needs values", "set", nullptr);
  expect("an object of names with numbers", "set", {{"values", {{"temperature", "hot"}}}});
  expect("nothing to set", "set", {{"values", json::object()}});
  expect("position can only be looked at", "set", {{"values", {{"position", 1}}}});
  expect("there is no quantity 'nothing'", "set", {{"values", {{"nothing", 1}}}});
  expect("either by or turns", "step", nullptr);
  expect("either by or turns", "step", {{"by", 1}, {"turns", 1}});
  expect("a whole number, not negative", "step", {{"by", -1}});
  expect("a whole number, not negative", "step", {{"by", 1.5}});
  expect("limit is at most", "step", {{"by", 1}, {"limit", 600'001}});
  expect("a number above 0", "set_speed", {{"speed", 0}});
  expect("a number above 0", "set_speed", {{"speed", "slow"}});
  expect("no subscription 7", "unsubscribe", {{"subscription", 7}});
  expect("every is at least 1 us", "subscribe", {{"every", 0}});
  EXPECT_EQ(RpcError::method_not_found, error("jump").code);
}

TEST_F(ControlTest, StopsAndStartsTime) {
  result("pause");
  wall += 5s;
  EXPECT_EQ(0, result("time")["time"]);
  EXPECT_EQ(true, result("time")["paused"]);
  result("resume");
  wall += 1s;
  const ordered_json time = result("time");
  EXPECT_EQ(1'000'000, time["time"]);
  EXPECT_EQ(false, time["paused"]);
  EXPECT_EQ(1.0, time["speed"]);
}

TEST_F(ControlTest, ChangesTheSpeed) {
  result("set_speed", {{"speed", 100}});
  wall += 1s;
  EXPECT_EQ(100'000'000, result("time")["time"]);
  result("set_speed", {{"speed", "max"}});
  EXPECT_EQ("max", result("time")["speed"]);
}

TEST_F(ControlTest, StepsThroughTimeAndTurns) {
  const ordered_json by = result("step", {{"by", 1'500}});
  EXPECT_EQ(1'500, by["time"]);
  EXPECT_EQ(true, by["reached"]);
  rotate(100);
  const ordered_json turns = result("step", {{"turns", 3}});
  EXPECT_EQ(3, turns["turns"]);
  EXPECT_EQ(datagram_size, line.received().size());
  EXPECT_EQ(true, result("time")["paused"]);
  EXPECT_EQ(2'000'000, result("advance", {{"to", 2'000'000}})["time"]);
  EXPECT_THAT(error("advance", {{"to", 1}}).message, HasSubstr("in the past: it is 2000000 us"));
}

TEST_F(ControlTest, GivesUpAStepThatTakesTooLong) {
  rotate(500);
  clock_cost = 100us;
  EXPECT_EQ(RpcError::timeout, error("advance", {{"to", 1'000'000'000'000'000'000}, {"limit", 20}}).code);
  EXPECT_EQ(true, result("time")["paused"]);
}

TEST_F(ControlTest, DoesOneStepAtATime) {
  rotate(500);
  clock_cost = 100us;
  std::optional<RpcOutcome> outcome;
  control.call(client, "step", {{"by", 1'000'000'000'000}}, [&outcome](const RpcOutcome& how) { outcome = how; });
  EXPECT_FALSE(outcome);
  EXPECT_EQ(RpcError::busy, error("step", {{"by", 1}}).code);
  result("pause");
  ASSERT_TRUE(outcome);
  EXPECT_EQ(RpcError::busy, std::get<RpcError>(*outcome).code);
}

TEST_F(ControlTest, PowerCyclesTheModule) {
  rotate(500);
  pass(100ms);
  EXPECT_NE(0, value("velocity"));
  result("power_cycle");
  EXPECT_EQ(0, value("velocity"));
}

TEST_F(ControlTest, TellsOfChanges) {
  const ordered_json subscribed = result("subscribe", {{"names", {"position", "temperature"}}, {"every", 20'000}});
  EXPECT_EQ(0, subscribed["values"]["position"]);
  pass(100ms);
  EXPECT_TRUE(client.changes.empty());
  rotate(500);
  pass(1s);
  // Looked at 50 times within the second; the first changes are too small for a microstep.
  EXPECT_GT(client.changes.size(), 40u);
  for (const ordered_json& change : client.changes) {
    EXPECT_EQ(subscribed["subscription"], change["subscription"]);
    EXPECT_EQ(0, change["time"].get<std::uint64_t>() % 20'000);
    EXPECT_EQ(1u, change["values"].size());
    EXPECT_TRUE(change["values"].contains("position"));
  }
  client.changes.clear();
  result("unsubscribe", {{"subscription", subscribed["subscription"]}});
  pass(100ms);
  EXPECT_TRUE(client.changes.empty());
}

TEST_F(ControlTest, TellsTheSameAtEverySpeed) {
  std::vector<std::vector<ordered_json>> told;
  ASSERT_TRUE(session->save(folder.path("begin")));
  for (const char* speed : {"1", "100", "\"max\""}) {
    result("load", {{"path", folder.path("begin")}});
    client.changes.clear();
    rotate(500);
    ASSERT_EQ(0u, session->module().now());
    const auto subscription = result("subscribe", {{"every", 10'000}})["subscription"];
    result("set_speed", {{"speed", json::parse(speed)}});
    clock_cost = 100us;
    while (session->module().now() < 500'000) {
      wall = std::max(wall, simulation.next_turn());
      simulation.advance(now());
    }
    clock_cost = 0us;
    result("unsubscribe", {{"subscription", subscription}});
    std::erase_if(client.changes, [](ordered_json& change) {
      change.erase("subscription");
      return change["time"] > 500'000;
    });
    told.push_back(client.changes);
  }
  EXPECT_GT(told[0].size(), 40u);
  EXPECT_EQ(told[0], told[1]);
  EXPECT_EQ(told[0], told[2]);
}

TEST_F(ControlTest, KeepsTheSubscriptionsOfItsClientsApart) {
  std::optional<RpcOutcome> outcome;
  control.call(other_client, "subscribe", {{"names", "position"}},
               [&outcome](const RpcOutcome& how) { outcome = how; });
  const ordered_json number = std::get<ordered_json>(*outcome)["subscription"];
  EXPECT_EQ(RpcError::invalid_params, error("unsubscribe", {{"subscription", number}}).code);
  rotate(500);
  pass(100ms);
  EXPECT_TRUE(client.changes.empty());
  EXPECT_FALSE(other_client.changes.empty());
  control.forget(other_client);
  other_client.changes.clear();
  pass(100ms);
  EXPECT_TRUE(other_client.changes.empty());
}

TEST_F(ControlTest, LimitsTheSubscriptionsOfAClient) {
  for (std::size_t i = 0; i < Control::most_subscriptions; ++i) result("subscribe");
  EXPECT_EQ(RpcError::invalid_params, error("subscribe").code);
}

TEST_F(ControlTest, SavesAndLoadsTheState) {
  rotate(500);
  pass(300ms);
  const ordered_json saved = result("get");
  result("save", {{"path", folder.path("snapshot")}});
  pass(300ms);
  EXPECT_NE(saved, result("get"));
  bool was_told = false;
  control.when_loaded([&] { was_told = true; });
  result("pause");
  result("load", {{"path", folder.path("snapshot")}});
  EXPECT_TRUE(was_told);
  EXPECT_EQ(saved, result("get"));
  EXPECT_EQ(RpcError::input_output, error("load", {{"path", folder.path("missing")}}).code);
  folder.write("nonsense", "nonsense");
  EXPECT_EQ(RpcError::bad_file, error("load", {{"path", folder.path("nonsense")}}).code);
  EXPECT_EQ(RpcError::input_output, error("save", {{"path", folder.path("missing/snapshot")}}).code);
}

TEST_F(ControlTest, ReachesWhateverCanBeReadAndWritten) {
  const ordered_json description = result("describe");
  std::size_t written = 0;
  for (const ordered_json& quantity : description["quantities"]) {
    const std::string name = quantity["name"];
    const ordered_json before = value(name);
    if (!quantity["writable"].get<bool>()) continue;
    ++written;
    const double lowest = quantity["lowest"];
    const double highest = quantity["highest"];
    EXPECT_EQ(RpcError::invalid_params, error("set", {{"values", {{name, highest + 1}}}}).code) << name;
    const bool is_real = quantity["kind"] == "real";
    const double other = is_real ? lowest + (highest - lowest) / 3 : before == highest ? lowest : highest;
    result("set", {{"values", {{name, other}}}});
    const ordered_json after = value(name);
    const double read = after.is_boolean() ? (after.get<bool>() ? 1 : 0) : after.get<double>();
    EXPECT_NEAR(other, read, 1e-6 * highest) << name;
    result("set", {{"values", {{name, before}}}});
  }
  EXPECT_GT(written, 30u);
}

TEST_F(ControlTest, RecordsWhileItRuns) {
  rotate(500);
  const ordered_json started =
      result("start_recording", {{"path", folder.path("a.csv")}, {"signals", {"position", "step"}}, {"every", 500}});
  result("start_recording", {{"path", folder.path("b.vcd")}});
  pass(100ms);
  const ordered_json stopped = result("stop_recording", {{"recording", started["recording"]}});
  EXPECT_EQ(folder.path("a.csv"), stopped["path"]);
  const std::string recording = folder.read("a.csv");
  EXPECT_THAT(recording, HasSubstr("position"));
  EXPECT_GT(std::count(recording.begin(), recording.end(), '\n'), 150);
  pass(100ms);
  EXPECT_EQ(recording, folder.read("a.csv"));
  EXPECT_EQ(RpcError::invalid_params, error("stop_recording", {{"recording", started["recording"]}}).code);
  EXPECT_EQ(RpcError::invalid_params, error("start_recording", {{"path", folder.path("a.txt")}}).code);
  EXPECT_EQ(RpcError::invalid_params,
            error("start_recording", {{"path", folder.path("a.csv")}, {"signals", "nothing"}}).code);
  EXPECT_EQ(RpcError::invalid_params, error("start_recording", {{"path", folder.path("a.csv")}, {"every", 0}}).code);
  EXPECT_EQ(RpcError::input_output, error("start_recording", {{"path", folder.path("missing/a.csv")}}).code);
  result("save", {{"path", folder.path("snapshot")}});
  EXPECT_THAT(error("load", {{"path", folder.path("snapshot")}}).message, HasSubstr("would have to go back in time"));
}

TEST_F(ControlTest, EndsTheSimulation) {
  std::optional<RpcOutcome> outcome;
  control.call(client, "quit", nullptr, [&outcome](const RpcOutcome& how) { outcome = how; });
  simulation.run();
  EXPECT_TRUE(std::holds_alternative<ordered_json>(*outcome));
}

}  // namespace
}  // namespace opentmcl::server
