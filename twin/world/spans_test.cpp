// However time is cut and whoever looks, a world with a motor goes the same way.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "twin/world/digest.hpp"
#include "twin/world/world_test_bench.hpp"

namespace opentmcl::twin {
namespace {

World::Mounted bench_machine() {
  return {.machine = LinearStageDimensions{}, .motor = motors().front()};
}

/// A session at the bench: what happens does not depend on the slices, only on the ticks.
struct Session {
  std::uint64_t seed;
  Tick slice;
  bool looks;

  std::string run() const {
    TraceText trace;
    World world(&trace, bench_machine());
    start(world, 2);
    const auto pass = [&](Tick span) {
      const Tick end = world.now() + span;
      while (world.now() < end) {
        world.advance_to(std::min(end, world.now() + slice));
        if (looks) static_cast<void>(world.rotor_angle() + world.encoder().count());
      }
    };
    std::uint64_t random = seed;
    const auto next = [&random](std::uint64_t below) {
      random = random * 6364136223846793005u + 1442695040888963407u;
      return (random >> 33) % below;
    };
    for (int i = 0; i < 6; ++i) {
      Load load;
      load.torque = 0.05 * static_cast<double>(next(8));
      world.set_load(load);
      set<tmc429::TargetPosition>(world, static_cast<std::int32_t>(next(40'000)) - 20'000);
      pass(next(200 * millisecond) + 1);
      if (next(3) == 0) world.set_right_switch(next(2) == 0);
    }
    return trace.text() + std::to_string(world.rotor_angle()) + " " + std::to_string(world.motor()->state().velocity);
  }
};

RC_GTEST_PROP(Spans, DoNotDependOnHowTimeIsCutOrWhoLooks, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const auto slice = *rc::gen::element<Tick>(1'000, 7'777, 16'000, 100'000);
  const std::string whole = Session{seed, 1'000'000'000, false}.run();
  RC_ASSERT((Session{seed, slice, false}.run()) == whole);
  RC_ASSERT((Session{seed, slice, true}.run()) == whole);
}

/// The lines of a trace that tell of steps, from `tick` on.
std::string steps_since(Tick tick, const std::string& trace) {
  std::istringstream lines(trace);
  std::string steps;
  for (std::string line; std::getline(lines, line);) {
    const bool tells_of_step =
        line.find(" step ") != std::string::npos || line.find(" direction ") != std::string::npos;
    if (tells_of_step && std::stoull(line) > tick) steps += line + '\n';
  }
  return steps;
}

RC_GTEST_PROP(Spans, DoNotDependOnWhenAnObserverComesAndGoes, ()) {
  const auto target = *rc::gen::inRange(-20'000, 20'000);
  const auto comes = *rc::gen::inRange<Tick>(1, 300 * millisecond);
  const auto stays = *rc::gen::inRange<Tick>(0, 300 * millisecond);
  const auto run = [&](TraceText& whole, TraceText& part, bool has_visitor) {
    World world(has_visitor ? nullptr : &whole, bench_machine());
    start(world, 2);
    set<tmc429::TargetPosition>(world, target);
    world.advance_to(comes);
    if (has_visitor) world.observe(&part);
    world.advance_to(comes + stays);
    if (has_visitor) world.observe(nullptr);
    world.advance_to(700 * millisecond);
    return digest_of(world);
  };
  TraceText whole;
  TraceText part;
  TraceText nothing;
  const std::uint64_t digest = run(whole, nothing, false);
  RC_ASSERT(run(nothing, part, true) == digest);
  RC_ASSERT(nothing.text().empty());
  const std::string steps = steps_since(comes, whole.text());
  const std::string heard = steps_since(comes, part.text());
  RC_ASSERT(steps.substr(0, heard.size()) == heard);
  RC_ASSERT(steps_since(comes + stays, whole.text()) == steps.substr(heard.size()));
}

/// Within a span the motor is told of a mean acceleration, whatever the ramp generator does: begin to cruise, to brake
/// or to turn round.
RC_GTEST_PROP(Spans, HaveTheFieldWhereTheRampGeneratorHasIt, ()) {
  using tmc429::RampMode;
  constexpr double microsteps_per_electrical_turn = tmc262::microstep_positions;
  World world(nullptr, {.machine = RotaryAxisDimensions{}, .motor = motors().front()});
  start(world, *rc::gen::inRange(0, 5));
  world.transfer_tmc262(tmc262::datagram(tmc262::StallGuardAndCurrent::CurrentScale::of(31)));
  set<tmc429::MaximumAcceleration>(world, 1 << *rc::gen::inRange(0, 11));
  write(world,
        tmc429::Dividers::Pulse::of(*rc::gen::inRange(2, 5)) | tmc429::Dividers::Ramp::of(*rc::gen::inRange(0, 8)));
  const double microsteps_a_step = world.tmc262().microsteps_per_pulse();
  for (int motion = 0; motion < 4; ++motion) {
    if (*rc::gen::arbitrary<bool>()) {
      write(world, tmc429::Mode::of(RampMode::velocity));
      set<tmc429::TargetVelocity>(world, *rc::gen::inRange(-1'000, 1'000));
    } else {
      write(world, tmc429::Mode::of(RampMode::ramp));
      set<tmc429::TargetPosition>(world, *rc::gen::inRange(-5'000, 5'000));
    }
    const Tick end = world.now() + *rc::gen::inRange<Tick>(1, 100 * millisecond);
    while (world.now() < end) {
      world.advance_to(std::min(end, world.now() + 1'777));
      const double field = world.present_field().angle * microsteps_per_electrical_turn;
      const double position = world.tmc429().motion().position * microsteps_a_step;
      // A step under way where the direction changes, the middle of the stairs, and what the spans leave.
      RC_ASSERT(std::fabs(field - position) <= 1.5 * microsteps_a_step + 2);
    }
  }
}

TEST(Spans, MoveTheFieldTheWayOfAnInvertedDirection) {
  using tmc429::InterfaceConfiguration;
  World world(nullptr, bench_machine());
  start(world, 2);
  write(world, InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::EnableRightSwitches::set |
                   InterfaceConfiguration::InvertDirection::set);
  world.transfer_tmc262(tmc262::datagram(tmc262::StallGuardAndCurrent::CurrentScale::of(31)));
  set<tmc429::MaximumAcceleration>(world, 20);
  set<tmc429::TargetPosition>(world, 300'000);
  world.advance_to(1000 * millisecond);
  EXPECT_LT(world.motor()->state().velocity, -1.0);
  EXPECT_LT(world.field().velocity, -1.0);
  EXPECT_EQ(world.motor()->regime(), Regime::locked);
}

/// Turns at changing speeds under changing loads, long enough at each for the longest of spans.
struct EvenSession {
  std::uint64_t seed;
  Tick slice;
  bool looks;
  bool is_recorded;

  /// Where the motor is after each of them, to the last bit.
  std::vector<double> run() const {
    struct : TraceObserver {
      void changed(Tick, std::string_view, std::int64_t) override {}
    } recording;
    World world(is_recorded ? &recording : nullptr, bench_machine());
    start(world, 2);
    world.transfer_tmc262(tmc262::datagram(tmc262::StallGuardAndCurrent::CurrentScale::of(31)));
    write(world, tmc429::Mode::of(tmc429::RampMode::velocity));
    std::mt19937_64 random(seed);
    const auto next = [&random](std::uint64_t below) { return random() % below; };
    std::vector<double> states;
    for (int i = 0; i < 6; ++i) {
      Load load = world.load();
      load.torque = 0.02 * static_cast<double>(next(8));
      world.set_load(load);
      if (next(2) == 0) set<tmc429::TargetVelocity>(world, static_cast<std::int32_t>(next(200)) - 100);
      const Tick end = world.now() + next(1500 * millisecond) + 1;
      while (world.now() < end) {
        world.advance_to(std::min(end, world.now() + slice));
        if (looks) static_cast<void>(world.rotor_angle() + world.encoder().count());
      }
      const MotorShaft::State state = world.present_motor()->state();
      states.insert(states.end(), {state.angle, state.velocity, static_cast<double>(world.encoder_count())});
    }
    return states;
  }
};

RC_GTEST_PROP(Spans, OfAnEvenMotionDoNotDependOnSlicesLooksOrRecordings, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const auto slice = *rc::gen::element<Tick>(16'000, 77'777, 160'000, 3'000'000);
  const auto whole = EvenSession{seed, 1'000'000'000, false, false}.run();
  RC_ASSERT((EvenSession{seed, slice, true, false}.run()) == whole);
  RC_ASSERT((EvenSession{seed, slice, true, true}.run()) == whole);
}

/// A motor at rest needs no grid, until something moves its field.
TEST(Spans, EndWhereAPulseMovesAMotorAtRest) {
  World world(nullptr, bench_machine());
  start(world);
  world.transfer_tmc262(tmc262::datagram(tmc262::StallGuardAndCurrent::CurrentScale::of(31)));
  world.advance_to(3000 * millisecond);
  ASSERT_LT(world.motor()->now(), world.now());
  for (int pulse = 0; pulse < 200; ++pulse) world.pulse_step_input(false);
  EXPECT_EQ(world.motor()->now(), world.now());
  world.advance_to(4000 * millisecond);
  EXPECT_GT(world.motor()->now(), 3000 * millisecond);
  EXPECT_NEAR(static_cast<double>(world.rotor_angle()), 200, 20);
}

/// A short does not take the time before it from the motor.
TEST(Spans, EndWhereAShortToGroundBegins) {
  const auto angle = [](bool shorted) {
    World world(nullptr, bench_machine());
    start(world, 2);
    world.transfer_tmc262(tmc262::datagram(tmc262::StallGuardAndCurrent::CurrentScale::of(31)));
    set<tmc429::MaximumAcceleration>(world, 20);
    set<tmc429::TargetPosition>(world, 300'000);
    world.advance_to(1005 * millisecond);
    if (shorted) world.set_short_to_ground(Tmc262::Coil::a, true);
    return world.rotor_angle();
  };
  EXPECT_EQ(angle(true), angle(false));
}

/// Turns with a real motor at 29 rpm, without a swing after some seconds.
void turn_evenly(World& world) {
  start(world, 2);
  world.transfer_tmc262(tmc262::datagram(tmc262::StallGuardAndCurrent::CurrentScale::of(31)));
  write(world, tmc429::Mode::of(tmc429::RampMode::velocity));
  set<tmc429::TargetVelocity>(world, 100);
  world.advance_to(5000 * millisecond);
}

TEST(Spans, AreLongWhileTheMotorTurnsEvenly) {
  World world(nullptr, bench_machine());
  turn_evenly(world);
  world.advance_to(5095 * millisecond);
  EXPECT_EQ(world.motor()->now(), 5000 * millisecond);
  Load load = world.load();
  load.torque += 0.05;
  world.set_load(load);
  world.advance_to(5115 * millisecond);
  EXPECT_EQ(world.motor()->now(), 5110 * millisecond) << "the rotor swings to another lead";
  world.advance_to(8095 * millisecond);
  EXPECT_EQ(world.motor()->now(), 8000 * millisecond);
}

TEST(Spans, AreShorterWhereAnEvenMotionComesToASwitch) {
  LinearStageDimensions stage;
  stage.limit_switch_distance = 10'000;
  stage.start = 34'000;  // µm, 6 mm before the right switch
  World world(nullptr, {.machine = stage, .motor = motors().front()});
  turn_evenly(world);
  Tick time = world.now();
  while (!world.right_switch() && time < 60'000 * millisecond) world.advance_to(time += millisecond);
  ASSERT_TRUE(world.right_switch());
  EXPECT_LE(world.place(), 40'001) << "within 40 us";
}

TEST(Spans, AreRecordedEveryTenMilliseconds) {
  TraceText trace;
  World world(&trace, bench_machine());
  turn_evenly(world);
  for (const int time : {5010, 5020, 5030, 5040}) {
    world.advance_to(static_cast<Tick>(time) * millisecond);
    EXPECT_NE(trace.text().find("\n" + std::to_string(world.now()) + " encoder "), std::string::npos) << time;
  }
  EXPECT_EQ(world.motor()->now(), 5000 * millisecond);
}

TEST(Spans, AreRecordedFromTheMiddleOfOneOn) {
  World world(nullptr, bench_machine());
  turn_evenly(world);
  world.advance_to(5015 * millisecond);
  TraceText trace;
  world.observe(&trace);
  world.advance_to(5021 * millisecond);
  EXPECT_NE(trace.text().find(std::to_string(5020 * millisecond) + " encoder "), std::string::npos);
}

/// Steps that come singly are in no field of the future.
TEST(Spans, AreShortFromTheStartOfAMotionInFullSteps) {
  World world(nullptr, bench_machine());
  start(world, 8);
  write(world, tmc429::Dividers::Pulse::of(7) | tmc429::Dividers::Ramp::of(3));
  write(world, tmc429::Mode::of(tmc429::RampMode::velocity));
  set<tmc429::TargetVelocity>(world, 100);
  for (int time = 0; time < 300; time += 50) {
    world.advance_to(static_cast<Tick>(time) * millisecond);
    EXPECT_LE(world.now() - world.motor()->now(), millisecond) << time;
  }
}

}  // namespace
}  // namespace opentmcl::twin
