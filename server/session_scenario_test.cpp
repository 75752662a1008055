// What happened once happens again: a motor, a program, a scenario, a line that takes its time, and a host.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "lang/assembler.hpp"
#include "server/live_simulation.hpp"
#include "server/memory_line.hpp"
#include "server/module_setup.hpp"
#include "server/session.hpp"
#include "server/temporary_folder_test.hpp"

namespace opentmcl::server {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::HasSubstr;

constexpr const char* scenario_text = R"(
description = "Much happens to a motor that drives to and fro"
duration = "2 s"

[load]
coulomb_friction = "0.02 Nm"

[[event]]
at = "300 ms"
pulse = { load.coulomb_friction = "0.9 Nm" }
lasting = "60 ms"
note = "something brakes"

[[event]]
when = "stage > 0.2 mm"
set = { temperature = "40 degC" }
note = "the slider has come that far"

[[event]]
at = "900 ms"
send = "SAP 4, 0, 700"

[[event]]
at = "1.2 s"
pulse = { coil_a.connected = false }
lasting = "30 ms"

[[event]]
at = "1.5 s"
ramp = { supply_voltage = "18 V" }
over = "100 ms"

[[expect]]
at = "1 s"
that = "position > 1000000"

[[expect]]
at = "1 s"
that = "temperature = 40"
)";

std::vector<Command> to_and_fro() {
  std::vector<Command> program;
  for (const char* const line :
       {"SAP 5, 0, 500", "MVP ABS, 0, 20000", "WAIT POS, 0, 0", "MVP ABS, 0, -20000", "WAIT POS, 0, 0", "JA 1"}) {
    program.push_back(lang::parse_instruction(line, pd1161).command.value());
  }
  return program;
}

Datagram request(Opcode opcode, std::uint8_t type, std::int32_t value) {
  return encode(Request{1, {static_cast<std::uint8_t>(opcode), type, 0, value}});
}

SessionSetup setup() {
  SessionSetup setup;
  setup.scenario = scenario_text;
  setup.scenario_name = "bench.toml";
  setup.ports = {{hal::PortKind::usb, 19200}, {hal::PortKind::usb}};
  return setup;
}

scenario::Recording recording_to(const std::string& path) {
  scenario::Recording recording;
  recording.file = path;
  recording.signals = {"position", "velocity", "step",        "stage",       "rotor.angle",    "rotor.load_angle",
                       "encoder",  "power",    "tmc262.word", "temperature", "supply_voltage", "coil_a.current"};
  return recording;
}

/// Everything that can be seen of a session.
struct Seen {
  std::string recording;
  std::string trace;
  std::vector<std::string> reports;
  std::vector<std::uint8_t> replies;
};

/// A session, those who look at it, and what it is connected to.
class Bench {
 public:
  Bench(const TemporaryFolder& folder, const std::string& name) : folder_(folder), name_(name + ".vcd") {
    const twin::World world(nullptr, (*scenario_of(setup())).mounted(pd1161));
    recording_ = std::move(*SignalRecording::create(recording_to(folder_.path(name_)), world));
    options_ = {
        [](const SessionSetup& of) { return SessionLog::create_nameless(of); }, &trace_, recording_.get(),
        [this](const SessionSetup&, const scenario::Report& what) {
          reports_.push_back(std::to_string(what.place.line) + " " + std::to_string(what.time) + " " + what.text);
        }};
  }

  Session::Doors doors() { return {{&host_.port(), &line_.port()}, nullptr}; }

  void start() {
    session = std::move(*Session::start(setup(), doors(), options_));
    ASSERT_TRUE(load_program(session->module(), line_, pd1161, to_and_fro(), true));
    session->begin(session->scenario().duration);
  }
  void resume(const std::string& path) {
    auto resumed = Session::resume(path, doors(), options_);
    ASSERT_TRUE(resumed) << resumed.error().message;
    session = std::move(*resumed);
  }

  void wait_until(Microseconds time) { session->module().advance_to(time); }
  void ask(const Datagram& datagram) {
    host_.send(datagram);
    for (int i = 0; i < 2; ++i) {
      session->module().wake();
      session->module().advance_to(session->module().now());
    }
  }

