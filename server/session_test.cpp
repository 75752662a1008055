#include "server/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/memory_line.hpp"
#include "server/shared_can_port.hpp"
#include "server/temporary_folder_test.hpp"

namespace opentmcl::server {
namespace {

using testing::HasSubstr;

Datagram request(Opcode opcode, std::uint8_t type, std::int32_t value) {
  return encode(Request{1, {static_cast<std::uint8_t>(opcode), type, 0, value}});
}

Datagram set_parameter(AxisParameter parameter, std::int32_t value) {
  return request(Opcode::sap, static_cast<std::uint8_t>(parameter), value);
}

Datagram get_parameter(AxisParameter parameter) {
  return request(Opcode::gap, static_cast<std::uint8_t>(parameter), 0);
}

/// A module with a host at each of its two ports, logged, traced and with all replies kept.
struct Bench {
  MemoryLine first;
  MemoryLine second;
  twin::TraceText trace;
  std::unique_ptr<Session> session;

  static SessionSetup setup() {
    SessionSetup setup;
    setup.ports = {{hal::PortKind::usb}, {hal::PortKind::rs485}};
    return setup;
  }
  Session::Doors doors() { return {{&first.port(), &second.port()}, nullptr}; }
  static client::Result<SessionLog> nameless(const SessionSetup& setup) { return SessionLog::create_nameless(setup); }

  explicit Bench(bool is_traced = true) {
    auto started = Session::start(setup(), doors(), {nameless, is_traced ? &trace : nullptr});
    session = std::move(*started);
  }

  VirtualModule& module() { return session->module(); }
  void wait(Microseconds time) { module().advance_to(module().now() + time); }
  void take_turn() {
    module().wake();
    module().advance_to(module().now());
  }
  /// As LiveSimulation does it.
  void answer() {
    for (int i = 0; i < 3; ++i) take_turn();
  }
  void ask(const Datagram& datagram) {
    first.send(datagram);
    answer();
  }
  std::int32_t get(AxisParameter parameter) {
    first.received().clear();
    ask(get_parameter(parameter));
    Datagram reply;
    EXPECT_EQ(datagram_size, first.received().size());
    std::copy(first.received().begin(), first.received().end(), reply.bytes);
    return decode_reply(reply).value;
  }
};

struct SessionTest : testing::Test {
  TemporaryFolder folder;
  std::string path = folder.path("session.log");