  Seen finish() {
    EXPECT_TRUE(session->finish());
    return {folder_.read(name_), trace_.text(), reports_, host_.received()};
  }
  std::vector<const RequestQueue*> requests() { return {&host_.port(), &line_.port()}; }

  std::unique_ptr<Session> session;

 private:
  const TemporaryFolder& folder_;
  std::string name_;
  MemoryLine host_;
  MemoryLine line_;
  twin::TraceText trace_;
  std::unique_ptr<SignalRecording> recording_;
  std::vector<std::string> reports_;
  Session::Options options_;
};

void first_second(Bench& bench) {
  bench.wait_until(123'456);
  bench.ask(request(Opcode::gap, static_cast<std::uint8_t>(AxisParameter::actual_position), 0));
  bench.wait_until(400'001);
  bench.session->set({{"load.torque", 0.05}, {"analog_input.0", 77}});
  bench.session->check_now_and_then();
  bench.wait_until(1'000'003);
}

void next_seconds(Bench& bench) {
  bench.ask(request(Opcode::gap, static_cast<std::uint8_t>(AxisParameter::actual_speed), 0));
  bench.wait_until(1'400'000);
  bench.session->power_cycle();
  bench.ask(request(Opcode::ror, 0, 300));
  bench.session->check_now_and_then();
  bench.wait_until(2'300'000);
}

struct SessionScenarioTest : testing::Test {
  static void expect_same(const Seen& expected, const Seen& seen) {
    // Not with EXPECT_EQ: they are long.
    EXPECT_TRUE(expected.recording == seen.recording);
    EXPECT_TRUE(expected.trace == seen.trace);
    EXPECT_EQ(expected.reports, seen.reports);
  }

  TemporaryFolder folder;
  std::string path = folder.path("session.log");
};

TEST_F(SessionScenarioTest, IsReplayedToTheLastByteOfItsRecording) {
  Bench live(folder, "live");
  live.start();
  first_second(live);
  next_seconds(live);
  ASSERT_TRUE(live.session->save(path));
  const Seen seen = live.finish();
  EXPECT_GT(seen.recording.size(), 100'000u);
  EXPECT_EQ(3 * datagram_size, seen.replies.size());
  EXPECT_THAT(seen.reports, Contains(HasSubstr("something brakes")));
  EXPECT_THAT(seen.reports, Contains(HasSubstr("the end")));
  EXPECT_EQ(1u, live.session->failures());

  Bench again(folder, "again");
  ASSERT_NO_FATAL_FAILURE(again.resume(path));
  EXPECT_EQ(1u, again.session->failures());
  expect_same(seen, again.finish());
}

TEST_F(SessionScenarioTest, GoesOnFromASnapshotAsTheFirstOneDid) {
  Bench live(folder, "live");
  live.start();
  first_second(live);
  ASSERT_TRUE(live.session->save(path));
  next_seconds(live);
  const Seen seen = live.finish();

  Bench other(folder, "other");
  ASSERT_NO_FATAL_FAILURE(other.resume(path));
  next_seconds(other);
  expect_same(seen, other.finish());
}

TEST_F(SessionScenarioTest, GoesBackInPlaceAndRecordsTheSameOnceMore) {
  std::vector<std::string> reports;
  MemoryLine host;
  MemoryLine line;
  Session::Options options;
  options.make_log = [](const SessionSetup& of) { return SessionLog::create_nameless(of); };
  options.listener = [&reports](const SessionSetup&, const scenario::Report& what) { reports.push_back(what.text); };
  auto started = Session::start(setup(), {{&host.port(), &line.port()}, nullptr}, options);
  ASSERT_TRUE(started);
  const std::unique_ptr<Session>& session = *started;
  ASSERT_TRUE(load_program(session->module(), line, pd1161, to_and_fro(), true));
  session->begin(session->scenario().duration);
  session->module().advance_to(700'000);
  ASSERT_TRUE(session->save(path));
  const std::size_t said = reports.size();
  EXPECT_GT(said, 0u);
  const auto go_on = [&](const std::string& name) {
    const auto number = session->start_recording(recording_to(folder.path(name)));
    ASSERT_TRUE(number) << number.error().message;
    session->module().advance_to(1'700'000);
    EXPECT_EQ(folder.path(name), *session->stop_recording(*number));
  };
  go_on("first.vcd");
  const std::vector<std::string> first = reports;
  ASSERT_TRUE(session->load(path));
  EXPECT_EQ(first, reports) << "what was said before the snapshot is said once";
  go_on("second.vcd");
  EXPECT_GT(folder.read("first.vcd").size(), 50'000u);
  EXPECT_TRUE(folder.read("first.vcd") == folder.read("second.vcd"));
  EXPECT_EQ(std::vector<std::string>(first.begin() + static_cast<std::ptrdiff_t>(said), first.end()),
            std::vector<std::string>(reports.begin() + static_cast<std::ptrdiff_t>(first.size()), reports.end()));
}

TEST_F(SessionScenarioTest, IsTheSameAtEverySpeedHoweverTheWallClockGoes) {
  struct Pacing {
    double speed;
    WallTime::duration clock_cost;
  };
  std::optional<Seen> expected;
  for (const Pacing& pacing : {Pacing{1, 3us}, {100, 0us}, {100, 370us}, {Pace::maximum, 90us}}) {
    Bench bench(folder, "speed");
    bench.start();
    boost::asio::io_context events;
    WallTime wall{1h};
    LiveSimulation simulation(events, bench.session->module(), bench.requests(),
                              {.speed = pacing.speed, .duration = bench.session->scenario().duration},
                              [&] { return wall += pacing.clock_cost; });
    simulation.start();
    while (!simulation.is_finished()) {
      ASSERT_NE(WallTime::max(), simulation.next_turn());
      wall = std::max(wall, simulation.next_turn());
      simulation.advance(wall);
    }
    const Seen seen = bench.finish();
    EXPECT_GT(seen.trace.size(), 1'000'000u);
    if (!expected) expected = seen;
    expect_same(*expected, seen);
  }
}

TEST_F(SessionScenarioTest, IsTheSameHoweverTimeIsCut) {
  std::optional<Seen> expected;
  // The program looks every 1000 us whether it is there.
  for (const Microseconds slice : {Microseconds{1'000'000}, Microseconds{1000}, Microseconds{500}, Microseconds{137}}) {
    Bench bench(folder, "slices");
    bench.start();
    constexpr Microseconds end = 2'500'000;
    VirtualModule& module = bench.session->module();
    while (module.now() < end) module.advance_to(std::min(module.now() + slice, end));
    const Seen seen = bench.finish();
    if (!expected) expected = seen;
    expect_same(*expected, seen);
  }
}

TEST_F(SessionScenarioTest, StaysAsItIsWhileItIsRecorded) {
  Bench bench(folder, "live");
  bench.start();
  ASSERT_TRUE(bench.session->save(path));
  EXPECT_EQ(client::ErrorKind::usage, bench.session->load(path).error().kind);
  bench.finish();
}

TEST_F(SessionScenarioTest, SaysWhatIsWrongWithAScenarioInALog) {
  SessionSetup wrong = setup();
  wrong.scenario = "duration = \"2 s\"\nmodul = \"pd1161\"\n";
  const auto started = Session::start(wrong, {}, {});
  ASSERT_FALSE(started);
  EXPECT_EQ(client::ErrorKind::bad_file, started.error().kind);
  EXPECT_THAT(started.error().message, HasSubstr("bench.toml:2:1: "));
  wrong.scenario = "duration = \"2 s\"\nmodule = \"tmcm1110\"\n";
  EXPECT_THAT(Session::start(wrong, {}, {}).error().message, HasSubstr("is not of a PD-1161"));
}

TEST_F(SessionScenarioTest, BeginsOnce) {
  Bench bench(folder, "live");
  bench.start();
  ASSERT_TRUE(bench.session->save(path));
  bench.finish();
  std::string log = folder.read("session.log");
  const std::size_t begin = log.find(" begin 2000000\n");
  ASSERT_NE(std::string::npos, begin);
  const std::size_t line = log.rfind('\n', begin) + 1;
  const std::string event = log.substr(line, log.find('\n', line) + 1 - line);
  folder.write("session.log", log.insert(line, event));
  const auto replayed = Session::resume(path, {}, {});
  ASSERT_FALSE(replayed);
  EXPECT_THAT(replayed.error().message, HasSubstr("the scenario begins a second time"));
}

}  // namespace
}  // namespace opentmcl::server