  /// What the session `path` does when it is done again.
  std::string replayed_trace() {
    twin::TraceText trace;
    const auto replayed = Session::resume(path, {}, {{}, &trace});
    EXPECT_TRUE(replayed) << (replayed ? "" : replayed.error().message);
    return trace.text();
  }
  std::string replay_error() {
    const auto replayed = Session::resume(path, {}, {});
    return replayed ? "" : replayed.error().message;
  }
};

void some_minutes_at_the_bench(Bench& bench) {
  bench.ask(request(Opcode::ror, 0, 500));
  bench.wait(123'457);
  bench.session->set({{"left_switch.held_open", 1}, {"analog_input.1", 77}});
  bench.wait(1);
  bench.session->set({{"supply_voltage", 5}});
  bench.session->set({{"supply_voltage", 24}});
  bench.session->check_now_and_then();
  bench.wait(3'000'000);
  bench.session->check_now_and_then();
  bench.second.send(set_parameter(AxisParameter::maximum_positioning_speed, 900));
  bench.first.send(get_parameter(AxisParameter::actual_position));
  bench.answer();
  bench.session->power_cycle();
  bench.wait(10'000);
  bench.ask(request(Opcode::mvp, 0, 10'000));
  bench.wait(500'000);
}

TEST_F(SessionTest, DoesTheSameAgainWhenItIsReplayed) {
  Bench bench;
  some_minutes_at_the_bench(bench);
  ASSERT_TRUE(bench.session->save(path));
  EXPECT_FALSE(bench.trace.text().empty());
  EXPECT_EQ(bench.trace.text(), replayed_trace());
}

TEST_F(SessionTest, GoesOnFromASnapshotAsIfNothingHadHappened) {
  Bench bench;
  some_minutes_at_the_bench(bench);
  ASSERT_TRUE(bench.session->save(path));

  Bench other;
  auto resumed = Session::resume(path, other.doors(), {Bench::nameless, &other.trace});
  ASSERT_TRUE(resumed);
  other.session = std::move(*resumed);
  other.trace = bench.trace;
  bench.first.received().clear();
  for (Bench* both : {&bench, &other}) {
    both->ask(get_parameter(AxisParameter::actual_position));
    both->wait(700'000);
    both->session->set({{"right_switch.held_open", 1}});
    both->wait(700'000);
    both->ask(get_parameter(AxisParameter::actual_position));
  }
  EXPECT_EQ(bench.trace.text(), other.trace.text());
  EXPECT_EQ(bench.first.received(), other.first.received());
  EXPECT_EQ(2 * datagram_size, other.first.received().size());
}

TEST_F(SessionTest, ASnapshotOfAResumedSessionIsTheSameAsOneOfTheFirst) {
  Bench bench;
  some_minutes_at_the_bench(bench);
  ASSERT_TRUE(bench.session->save(path));
  const auto resumed = Session::resume(path, {}, {Bench::nameless});
  ASSERT_TRUE(resumed);
  ASSERT_TRUE((*resumed)->save(folder.path("again")));
  EXPECT_EQ(folder.read("session.log"), folder.read("again"));
}

TEST_F(SessionTest, GoesBackToASnapshotInPlace) {
  Bench bench(false);
  bench.ask(request(Opcode::mvp, 0, 10'000));
  bench.wait(50'000);
  const std::int32_t position = bench.get(AxisParameter::actual_position);
  const Microseconds time = bench.module().now();
  ASSERT_TRUE(bench.session->save(path));
  bench.wait(5'000'000);
  EXPECT_EQ(10'000, bench.get(AxisParameter::actual_position));
  ASSERT_TRUE(bench.session->load(path));
  EXPECT_EQ(time, bench.module().now());
  EXPECT_EQ(position, bench.get(AxisParameter::actual_position));
}

TEST_F(SessionTest, StaysAsItIsWhenASnapshotCannotBeLoaded) {
  Bench bench(false);
  bench.wait(1000);
  folder.write("session.log", "nonsense");
  EXPECT_FALSE(bench.session->load(path));
  EXPECT_FALSE(bench.session->load(folder.path("missing")));
  SessionSetup other = Bench::setup();
  other.module = &tmcm1110;
  auto of_another = Session::start(other, {}, {Bench::nameless});
  ASSERT_TRUE((*of_another)->save(path));
  EXPECT_THAT(bench.session->load(path).error().message, HasSubstr("of a TMCM-1110"));
  EXPECT_EQ(1000u, bench.module().now());
  EXPECT_EQ(0, bench.get(AxisParameter::actual_position));
}

TEST_F(SessionTest, KeepsThePortsInTextModeAcrossASnapshot) {
  Bench bench(false);
  bench.ask(request(static_cast<Opcode>(139), 0, 0));
  ASSERT_TRUE(bench.first.port().is_in_text_mode());
  ASSERT_TRUE(bench.session->save(path));
  bench.first.received().clear();
  Bench other;
  EXPECT_FALSE(other.first.port().is_in_text_mode());
  const auto resumed = Session::resume(path, other.doors(), {});
  ASSERT_TRUE(resumed);
  EXPECT_TRUE(other.first.port().is_in_text_mode());
}

TEST_F(SessionTest, CannotBeSavedWithoutALog) {
  MemoryLine line;
  const auto session = Session::start(Bench::setup(), {}, {});
  EXPECT_EQ(client::ErrorKind::usage, (*session)->save(path).error().kind);
}

TEST_F(SessionTest, DoesNotGoBackWhileItIsTraced) {
  Bench bench;
  ASSERT_TRUE(bench.session->save(path));
  EXPECT_EQ(client::ErrorKind::usage, bench.session->load(path).error().kind);
}

TEST_F(SessionTest, NoticesWhenTheRepliesDepart) {
  Bench bench;
  bench.ask(set_parameter(AxisParameter::maximum_positioning_speed, 900));
  bench.wait(2'000'000);
  ASSERT_TRUE(bench.session->save(path));
  std::string log = folder.read("session.log");
  const std::string recorded = "010504";  // SAP 4 …
  const std::string changed = "010604";   // … becomes GAP 4, with a checksum that is not right either
  ASSERT_NE(std::string::npos, log.find(recorded));
  log.replace(log.find(recorded), recorded.size(), changed);
  folder.write("session.log", log);
  EXPECT_THAT(replay_error(), HasSubstr("up to 2.000000 s the replies departed"));
}

TEST_F(SessionTest, NoticesWhenTheWorldDeparts) {
  Bench bench;
  bench.session->set({{"analog_input.1", 77}});
  bench.wait(2'000'000);
  bench.session->check_now_and_then();
  bench.wait(2'000'000);
  ASSERT_TRUE(bench.session->save(path));
  std::string log = folder.read("session.log");
  log.replace(log.find("=77"), 3, "=78");
  folder.write("session.log", log);
  EXPECT_THAT(replay_error(), HasSubstr(":5: up to 2.000000 s the state of the world departed"));
}

TEST_F(SessionTest, ChecksALongSessionLessAndLessOften) {
  Bench bench(false);
  const auto checks_until = [&](Microseconds end) {
    while (bench.module().now() < end) {
      bench.wait(50'000);
      bench.session->check_now_and_then();
    }
    EXPECT_TRUE(bench.session->save(path));
    const std::string log = folder.read("session.log");
    std::size_t checks = 0;
    for (std::size_t at = log.find(" check "); at != std::string::npos; at = log.find(" check ", at + 1)) ++checks;
    return checks;
  };
  EXPECT_EQ(900u, checks_until(900'000'000));
  EXPECT_NEAR(1000 + 693, static_cast<double>(checks_until(2'000'000'000)), 60) << "1000 (1 + ln 2)";
}

TEST_F(SessionTest, NoticesWhenTheFirmwareDoesNotReadWhatItRead) {
  Bench bench;
  ASSERT_TRUE(bench.session->save(path));
  std::string log = folder.read("session.log");
  const std::size_t end = log.find("0 end");
  log.insert(end, "0 read 0 01\n");
  folder.write("session.log", log);
  EXPECT_THAT(replay_error(), HasSubstr(":4: at 0.000000 s the firmware read something then and does not now"));
}

TEST_F(SessionTest, RefusesToSetWhatCannotBeSet) {
  Bench bench;
  ASSERT_TRUE(bench.session->save(path));
  const std::string log = folder.read("session.log");
  const auto error_with = [&](const std::string& line) {
    folder.write("session.log", log.substr(0, log.find("0 end")) + line);
    return replay_error();
  };
  EXPECT_THAT(error_with("0 set nothing=1\n"), HasSubstr("there is no quantity 'nothing'"));
  EXPECT_THAT(error_with("0 set supply_voltage=1000\n"), HasSubstr("supply_voltage goes from 0 to 60 V"));
  EXPECT_THAT(error_with("0 set position=1\n"), HasSubstr("position can only be looked at"));
}

TEST_F(SessionTest, ReplaysCanFrames) {
  struct Sink final : CanFrameSink {
    std::vector<hal::CanFrame> frames;
    void send(const hal::CanFrame& frame) override { frames.push_back(frame); }
  };
  SharedCanPort can;
  Sink sink;
  SessionSetup setup;
  setup.module = &tmcm1110;
  setup.has_can = true;
  twin::TraceText trace;
  auto session = std::move(*Session::start(setup, {{}, &can}, {Bench::nameless, &trace}));
  EXPECT_NE(0u, can.bit_rate());
  hal::CanFrame rotate;
  rotate.id = 1;
  rotate.length = 7;
  rotate.data[0] = static_cast<std::uint8_t>(Opcode::ror);
  rotate.data[5] = 100;
  can.push(rotate, sink);
  for (int i = 0; i < 2; ++i) {
    session->module().wake();
    session->module().advance_to(session->module().now());
  }
  session->module().advance_to(100'000);
  EXPECT_EQ(1u, sink.frames.size());
  ASSERT_TRUE(session->save(path));
  EXPECT_THAT(folder.read("session.log"), HasSubstr(" can_read 1 0100000000"));
  EXPECT_EQ(trace.text(), replayed_trace());
  can.forget(sink);
}

// Whatever comes from outside, and whenever.
RC_GTEST_PROP(Session, ReplaysExactly, ()) {
  TemporaryFolder folder;
  Bench bench;
  const int count = *rc::gen::inRange(1, 30);
  for (int i = 0; i < count; ++i) {
    switch (*rc::gen::inRange(0, 8)) {
      case 0:
        bench.first.send(set_parameter(AxisParameter::target_position, *rc::gen::inRange(-100'000, 100'000)));
        break;
      case 1:
        bench.second.send(request(Opcode::ror, 0, *rc::gen::inRange(0, 2000)));
        break;
      case 2:
        bench.first.send(get_parameter(AxisParameter::actual_position));
        bench.take_turn();
        break;
      case 3:
        bench.answer();
        break;
      case 4:
        bench.session->set({{"home_switch.held_open", static_cast<double>(*rc::gen::inRange(0, 2))},
                            {"supply_voltage", static_cast<double>(*rc::gen::inRange(0, 30))}});
        break;
      case 5:
        if (*rc::gen::inRange(0, 5) == 0) bench.session->power_cycle();
        break;
      case 6:
        bench.session->check_now_and_then();
        break;
      default:
        bench.wait(*rc::gen::inRange<Microseconds>(0, 300'000));
        break;
    }
  }
  RC_ASSERT(bench.session->save(folder.path("log")).ok());
  twin::TraceText trace;
  const auto replayed = Session::resume(folder.path("log"), {}, {{}, &trace});
  if (!replayed) RC_FAIL(replayed.error().message);
  RC_ASSERT(trace.text() == bench.trace.text());
}

}  // namespace
}  // namespace opentmcl::server
